"""Forces and energies of a scene, from the scene alone, with nothing of the generator."""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.mechanics.coordinate_load import STOP_SMOOTHING
from codegen.mechanics.system import System
from codegen.spec.scene import GROUND, Coordinate, Scene

from .poses import Array, Pose, split

EPS = float(STOP_SMOOTHING)


def numbers(values: Any) -> Array:
    """Exact numbers as floats."""
    return np.array(values, dtype=float)


def force(system: System, pose: Pose, v: Array) -> Array:
    """Generalised forces on the displacements of a system, those on translations in their axes."""
    scene = system.assembly.scene
    in_body = system.assembly.translations == "body"
    motions, rates = split(system, v)
    velocities = [R @ u if in_body else u for R, (u, _) in zip(pose.A, motions, strict=True)]
    omegas = [omega for _, omega in motions]
    forces = [numbers(scene.gravity) * float(body.mass) + 0 * v[0] for body in scene.bodies]
    moments = [
        -np.cross(omega, numbers(body.inertia) @ omega) for body, omega in zip(scene.bodies, omegas, strict=True)
    ]
    numbers_of = {body.name: k for k, body in enumerate(scene.bodies)}
    for torque in scene.torques:
        k = numbers_of[torque.body]
        moments[k] = moments[k] + pose.A[k].T @ numbers(torque.vector)
    for load in scene.forces:
        k = numbers_of[load.body]
        forces[k] = forces[k] + numbers(load.vector)
        moments[k] = moments[k] + np.cross(numbers(load.point), pose.A[k].T @ numbers(load.vector))
    for spring in scene.springs:
        ends = [_end(spring.bodies[n], spring.points[n], numbers_of, pose, velocities, omegas) for n in (0, 1)]
        d, d_rate = ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]
        length = np.sqrt(d @ d)
        tension = float(spring.stiffness) * (length - float(spring.length))
        tension = tension + float(spring.damping) * (d @ d_rate) / length
        for name, point, sign in zip(spring.bodies, spring.points, (1, -1), strict=True):
            if name != GROUND:
                k = numbers_of[name]
                pull = sign * tension * d / length
                forces[k] = forces[k] + pull
                moments[k] = moments[k] + np.cross(numbers(point), pose.A[k].T @ pull)
    seen = [pose.A[k].T @ f if in_body else f for k, f in enumerate(forces)]
    planar = system.assembly.arrays.is_planar
    rows = [[*f[:2], m[2]] if planar else [*f, *m] for f, m in zip(seen, moments, strict=True)]
    return np.array([*np.concatenate(rows), *_on_coordinates(scene, pose, rates)])


def _end(name: str, point: Any, known: dict[str, int], pose: Pose, velocities: Any, omegas: Any) -> tuple[Array, Array]:
    """Position and velocity of a point, world."""
    s = numbers(point)
    if name == GROUND:
        return s, np.zeros(3)
    k = known[name]
    return pose.r[k] + pose.A[k] @ s, velocities[k] + pose.A[k] @ np.cross(omegas[k], s)


def _on_coordinates(scene: Scene, pose: Pose, rates: Array) -> list[Any]:
    acting = [coordinate for joint in scene.joints for coordinate in joint.coordinates]
    if not acting:
        return [0.0] * len(rates)
    return [_on_coordinate(c, a, w) for c, a, w in zip(acting, pose.alpha, rates, strict=True)]


def _on_coordinate(acting: Coordinate, alpha: Any, rate: Any) -> Any:
    found = float(acting.torque) - float(acting.stiffness) * (alpha - float(acting.rest)) - float(acting.damping) * rate
    if acting.limit is not None:
        k, c = float(acting.limit.stiffness), float(acting.limit.damping)
        for bound, sign in ((acting.limit.upper, 1), (acting.limit.lower, -1)):
            if bound is not None:
                x = sign * (alpha - float(bound))
                root = np.sqrt(x * x + EPS**2)
                found = found - sign * k * (x + root) / 2 - c * (1 + x / root) / 2 * rate
    return found


def potential(scene: Scene, pose: Pose) -> Any:
    """Potential energy of gravity, of constant forces and of point springs, J."""
    numbers_of = {body.name: k for k, body in enumerate(scene.bodies)}
    height = [-float(body.mass) * (numbers(scene.gravity) @ pose.r[k]) for k, body in enumerate(scene.bodies)]
    nothing = [np.zeros(3)] * len(scene.bodies)
    stored = [
        -numbers(load.vector) @ _end(load.body, load.point, numbers_of, pose, nothing, nothing)[0]
        for load in scene.forces
    ]
    for spring in scene.springs:
        ends = [_end(spring.bodies[n], spring.points[n], numbers_of, pose, nothing, nothing)[0] for n in (0, 1)]
        d = ends[1] - ends[0]
        stored.append(float(spring.stiffness) * (np.sqrt(d @ d) - float(spring.length)) ** 2 / 2)
    return sum(height) + sum(stored)
