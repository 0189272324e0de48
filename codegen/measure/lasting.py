"""Rows that stay independent while a mechanism goes a long way.

Where rows are redundant because of special dimensions, those that are kept near the start may lose rank later, at a
pose that is regular with all rows. So the mechanism is moved far to both sides, and rows are chosen anew where need be.
"""

from __future__ import annotations

from collections.abc import Sequence

import scipy.linalg

from codegen.measure.constraints import Array, ConstraintSystem, Pose, Scales
from codegen.measure.motion import walk
from codegen.measure.rank import TOLERANCE, independent_rows

POSES = 12
"""Poses to each side; 8 steps are half a turn of the body that turns most."""

WEAK = 0.2
"""Rows whose smallest singular value falls below this part of that of all rows may lose rank between the poses."""


def lasting_rows(
    system: ConstraintSystem, start: Pose, units: Scales, near: Sequence[Array], kept: tuple[int, ...]
) -> tuple[int, ...]:
    """Choose rows that stay independent along the way.

    Args:
        system: a connected mechanism.
        start: a regular pose.
        units: of rows and columns.
        near: Jacobians [m, n] without dimension of the poses at which ``kept`` were chosen.
        kept: rows that are independent there.

    Returns:
        ``kept`` where they serve; else the best of those chosen with the poses of the way, as many.
    """
    count = len(kept)
    far = [units.values(system, pose)[1] for side in (1.0, -1.0) for pose in walk(system, start, units, side, POSES)]
    jacobians = [*near, *(matrix for matrix in far if _least(matrix, count) > TOLERANCE)]
    if _weakest(jacobians, kept) >= WEAK:
        return kept
    whole = [range(system.row_count)]
    choices = (kept, *(independent_rows(jacobians, joints, count) for joints in (system.row_ranges(), whole)))
    return max((rows for rows in choices if len(rows) == count), key=lambda rows: _weakest(jacobians, rows))


def _weakest(jacobians: Sequence[Array], rows: tuple[int, ...]) -> float:
    """Smallest singular value of rows as a part of that of all rows, at the worst of the poses."""
    chosen = list(rows)
    return min(_least(matrix[chosen], len(chosen)) / _least(matrix, len(chosen)) for matrix in jacobians)


def _least(matrix: Array, count: int) -> float:
    return float(scipy.linalg.svdvals(matrix)[count - 1])
