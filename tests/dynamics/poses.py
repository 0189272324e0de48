"""Poses and velocities of a system as arrays, moved along its displacements, and its programs evaluated there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np
from scipy.linalg import expm

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.nearest import nearest_double
from codegen.ir.program import Program
from codegen.mechanics.mass import mass
from codegen.mechanics.system import System
from codegen.scenes.programs import estimate, program

Array = Any
"""Array of floats or complex numbers."""

COMPLEX = Domain("complex", nearest_double, np.sqrt, np.sin, np.cos, np.arctan2)
STEP = 1e-30
"""Along the imaginary axis: derivatives without cancellation."""


def skew(a: Array) -> Array:
    """Tilde."""
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


@dataclass(frozen=True)
class Pose:
    """Positions [nb, 3] world, attitudes [nb, 3, 3], joint coordinates [na], in space and in the plane."""

    r: Array
    A: Array
    alpha: Array

    def moved(self, system: System, q: Array) -> Pose:
        """Displace along the columns of a system; translations in their axes, rotations in body axes."""
        motions, alpha = split(system, q)
        in_body = system.assembly.translations == "body"
        r = [p + (R @ move if in_body else move) for p, R, (move, _) in zip(self.r, self.A, motions, strict=True)]
        A = [R @ turned(turn) for R, (_, turn) in zip(self.A, motions, strict=True)]
        return Pose(np.array(r), np.array(A), self.alpha + alpha)


def turned(turn: Array) -> Array:
    """``exp(turn~)``; for an imaginary step its first terms."""
    return np.eye(3) + skew(turn) if np.iscomplexobj(turn) else expm(skew(turn))


def split(system: System, q: Array) -> tuple[list[tuple[Array, Array]], Array]:
    """Displacements or velocities as pairs of vectors for each body, and those of the joint coordinates."""
    q = np.asarray(q)
    count = len(system.assembly.scene.bodies)
    planar = system.assembly.arrays.is_planar
    width = 3 if planar else 6
    pairs = []
    for own in q[: width * count].reshape(count, width):
        pairs.append((np.array([own[0], own[1], 0]), np.array([0, 0, own[2]])) if planar else (own[:3], own[3:]))
    return pairs, q[width * count :]


def start(system: System) -> Pose:
    """The pose at t = 0."""
    r = [[float(x) for x in body.position] for body in system.assembly.scene.bodies]
    return Pose(np.array(r), np.array([np.eye(3)] * len(r)), np.zeros(system.assembly.coordinates))


def size(system: System) -> int:
    """Number of displacements."""
    return len(system.assembly.columns)


@dataclass(frozen=True, eq=False)
class Machine:
    """A system with its programs."""

    system: System

    @cache  # noqa: B019, machines live as long as the tests
    def program(self, name: str) -> Program:
        """The program of a quantity."""
        return program(self.system, (name,), estimate)

    def at(
        self, names: Sequence[str], pose: Pose, v: Array = None, multipliers: Array = None, t: float = 0.0
    ) -> dict[str, Array]:
        """Evaluate quantities, dense."""
        planar = self.system.assembly.arrays.is_planar
        inputs = {
            "r": (pose.r[:, :2] if planar else pose.r).ravel(),
            "A": (pose.A[:, :2, :2] if planar else pose.A).transpose(0, 2, 1).ravel(),
            "alpha": pose.alpha,
            "velocity": v,
            "lambda": multipliers,
            "t": [t],
            "revolutions": [0.0] * 9,
        }
        routines = {name: self.program(name) for name in names}
        return {name: dense(p, name, evaluate(p, inputs, COMPLEX)[name]) for name, p in routines.items()}

    def assembled(self, pose: Pose) -> Pose:
        """The nearest pose that the constraints admit, by Gauss and Newton."""
        for _ in range(50):
            found = self.at(("phi", "phi_q"), pose)
            if np.abs(found["phi"]).max() < 1e-14:
                break
            pose = pose.moved(self.system, -np.linalg.pinv(found["phi_q"], rcond=1e-9) @ found["phi"][:, 0])
        return pose

    def consistent(self, seed: int, spread: float = 0.2) -> tuple[Pose, Array]:
        """A random pose near that at t = 0, and velocities, that the constraints admit."""
        rng = np.random.default_rng(seed)
        pose = start(self.system).moved(self.system, spread * rng.standard_normal(size(self.system)))
        pose = self.assembled(pose)
        phi_q = self.at(("phi_q",), pose)["phi_q"]
        v = 3 * rng.standard_normal(size(self.system))
        return pose, v - np.linalg.pinv(phi_q, rcond=1e-9) @ (phi_q @ v)

    def accelerations(self, pose: Pose, v: Array, t: float = 0.0) -> tuple[Array, Array]:
        """Accelerations and multipliers of the equations of motion; of least norm where rows depend on others."""
        assembly = self.system.assembly
        inertia = mass(assembly.scene, assembly.arrays, size(self.system))
        M = dense(inertia, "mass", evaluate(inertia, {})["mass"])
        found = self.at(("phi_q", "gamma", "force"), pose, v, t=t)
        phi_q, rows = found["phi_q"], found["phi_q"].shape[0]
        matrix = np.block([[M, phi_q.T], [phi_q, np.zeros((rows, rows))]])
        right = np.concatenate([found["force"][:, 0], found["gamma"][:, 0]])
        solution = np.linalg.lstsq(matrix, right, rcond=1e-11)[0]
        return solution[: size(self.system)], solution[size(self.system) :]


def dense(routine: Program, name: str, values: Sequence[Any]) -> Array:
    """An output as a matrix."""
    sparsity = routine.output(name).sparsity
    matrix = np.zeros((sparsity.nrow, sparsity.ncol), complex if any(map(np.iscomplexobj, values)) else float)
    for place, value in zip(sparsity.entries(), values, strict=True):
        matrix[place] = value
    return matrix


def flattened(pose: Pose) -> Pose:
    """What a pose in space is in the plane of x and y."""
    flat = pose.A.copy()
    flat[:, 2, :] = flat[:, :, 2] = 0
    flat[:, 2, 2] = 1
    return replace(pose, r=pose.r * [1, 1, 0], A=flat)
