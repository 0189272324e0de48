"""Independent and dependent coordinates, rows that bind, and the units in which both are compared."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Numbers = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class Partition:
    """How a chain is solved.

    Attributes:
        v: numbers of the independent coordinates.
        w: numbers of the dependent ones.
        rows: rows of the cuts that are not structurally zero.
        units: [n] m or rad of each coordinate: 1 for angles, the characteristic length for lengths.
        row_units: [6 nr] likewise, of each row.
        reach: largest length of the chain, in characteristic ones, 1 at least: positions are known to rounding of it.
        places: [m, 1] rows and [1, nw] columns of what binds the dependent coordinates in a Jacobian of the cuts.
        scale: [m, nw] that takes the dimensions out of it.
    """

    v: Numbers
    w: Numbers
    rows: Numbers
    units: Array
    row_units: Array
    reach: float
    places: tuple[Numbers, ...]
    scale: Array

    def dependent(self, matrix: Array) -> Array:
        """The binding rows and dependent columns [m, nw] of a Jacobian of the cuts, without dimension."""
        return np.asarray(matrix[self.places] * self.scale)

    def binding(self, values: Array) -> Array:
        """The binding rows of a vector, or columns, without dimension."""
        units = self.row_units[self.rows]
        return np.asarray(values[self.rows] / (units if values.ndim == 1 else units[:, None]))


def partition(
    is_prismatic: list[bool], independent: list[int], bound: list[bool], length: float, reach: float = 1.0
) -> Partition:
    """Part the coordinates of a chain.

    Args:
        is_prismatic: of each joint.
        independent: numbers of the independent coordinates.
        bound: of each row of the cuts, whether it is not structurally zero.
        length: characteristic, m.
        reach: largest length of the chain, in characteristic ones.
    """
    units = np.where(is_prismatic, length, 1.0)
    row_units = np.tile([length] * 3 + [1.0] * 3, len(bound) // 6)
    w = [k for k in range(len(is_prismatic)) if k not in independent]
    v, others, rows = _numbers(independent), _numbers(w), _numbers(np.flatnonzero(bound))
    scale = units[others] / row_units[rows, None]
    return Partition(v, others, rows, units, row_units, max(1.0, reach), np.ix_(rows, others), scale)


def _numbers(values: object) -> Numbers:
    return np.array(values, dtype=np.intp)
