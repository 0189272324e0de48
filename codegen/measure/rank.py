"""Rank of a Jacobian, and rows of it that are independent at every pose.

The rank is that of a QR factorisation with column pivoting; the singular values check it and say how sure it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from codegen.measure.constraints import Array

TOLERANCE = 1e-7
"""What is smaller than this part of the largest, of singular values or pivots without dimension, is 0."""

CLEAR_GAP = 1e3
"""Ratio of the smallest singular value that counts to the largest that does not, from which a rank is sure."""

_NOISE = 1e-12
"""Singular values are not told apart below this part of the largest."""

WHOLE_JOINT = 1e-3
"""A joint keeps all its rows where each, of length 1, is this far from the span of those kept before."""

_TIE = 1e-6
"""Rows whose distances differ by less than this part of them are alike; the first is taken."""


@dataclass(frozen=True, slots=True)
class Rank:
    """A numerical rank.

    Attributes:
        rank: number of independent rows.
        kept: smallest singular value that counts, relative to the largest; 1 where none counts.
        dropped: upper bound, a power of ten, of those that do not; 0 where there are none.
        is_clear: whether factorisation and singular values agree and lie far from the tolerance.
    """

    rank: int
    kept: float
    dropped: float
    is_clear: bool


def rank(matrix: Array) -> Rank:
    """Find the rank of a matrix without dimension; its structure is that of its rows and columns as they are."""
    if not matrix.size or not matrix.any():
        return Rank(0, 1.0, 0.0, True)
    sigma = np.asarray(scipy.linalg.svdvals(matrix))
    sigma = sigma / sigma[0]
    pivots = np.abs(np.diagonal(scipy.linalg.qr(matrix, mode="r", pivoting=True)[0]))
    found = int(np.sum(pivots > TOLERANCE * pivots[0]))
    kept, rest = float(sigma[found - 1]), sigma[found:]
    largest = max(float(rest[0]), _NOISE) if len(rest) else 0.0
    dropped = float(10.0 ** np.ceil(np.log10(largest) - 1e-9)) if largest else 0.0
    agrees = found == int(np.sum(sigma > TOLERANCE))
    return Rank(found, kept, dropped, bool(agrees and kept > CLEAR_GAP * largest))


def null_space(matrix: Array) -> Array:
    """Give an orthonormal basis [n, d] of the directions in which nothing changes, by `TOLERANCE`."""
    if not matrix.size or not matrix.any():
        return np.eye(matrix.shape[1])
    _, sigma, rows = scipy.linalg.svd(matrix)
    return np.asarray(rows[int(np.sum(sigma > TOLERANCE * sigma[0])) :].T)


class _Kept:
    """Rows that are kept so far, at several poses at once: what is left of each row beside their span."""

    def __init__(self, jacobians: Sequence[Array]) -> None:
        sizes = [np.linalg.norm(jacobian, axis=1, keepdims=True) for jacobian in jacobians]
        self.left = [jacobian / np.where(size > 0, size, 1.0) for jacobian, size in zip(jacobians, sizes, strict=True)]
        self.rows: list[int] = []

    def distances(self) -> Array:
        """Distance of each row from the span of those kept, at the worst of the poses; [m]."""
        return np.asarray(np.min([np.linalg.norm(left, axis=1) for left in self.left], axis=0))

    def keep(self, row: int) -> None:
        """Keep a row."""
        for left in self.left:
            direction = left[row] / np.linalg.norm(left[row])
            for _ in range(2):  # twice is enough for orthogonality to rounding
                left -= np.outer(left @ direction, direction)
        self.rows.append(row)

    def copy(self) -> _Kept:
        """Give a copy that can be tried."""
        other = _Kept([])
        other.left, other.rows = [left.copy() for left in self.left], list(self.rows)
        return other


def independent_rows(jacobians: Sequence[Array], joints: Sequence[range], count: int) -> tuple[int, ...]:
    """Choose rows that are independent at all poses, the same at each.

    The joints are taken in their order. A joint keeps all its rows if they are well independent of those kept before
    (`WHOLE_JOINT`); the rows of the others are added one by one, always the one that is farthest from the span of those
    kept, at the worst of the poses. So few joints lose rows, and the later ones do. Where this falls short, all rows
    are added one by one.

    Args:
        jacobians: [m, n] at each pose, of full generic rank there, without dimension.
        joints: rows of each joint.
        count: how many rows are independent.

    Returns:
        The rows in ascending order; fewer than ``count`` if no row is independent at all poses any more.
    """
    kept = _Kept(jacobians)
    incomplete: list[int] = []
    for rows in joints:
        trial = kept.copy()
        if len(kept.rows) + len(rows) <= count and _keep_farthest(trial, list(rows), len(rows), WHOLE_JOINT):
            kept = trial
        else:
            incomplete += rows
    if not _keep_farthest(kept, incomplete, count - len(kept.rows), 10 * TOLERANCE):
        kept = _Kept(jacobians)
        _keep_farthest(kept, list(range(len(jacobians[0]))), count, 10 * TOLERANCE)
    return tuple(sorted(kept.rows))


def _keep_farthest(kept: _Kept, candidates: list[int], count: int, least: float) -> bool:
    """Keep that many of the candidates, one by one; false if one is nearer than allowed."""
    remaining = list(candidates)
    for _ in range(count):
        distances = kept.distances()[remaining]
        if not len(distances) or distances.max() <= least:
            return False
        row = remaining[int(np.argmax(distances >= (1 - _TIE) * distances.max()))]
        kept.keep(row)
        remaining.remove(row)
    return True
