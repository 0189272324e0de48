"""The trajectory of a run: motion in the axes of the file, reactions of the joints, drift and energy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.measure.constraints import Array
from codegen.mechanics.system import System
from codegen.scenes.numbers import constraint_program, exact, geometry_of
from codegen.scenes.run import Prepared, Run
from codegen.scenes.settled import settled
from codegen.scenes.state import Bodies, Frames, euler_parameters, frames_of
from codegen.simulate.trajectory import Trajectory
from codegen.spec.scene import GROUND, Joint, Vector


@dataclass(frozen=True, slots=True, eq=False)
class Record:
    """What is told of a run.

    Attributes:
        trajectory: in the axes of the file.
        drift: [n] largest entry of ``phi`` of all joints, rows that were left out among them, m or 1.
        energy: [n] J, kinetic and potential; of forces that have a potential.
    """

    trajectory: Trajectory
    drift: Array
    energy: Array


def record(prepared: Prepared, run: Run) -> Record:
    """Give the trajectory of a run.

    Args:
        prepared: the scene.
        run: its states.
    """
    system = prepared.system
    bodies = settled(system, prepared.layout, prepared.values, prepared.inertia, run.t, run.y, run.ydot)
    frames = frames_of(prepared.scene, prepared.plane)
    values = {p.joint.name: _values(system, bodies, p.joint, k) for k, p in enumerate(system.assembly.placed)}
    drift = np.max([np.max(np.abs(phi), axis=0) for phi, _ in values.values()], axis=0, initial=0.0)
    reactions = {name: _turned(_reaction(system, bodies, name, phi_q), frames) for name, (_, phi_q) in values.items()}
    return Record(_trajectory(prepared, run, bodies, frames, reactions), drift, energy(system, bodies))


def _trajectory(
    prepared: Prepared, run: Run, bodies: Bodies, frames: Frames, reactions: Mapping[str, Array]
) -> Trajectory:
    system = prepared.system
    height = frames.heights[None, :, None] * np.array([0.0, 0.0, 1.0])
    A = frames.world @ bodies.A @ frames.bodies
    turned_back = np.swapaxes(frames.bodies, 1, 2)
    alpha, rates = (_by_joint(system, values) for values in (bodies.alpha, bodies.alphadot))
    return Trajectory(
        tuple(body.name for body in prepared.scene.bodies),
        run.t,
        (bodies.r + height) @ frames.world.T,
        euler_parameters(A),
        bodies.v @ frames.world.T,
        np.einsum("bij,nbj->nbi", turned_back, bodies.omega),
        bodies.a @ frames.world.T,
        np.einsum("bij,nbj->nbi", turned_back, bodies.omegadot),
        alpha,
        rates,
        _efforts(system, bodies),
        reactions,
    )


def _by_joint(system: System, values: Array) -> dict[str, Array]:
    placed = [p for p in system.assembly.placed if p.form.coordinates]
    ends = ((p, p.ends.first_alpha) for p in placed)
    return {p.joint.name: values[:, first : first + p.form.coordinates] for p, first in ends}


def _efforts(system: System, bodies: Bodies) -> dict[str, Array]:
    """Efforts of drives along their coordinates: minus the multiplier."""
    found: dict[str, list[Array]] = {}
    for k, driven in enumerate(system.drives):
        found.setdefault(driven.joint, []).append(-bodies.multipliers[:, len(system.assembly.rows) + k])
    return {name: np.stack(columns, axis=1) for name, columns in found.items()}


# --- joints


def _values(system: System, bodies: Bodies, joint: Joint, position: int) -> tuple[Array, Array]:
    """``phi`` [m, n] of a joint and ``phi_q`` [m, 6, n] by body j, translations in world axes, at all times."""
    placed = system.assembly.placed[position]
    variant = system.assembly.forms[joint.name]
    program = constraint_program(exact(variant))
    names = [body.name for body in system.assembly.scene.bodies]
    arrays: dict[str, list[Array]] = {}
    poses = []
    for side, name in zip("ij", joint.bodies, strict=True):
        r, A = _pose(bodies, None if name == GROUND else names.index(name))
        poses.append(A)
        arrays[f"r_{side}"] = list(r.T)
        arrays[f"A_{side}"] = list(A.transpose(2, 1, 0).reshape(9, -1))
    first = placed.ends.first_alpha
    arrays["alpha"] = list(bodies.alpha[:, first : first + placed.form.coordinates].T)
    times = np.ones(len(bodies.r))
    arrays["geometry"] = [value * times for value in geometry_of(joint, variant)]
    values = evaluate(program, arrays, numpy_domain())
    pattern = program.output("phi_q").sparsity
    phi_q = np.zeros((pattern.nrow, 6, len(times)))
    for (row, column), value in zip(pattern.entries(), values["phi_q"], strict=True):
        if 6 <= column < 12:
            phi_q[row, column - 6] = value
    if variant.translations == "body":
        phi_q[:, :3] = np.einsum("nij,rjn->rin", poses[1], phi_q[:, :3])
    return np.array([value * times for value in values["phi"]]), phi_q


def _pose(bodies: Bodies, number: int | None) -> tuple[Array, Array]:
    if number is None:
        return np.zeros((len(bodies.r), 3)), np.tile(np.eye(3), (len(bodies.r), 1, 1))
    return bodies.r[:, number], bodies.A[:, number]


def _point(bodies: Bodies, number: int | None, point: Vector) -> Array:
    """[n, 3] m, world, of a point of a body, or of the ground."""
    r, A = _pose(bodies, number)
    found: Array = r + A @ np.array([float(x) for x in point])
    return found


def _reaction(system: System, bodies: Bodies, name: str, phi_q: Array) -> Array:
    """Force and moment [n, 6] on body j at the joint's point on body j, world axes: ``-phi_q^T lambda``."""
    placed = next(p for p in system.assembly.placed if p.joint.name == name)
    first = placed.ends.first_row
    number = {row: k for k, row in enumerate(system.assembly.rows)}
    kept = [k for k in range(placed.form.row_count) if first + k in number]
    multipliers = bodies.multipliers[:, [number[first + k] for k in kept]]
    load = -np.einsum("rcn,nr->nc", phi_q[kept], multipliers)
    names = [body.name for body in system.assembly.scene.bodies]
    body = placed.joint.bodies[1]
    _, A = _pose(bodies, None if body == GROUND else names.index(body))
    arm = A @ np.array([float(x) for x in placed.joint.marker_j.point])
    moment = np.einsum("nij,nj->ni", A, load[:, 3:]) - np.cross(arm, load[:, :3])
    return np.concatenate([load[:, :3], moment], axis=1)


def _turned(load: Array, frames: Frames) -> Array:
    """The same in the axes of the file."""
    return np.concatenate([load[:, :3] @ frames.world.T, load[:, 3:] @ frames.world.T], axis=1)


# --- energy


def energy(system: System, bodies: Bodies) -> Array:
    """Kinetic and potential energy [n] J: gravity, constant forces, springs, loads on joint coordinates."""
    scene = system.assembly.scene
    gravity = np.array([float(x) for x in scene.gravity])
    total = np.zeros(len(bodies.r))
    for k, body in enumerate(scene.bodies):
        m, J = float(body.mass), np.array([[float(x) for x in row] for row in body.inertia])
        total += 0.5 * m * np.sum(bodies.v[:, k] ** 2, axis=1) - m * bodies.r[:, k] @ gravity
        total += 0.5 * np.einsum("ni,ij,nj->n", bodies.omega[:, k], J, bodies.omega[:, k])
    names = [body.name for body in scene.bodies]
    for spring in scene.springs:
        ends = [
            _point(bodies, None if name == GROUND else names.index(name), point)
            for name, point in zip(spring.bodies, spring.points, strict=True)
        ]
        length = np.linalg.norm(ends[1] - ends[0], axis=1)
        total += 0.5 * float(spring.stiffness) * (length - float(spring.length)) ** 2
    for force in scene.forces:
        total -= _point(bodies, names.index(force.body), force.point) @ np.array([float(x) for x in force.vector])
    for placed in system.assembly.placed:
        for k, coordinate in enumerate(placed.joint.coordinates if placed.form.coordinates else ()):
            alpha = bodies.alpha[:, placed.ends.first_alpha + k]
            total += 0.5 * float(coordinate.stiffness) * (alpha - float(coordinate.rest)) ** 2
            total -= float(coordinate.torque) * alpha
    return total
