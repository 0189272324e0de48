"""Structural patterns of vectors and matrices, and what the schoolbook operations on them cost (rule R1).

Input: which entries are structurally non-zero. Output: numbers of multiplications and additions, each 1. The
costs that the paper's readers know (27 for matrix times skew, 15 for skew times skew, ...) all follow; none
is written down.
"""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Pattern:
    """Where a scalar, vector or matrix is not structurally zero.

    Attributes:
        rows: number of rows.
        columns: number of columns.
        filled: the (row, column) of each non-zero.
        skew: True for a skew matrix, which is stored and added as half of its non-zeros.
    """

    rows: int
    columns: int
    filled: frozenset[tuple[int, int]]
    skew: bool = False

    @property
    def transposed(self) -> Pattern:
        """The pattern of the transpose."""
        return Pattern(self.columns, self.rows, frozenset((j, i) for i, j in self.filled), self.skew)

    @property
    def numbers(self) -> int:
        """How many different numbers it holds: what a scaling costs."""
        return _numbers(len(self.filled), self.skew)

    @property
    def is_row(self) -> bool:
        """True for a row of several numbers."""
        return self.rows == 1 < self.columns

    @property
    def is_column(self) -> bool:
        """True for a column of several numbers."""
        return self.columns == 1 < self.rows

    @property
    def is_general_matrix(self) -> bool:
        """True for a matrix that is not skew."""
        return self.rows > 1 < self.columns and not self.skew

    def without_row(self, row: int) -> Pattern:
        """The same with one row structurally zero."""
        return replace(self, filled=frozenset(entry for entry in self.filled if entry[0] != row))


def full(rows: int, columns: int) -> Pattern:
    """A pattern without structural zeros."""
    return Pattern(rows, columns, frozenset((i, j) for i in range(rows) for j in range(columns)))


SCALAR = full(1, 1)
COLUMN = full(3, 1)
MATRIX = full(3, 3)
SKEW = Pattern(3, 3, frozenset((i, j) for i in range(3) for j in range(3) if i != j), skew=True)
DIAGONAL = Pattern(3, 3, frozenset((i, i) for i in range(3)))


def multiply(left: Pattern, right: Pattern) -> tuple[int, Pattern]:
    """Cost and pattern of a product: a sum of n products in an entry costs 2 n - 1."""
    inner: dict[tuple[int, int], int] = {}
    for i, k in left.filled:
        for j in range(right.columns):
            if (k, j) in right.filled:
                inner[i, j] = inner.get((i, j), 0) + 1
    cost = sum(2 * number - 1 for number in inner.values())
    return cost, Pattern(left.rows, right.columns, frozenset(inner))


def add(left: Pattern, right: Pattern) -> tuple[int, Pattern]:
    """Cost and pattern of a sum: 1 for each entry where both are non-zero, half of it when both are skew."""
    skew = left.skew and right.skew
    cost = _numbers(len(left.filled & right.filled), skew)
    return cost, Pattern(left.rows, left.columns, left.filled | right.filled, skew)


def _numbers(entries: int, skew: bool) -> int:
    return entries // 2 if skew else entries
