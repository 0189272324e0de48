"""Consistent initial conditions: velocities on the constraints, accelerations and multipliers that fit the forces.

They are found by projection, never by the integrator, which cannot do so at index 2.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components

from codegen.ir.evaluate import evaluate
from codegen.ir.program import Output, Program

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """Velocities and what follows from them at one instant, in the axes of the programs.

    Attributes:
        velocity: [n] of all displacements.
        acceleration: [n] classical accelerations.
        multipliers: [m] lambda.
        changed: how much the velocities asked for had to change, the largest entry of those of bodies.
        most_changed: number of that entry.
    """

    velocity: Array
    acceleration: Array
    multipliers: Array
    changed: float
    most_changed: int


def consistent_motion(
    program: Program, mass: Program, arrays: Mapping[str, Sequence[float]], velocity: Array, phi_t: Array
) -> Motion:
    """Find the consistent motion nearest to given velocities, weighed by the mass matrix.

    Args:
        program: of ``phi_q``, ``gamma`` and ``force``.
        mass: of ``mass``.
        arrays: positions, attitudes and whatever else the program takes, but for the velocity.
        velocity: [n]; rates of joint coordinates follow from those of the bodies.
        phi_t: [m] partial derivative of ``phi`` by time.
    """
    M = dense(mass.output("mass"), evaluate(mass, {})["mass"])
    phi_q = _evaluated(program, arrays, velocity, "phi_q")
    projected = saddle(M, phi_q, M @ velocity, -phi_t)[0]
    force = _evaluated(program, arrays, projected, "force").ravel()
    gamma = _evaluated(program, arrays, projected, "gamma").ravel()
    acceleration, multipliers = saddle(M, phi_q, force, gamma)
    changed = np.abs(projected - velocity) * (np.diag(M) > 0)
    most = int(np.argmax(changed))
    return Motion(projected, acceleration, multipliers, float(changed[most]), most)


def dense(output: Output, values: Sequence[float]) -> Array:
    """An output as a matrix."""
    matrix = np.zeros((output.sparsity.nrow, output.sparsity.ncol))
    for (row, column), value in zip(output.sparsity.entries(), values, strict=True):
        matrix[row, column] = value
    return matrix


def _evaluated(program: Program, arrays: Mapping[str, Sequence[float]], velocity: Array, name: str) -> Array:
    values = evaluate(program, {**arrays, "velocity": velocity.tolist()})
    return dense(program.output(name), values[name])


def saddle(M: Array, phi_q: Array, top: Array, bottom: Array) -> tuple[Array, Array]:
    """Solve ``M x + phi_q^T l = top``, ``phi_q x = bottom``; where it is singular, the least solution.

    Args:
        M: [n, n].
        phi_q: [m, n].
        top: [n].
        bottom: [m].

    Returns:
        ``x`` and ``l``.
    """
    rows, size = phi_q.shape
    matrix = np.block([[M, phi_q.T], [phi_q, np.zeros((rows, rows))]])
    right = np.concatenate([top, bottom])
    scale = 1.0 / np.sqrt(np.maximum(np.max(np.abs(matrix), axis=1), 1e-300))
    scaled, solution = scale[:, None] * matrix * scale, np.zeros(len(right))
    count, labels = connected_components(csr_matrix(matrix != 0), directed=False)
    for part in (np.flatnonzero(labels == number) for number in range(count)):  # mechanisms that do not touch
        solution[part] = scale[part] * scipy.linalg.lstsq(scaled[np.ix_(part, part)], (scale * right)[part])[0]
    return solution[:size], solution[size:]
