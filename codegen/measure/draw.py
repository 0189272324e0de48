"""Numbers drawn from the columns of points of the unit cube: Sobol points, the same in every run."""

from __future__ import annotations

import warnings
from functools import cache

import numpy as np
from numpy.typing import NDArray

from codegen.measure.double_double import PI, DoubleDouble
from codegen.measure.ideal_rotations import Matrix, Vector, rotation

Points = NDArray[np.float64]

SEED = 20
COLUMNS = 80
"""Dimensions of the sequence; a pose of a joint takes some 60."""


@cache
def sobol_points(count: int, columns: int = COLUMNS) -> Points:
    """Points [poses, dimensions] of the unit cube, the same in every run."""
    from scipy.stats import qmc

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The balance properties")
        points = np.asarray(qmc.Sobol(columns, scramble=True, rng=SEED).random(count))
    points.flags.writeable = False
    return points


class Draw:
    """The columns of points, taken one after the other."""

    def __init__(self, points: Points) -> None:
        self._points = points
        self._next = 0
        self.zero = DoubleDouble.of(np.zeros(len(points)))

    def unit(self) -> DoubleDouble:
        """Numbers in [0, 1)."""
        self._next += 1
        return DoubleDouble.of(self._points[:, self._next - 1])

    def within(self, low: float, high: float) -> DoubleDouble:
        """Doubles in an interval."""
        return DoubleDouble.of(low + (high - low) * self.unit().high)

    def whole(self, largest: int) -> DoubleDouble:
        """Integers from ``-largest`` to ``largest``."""
        return DoubleDouble.of(np.floor(self.unit().high * (2 * largest + 1)) - largest)

    def vector(self, length: int, bound: float) -> Vector:
        """Entries in ``[-bound, bound]``."""
        return [self.within(-bound, bound) for _ in range(length)]


def any_attitude(draw: Draw) -> Matrix:
    """Rotations, evenly over all attitudes (Shoemake)."""
    return rotation(unit_quaternion(draw))


def unit_quaternion(draw: Draw) -> Vector:
    """Quaternions (w, x, y, z) of norm 1, evenly over all attitudes (Shoemake)."""
    share, first, second = draw.unit(), draw.unit(), draw.unit()
    turn = DoubleDouble.exact(2 * PI)
    one = DoubleDouble.of(1.0)
    s, c = (turn * first).sine_and_cosine()
    sine, cosine = (turn * second).sine_and_cosine()
    small, large = (one - share).sqrt(), share.sqrt()
    return [small * s, small * c, large * sine, large * cosine]


def drifted(A: Matrix, drift: float, draw: Draw) -> Matrix:
    """Entries off by up to the drift."""
    return [[entry + draw.within(-drift, drift) for entry in row] for row in A]
