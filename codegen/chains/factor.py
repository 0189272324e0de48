"""Solve with the Jacobian of the dependent coordinates: LU where it is square and sound, else QR with pivoting.

Both are LAPACK's; SVD says what is wrong where the rank is in doubt. The matrix has no dimension: lengths are divided
by the characteristic one. Nothing is truncated: a matrix that lacks rank is told with its singular values and the
coordinates that are free to move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from numpy.typing import NDArray
from scipy.linalg import lapack

Array = NDArray[np.float64]

RANK_TOLERANCE = 1e-10
"""A pivot, or a singular value, below this part of the largest is 0."""

_SOUND = 1e6
"""Condition number up to which LU is taken; beyond, QR decides on the rank."""


class RankLoss(Exception):
    """The Jacobian of the dependent coordinates lacks rank.

    Attributes:
        rank: by the singular values.
        wanted: number of dependent coordinates.
        least: smallest singular value, relative to the largest.
        free: [wanted] direction in which the dependent coordinates are free to move, of length 1.
    """

    def __init__(self, rank: int, wanted: int, least: float, free: Array) -> None:
        super().__init__(f"rank {rank} of {wanted}")
        self.rank, self.wanted, self.least, self.free = rank, wanted, least, free


@dataclass(frozen=True, slots=True, eq=False)
class Square:
    """A factorisation ``P A = L U`` of a matrix [n, n] far from singular.

    Attributes:
        A: the matrix.
        packed: [n, n] L and U.
        pivots: [n] of P, as LAPACK has them.
    """

    A: Array
    packed: Array
    pivots: NDArray[np.int32]

    @property
    def sign(self) -> float:
        """Sign of the determinant, 1 or -1."""
        swapped = np.count_nonzero(self.pivots != np.arange(len(self.pivots)))
        negative = np.count_nonzero(np.diagonal(self.packed) < 0)
        return -1.0 if (swapped + negative) % 2 else 1.0

    def solve(self, b: Array) -> Array:
        """Give x with ``A x = b``; b [n] or [n, k]."""
        return np.asarray(lapack.dgetrs(self.packed, self.pivots, b)[0])

    def solve_transposed(self, c: Array) -> Array:
        """Give f [n] with ``A^T f = c``."""
        return np.asarray(lapack.dgetrs(self.packed, self.pivots, c, trans=1)[0])

    def undetermined(self) -> Array:
        """Give the basis [n, 0] of the f with ``A^T f = 0``: there are none."""
        return np.zeros((len(self.A), 0))


@dataclass(frozen=True, slots=True, eq=False)
class Tall:
    """A factorisation ``A P = Q R`` of a matrix [m, n] of full column rank.

    Attributes:
        A: the matrix.
        Q: [m, n].
        R: [n, n].
        order: [n] columns in the order of P.
    """

    A: Array
    Q: Array
    R: Array
    order: NDArray[np.intp]

    def solve(self, b: Array) -> Array:
        """Give x with the least ``|A x - b|``; b [m] or [m, k]."""
        found = np.empty((len(self.order), *b.shape[1:]))
        if found.size:
            found[self.order] = lapack.dtrtrs(self.R, self.Q.T @ b)[0]
        return found

    def solve_transposed(self, c: Array) -> Array:
        """Give the smallest f [m] with ``A^T f = c``."""
        if not len(c):
            return np.zeros(len(self.Q))
        return np.asarray(self.Q @ lapack.dtrtrs(self.R, c[self.order], trans=1)[0])

    def undetermined(self) -> Array:
        """Give an orthonormal basis [m, m - n] of the f with ``A^T f = 0``."""
        return np.asarray(scipy.linalg.null_space(self.Q.T, rcond=1e-8))


Factor = Square | Tall


def factor(A: Array) -> Factor:
    """Factorise.

    Raises:
        RankLoss: the columns depend on each other.
    """
    if not A.shape[1]:
        return Tall(A, np.zeros((len(A), 0)), np.zeros((0, 0)), np.zeros(0, dtype=np.intp))
    if A.shape[0] < A.shape[1]:
        raise diagnosed(A)
    if A.shape[0] == A.shape[1]:
        packed, swaps, singular = lapack.dgetrf(A)
        if not singular and lapack.dgecon(packed, np.abs(A).sum(axis=0).max())[0] > 1 / _SOUND:
            return Square(A, packed, swaps)
    packed, order, tau, _, _ = lapack.dgeqp3(A)
    R = np.triu(packed[: A.shape[1]])
    pivots = np.abs(np.diagonal(R))
    if not pivots[-1] > RANK_TOLERANCE * pivots[0]:
        raise diagnosed(A)
    return Tall(A, lapack.dorgqr(packed, tau)[0], R, np.asarray(order - 1, dtype=np.intp))


def diagnosed(A: Array) -> RankLoss:
    """Say by singular values what a matrix lacks."""
    n = A.shape[1]
    sigma, rows = np.zeros(n), np.eye(n)
    if A.any():
        _, found, rows = scipy.linalg.svd(A)
        sigma[: len(found)] = found / found[0]
    return RankLoss(int(np.sum(sigma > RANK_TOLERANCE)), n, float(sigma[-1]), np.asarray(rows[-1]))


def least_singular_value(A: Array) -> float:
    """Smallest singular value, relative to the largest; 1 without columns."""
    if not A.size:
        return 1.0
    sigma = scipy.linalg.svdvals(A, check_finite=False)
    return float(sigma[-1] / sigma[0]) if len(sigma) == A.shape[1] and sigma[0] else 0.0
