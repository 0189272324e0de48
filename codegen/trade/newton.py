"""Newton's method on the in-line engine with different second derivatives: order of convergence and iterations.

The engine (S1 section 5: three revolute joints, one translational, parametric form) is pulled to a pose that does not
close, by springs on positions and attitudes; unknowns are the pose, the joint coordinates and the multipliers. With
``g`` the springs' force, the residual is ``(g + phi_q^T lambda, phi)`` and the matrix ``[G + S, phi_q^T; phi_q, 0]``
with ``S`` the second derivative ``(phi_q^T lambda)_q``. Virtual displacements are in body axes, as in SPEC S1.2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from codegen.measure.attitudes import turned
from codegen.spec.request import Variant
from codegen.trade.engine import JOINTS, Place, Pose, closed, columns, dense, inputs
from codegen.trade.extreme_table import Cell, ExtremeTable, routine_of

Array = NDArray[np.float64]

_ANGLE = 0.9
"""Of the crank, rad."""

_START = 0.4
"""From there to where Newton starts, rad."""

_PULL = 0.1 * np.array([[1.0, -2.0, 0.0], [2.0, 1.0, 0.0], [-3.0, 1.0, 0.0]])
"""From closed positions to those that the springs pull to, m."""

_TURNING = 0.02
"""Stiffness against turning, over that against moving, m^2."""

_FLOOR = 1e-13
_MOST = 60
_QUANTITIES = ("phi", "phi_q", "phi_q_t_lambda", "phi_q_t_lambda_q")


@dataclass(frozen=True, slots=True)
class Pairing:
    """Which derivatives the residual and the matrix are made of.

    Attributes:
        name: for readers.
        residual: derivative in ``phi_q^T lambda``: ``exact`` or ``substituted``.
        matrix: derivative in the matrix.
        has_second: whether the matrix has the second derivative.
        expected: order of convergence by theory.
    """

    name: str
    residual: str
    matrix: str
    has_second: bool
    expected: float


PAIRINGS = (
    Pairing("exact", "exact", "exact", True, 2.0),
    Pairing("substituted", "substituted", "substituted", True, 2.0),
    Pairing("mixed: exact residual, substituted matrix", "exact", "substituted", True, math.sqrt(2)),
    Pairing("no second derivative", "exact", "exact", False, 1.0),
)

SLOW = 1.8
"""An order below this is warned of."""


def residuals(pairing: Pairing) -> list[float]:
    """Sizes of the residual, step after step, down to rounding."""
    return [size for size, _ in _iterations(pairing)]


def solution(pairing: Pairing) -> Pose:
    """The pose where the iteration ends."""
    *_, (_, end) = _iterations(pairing)
    return end


def _iterations(pairing: Pairing) -> Iterator[tuple[float, Pose]]:
    target, now = closed(_ANGLE), closed(_ANGLE - _START)
    target = Pose(target.r + _PULL, target.A, target.alpha, target.lam)
    for _ in range(_MOST):
        residual, matrix = _system(pairing, now, target)
        size = float(np.linalg.norm(residual))
        yield size, now
        if size < _FLOOR:
            break
        step = np.linalg.lstsq(matrix, -residual, rcond=1e-11)[0]
        now = _moved(now, np.asarray(step, dtype=np.float64))


def order(sizes: list[float]) -> float:
    """Order of convergence: median of the last estimates above rounding."""
    kept = [size for size in sizes if size > 10 * _FLOOR]
    logs = np.diff(np.log(kept))
    estimates = [b / a for a, b in pairwise(logs) if a < 0 and b < 0]
    return float(np.median(estimates[-3:])) if estimates else math.inf


def newton_table() -> ExtremeTable:
    """All pairings."""
    rows: list[tuple[Cell, ...]] = []
    for pairing in PAIRINGS:
        sizes = residuals(pairing)
        found = order(sizes)
        warning = f"warning: order below {SLOW}" if found < SLOW else ""
        rows.append((pairing.name, float(len(sizes) - 1), found, pairing.expected, warning))
    return ExtremeTable(
        "newton",
        "Newton's method on the in-line engine, parametric form, regular rows",
        ("second derivative", "iterations", "order", "expected", "remark"),
        tuple(rows),
        ("Iterations until the residual is below 1e-13; the order is that of the last steps.",),
    )


def _moved(now: Pose, step: Array) -> Pose:
    bodies = step[:18].reshape(3, 6)
    r = now.r + np.einsum("bij,bj->bi", now.A, bodies[:, :3])
    return Pose(r, turned(now.A, bodies[:, 3:]), now.alpha + step[18:22], now.lam + step[22:])


def _system(pairing: Pairing, now: Pose, target: Pose) -> tuple[Array, Array]:
    """Residual [46] and matrix [46, 46]."""
    force, matrix = np.zeros(22), np.zeros((46, 46))
    for body, (part, block) in enumerate(_springs(now, target)):
        own = slice(6 * body, 6 * body + 6)
        force[own] += part
        matrix[own, own] += block
    closure = np.zeros(24)
    for k, place in enumerate(JOINTS):
        values = _joint_values(pairing, place, now, k)
        rows = slice(22 + 6 * k, 28 + 6 * k)
        closure[6 * k : 6 * k + 6] = values["phi"][:, 0]
        for own, column in columns(place, k):
            force[column] += values["phi_q_t_lambda"][own, 0]
            matrix[rows, column] += values["phi_q"][:, own]
            matrix[column, rows] += values["phi_q"][:, own].T
            if pairing.has_second:
                for other, second in columns(place, k):
                    matrix[column, second] += values["phi_q_t_lambda_q"][own, other]
    return np.concatenate([force, closure]), matrix


def _springs(now: Pose, target: Pose) -> Iterator[tuple[Array, Array]]:
    """Force [6] of each body in body axes, and its derivative [6, 6], by springs on position and attitude."""
    for r, A, r_0, A_0 in zip(now.r, now.A, target.r, target.A, strict=True):
        pull, R = A.T @ (r - r_0), A_0.T @ A
        block = np.zeros((6, 6))
        block[:3, :3] = np.eye(3)
        block[:3, 3:] = _skew(pull)
        for k in range(3):
            turn = R @ _skew(np.eye(3)[k])
            block[3:, 3 + k] = _TURNING * _vee(turn - turn.T)
        yield np.concatenate([pull, _TURNING * _vee(R - R.T)]), block


def _skew(v: Array) -> Array:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def _vee(M: Array) -> Array:
    return np.array([M[2, 1], M[0, 2], M[1, 0]])


def _joint_values(pairing: Pairing, place: Place, now: Pose, k: int) -> dict[str, Array]:
    """Values of one joint, dense; ``phi_q`` is that of the matrix."""
    kinds = {"phi": "exact", "phi_q": pairing.matrix, "phi_q_t_lambda": pairing.residual}
    kinds["phi_q_t_lambda_q"] = pairing.matrix
    given = inputs(place, now, k)
    return {
        name: dense(routine_of(Variant(place.type, "parametric", "regular", kinds[name]), name), given)
        for name in _QUANTITIES
    }
