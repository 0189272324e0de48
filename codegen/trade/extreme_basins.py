"""Newton's method from bad starts: how often a joint is closed as it was meant, on another branch, or not at all.

A closed joint has body j turned away by an angle about any axis; body i stays, the joint coordinates start where they
belong. Steps are the shortest that solve the linearised constraint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.measure.attitudes import turned
from codegen.measure.draw import sobol_points
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.spec.request import Variant
from codegen.trade.extreme_rank import rank_variants
from codegen.trade.extreme_table import Cell, ExtremeTable, poses_of, routine_of

Array = NDArray[np.float64]

STARTS = (10, 30, 60, 90, 120, 150, 180)
"""Angles by which body j is turned away, degrees."""

_POSES = 64
_STEPS = 40
_CLOSED = 1e-10
_SAME = 1e-6
"""How far ``branch`` may be from 1 where the joint is closed as it was meant."""


@dataclass(frozen=True, slots=True)
class Basin:
    """Where Newton's method ends from starts at one angle, parts of all starts."""

    right: float
    wrong: float
    failed: float


def basins_of(variant: Variant, starts: Sequence[float] = STARTS, count: int = _POSES) -> tuple[Basin, ...]:
    """Let Newton's method close a joint.

    Args:
        variant: form and rows.
        starts: angles by which body j is turned away, degrees.
        count: of starts at each angle.
    """
    phi, phi_q, branch = (by_program(routine_of(variant, name).straight) for name in ("phi", "phi_q", "branch"))
    pattern = routine_of(variant, "phi_q").straight.outputs[0].sparsity
    now = _turned_away(variant, starts, count)
    with np.errstate(all="ignore"):
        for _ in range(_STEPS):
            residual = _stacked(phi(now)["phi"]).T
            if np.max(np.abs(residual)) < _CLOSED:
                break
            matrix = np.zeros((len(residual), pattern.nrow, pattern.ncol))
            for (row, column), entry in zip(pattern.entries(), phi_q(now)["phi_q"], strict=True):
                matrix[:, row, column] = entry
            now = _moved(now, _shortest(matrix[:, :, 6:], -residual), variant.translations)
        closed = np.asarray(np.max(np.abs(_stacked(phi(now)["phi"])), axis=0) < _CLOSED)
        meant = closed & np.asarray(np.abs(np.asarray(branch(now)["branch"][0]) - 1.0) < _SAME)
    ends = np.stack([meant, closed]).reshape(2, len(starts), count)
    parts = np.mean(ends, axis=2).T.tolist()
    return tuple(Basin(right, found - right, 1.0 - found) for right, found in parts)


def _turned_away(variant: Variant, starts: Sequence[float], count: int) -> dict[str, Array]:
    """Closed joints with body j turned about axes that are drawn evenly, through its own origin; start after start."""
    domain = PoseDomain(angle=np.pi, pitch_angle=1.2)
    given = poses_of(routine_of(variant, "phi"), domain, count=count).given(np.float64)
    height, round_about = sobol_points(count)[:, -2:].T
    z, radius = 2 * height - 1, 2 * np.sqrt(height * (1 - height))
    axes = np.stack([radius * np.cos(2 * np.pi * round_about), radius * np.sin(2 * np.pi * round_about), z], axis=1)
    found = {name: np.tile(rows, len(starts)).astype(np.float64) for name, rows in given.items()}
    vectors = np.concatenate([np.deg2rad(degrees) * axes for degrees in starts])
    return found | {"A_j": _columns(turned(_matrices(found["A_j"]), vectors))}


def _stacked(rows: Sequence[NDArray[np.floating]]) -> Array:
    """Rows [rows, poses]; constants are spread over the poses."""
    return np.array(np.broadcast_arrays(*rows), dtype=np.float64)


def _shortest(matrix: Array, residual: Array) -> Array:
    """Least squares, smallest solution; steps that are no numbers stay so."""
    sound = np.asarray(np.all(np.isfinite(matrix), axis=(1, 2), keepdims=True))
    inverse = np.linalg.pinv(np.where(sound, matrix, 0.0), rcond=1e-10)
    step = np.einsum("pnm,pm->pn", inverse, residual)
    return np.where(sound[:, :, 0], step, np.nan)


def _moved(now: dict[str, Array], step: Array, translations: str) -> dict[str, Array]:
    A = _matrices(now["A_j"])
    move = np.einsum("pab,pb->pa", A, step[:, :3]) if translations == "body" else step[:, :3]
    found = now | {"r_j": now["r_j"] + move.T, "A_j": _columns(turned(A, step[:, 3:6]))}
    return found | ({"alpha": now["alpha"] + step[:, 6:].T} if step.shape[1] > 6 else {})


def _matrices(columns: Array) -> Array:
    return columns.T.reshape(-1, 3, 3).transpose(0, 2, 1)


def _columns(matrices: Array) -> Array:
    return matrices.transpose(0, 2, 1).reshape(-1, 9).T


def basins() -> ExtremeTable:
    """Every joint, form and set of rows."""
    rows: list[tuple[Cell, ...]] = []
    for variant in rank_variants():
        found = basins_of(variant)
        for name in ("right", "wrong", "failed"):
            rows.append((variant.file_stem, name, *(100.0 * float(getattr(one, name)) for one in found)))
    return ExtremeTable(
        "basins",
        "Newton's method from bad starts: where it ends, in per cent",
        ("variant", "branch", *(f"{degrees} degrees" for degrees in STARTS)),
        tuple(rows),
        (
            f"{_POSES} closed joints with body j turned away about any axis; shortest steps, at most {_STEPS}.",
            "Right: branch is 1; wrong: closed with another value of branch; failed: not closed to 1e-10.",
        ),
    )
