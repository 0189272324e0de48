"""A block of a sparse matrix eliminated in straight-line C, in an order of pivots that is known beforehand.

With row and column k those of pivot k, ``B = L D U``, L and U with ones on their diagonals,

- ``d_i u_ij = b_ij - sum_k l_ik d_k u_kj`` for i <= j, ``l_ij d_j = b_ij - sum_k l_ik d_k u_kj`` for i > j, by columns;
- ``y_k = b_k - sum_m l_km y_m`` and ``x_k = y_k / d_k - sum_m u_km x_m``, where no division waits for another one.

Sums go over the entries that are no structural zeros, so that neither an index nor a branch is left.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

Place = tuple[int, int]

PART = 30
"""Least number of statements of a part of an elimination."""


@dataclass(frozen=True)
class Elimination:
    """A block and its pivots, in the order of elimination.

    Attributes:
        columns: rows of the nonzeros of each column, ascending, numbered in the block.
        pivot_rows: row of each pivot.
        pivot_columns: column of each pivot.
    """

    columns: tuple[tuple[int, ...], ...]
    pivot_rows: tuple[int, ...]
    pivot_columns: tuple[int, ...]

    @property
    def size(self) -> int:
        """Rows of the block."""
        return len(self.pivot_rows)

    @cached_property
    def terms(self) -> dict[Place, list[int]]:
        """Nonzero of L, D and U, by pivots -> the k of its sum."""
        row = {number: k for k, number in enumerate(self.pivot_rows)}
        column = {number: k for k, number in enumerate(self.pivot_columns)}
        found: dict[Place, list[int]] = {(row[i], column[j]): [] for j, rows in enumerate(self.columns) for i in rows}
        below: dict[int, set[int]] = defaultdict(set)
        right: dict[int, set[int]] = defaultdict(set)
        for i, j in found:
            (below[j] if i > j else right[i]).add(max(i, j))
        for k in range(self.size):
            for i in sorted(below[k]):
                for j in sorted(right[k] - {k}):
                    found.setdefault((i, j), []).append(k)
                    (below[j] if i > j else right[i]).add(max(i, j))
        return found

    @cached_property
    def places(self) -> dict[Place, int]:
        """Nonzero -> its place in storage: L, then the inverse pivots, then U."""
        lower = sorted(place for place in self.terms if place[0] > place[1])
        upper = sorted(place for place in self.terms if place[0] < place[1])
        return {place: n for n, place in enumerate([*lower, *((k, k) for k in range(self.size)), *upper])}

    @property
    def lower(self) -> int:
        """Entries of L."""
        return sum(i > j for i, j in self.terms)

    @property
    def room(self) -> int:
        """Entries in storage."""
        return len(self.places)

    @property
    def products(self) -> int:
        """Products of the elimination."""
        return sum(map(len, self.terms.values()))

    def factor_parts(self) -> Iterator[list[str]]:
        """Write the elimination: ``f`` from ``values`` by the ``pointers`` of the ``columns``, some columns a part.

        Parts are for functions of their own, since compilers take more than twice as long for twice as many statements.
        """
        by_column: dict[int, list[int]] = defaultdict(list)
        for i, j in sorted(self.terms):
            by_column[j].append(i)
        part: list[str] = []
        for j in range(self.size):
            part += self._column(j, by_column[j])
            if len(part) >= PART or j == self.size - 1:
                yield part
                part = []

    def _column(self, j: int, rows: list[int]) -> Iterator[str]:
        number = self.pivot_columns[j]
        given = {row: n for n, row in enumerate(self.columns[number])}
        yield f"a = values + pointers[columns[{number}]];"
        for i in rows:
            n = given.get(self.pivot_rows[i])
            products = ((self._f(i, k), f"u{k}_{j}") for k in self.terms[i, j])
            yield from self._entry(i, j, _sum("0.0" if n is None else f"a[{n}]", products))

    def _entry(self, i: int, j: int, value: str) -> Iterator[str]:
        if i < j:
            yield f"const double u{i}_{j} = {value};"
            yield f"{self._f(i, j)} = u{i}_{j} * {self._f(i, i)};"
        elif i == j:
            yield f"{self._f(j, j)} = 1.0 / ({value});"
        else:
            yield f"{self._f(i, j)} = ({value}) * {self._f(j, j)};"

    def _f(self, i: int, j: int) -> str:
        return f"f[{self.places[i, j]}]"

    def solve_lines(self) -> Iterator[str]:
        """Write the solution with the factors ``f``: ``x`` at ``columns`` from ``b`` at ``rows``."""
        by_row: dict[int, list[int]] = defaultdict(list)
        for i, j in sorted(self.terms):
            by_row[i].append(j)
        for k, number in enumerate(self.pivot_rows):
            products = ((self._f(k, m), f"y{m}") for m in by_row[k] if m < k)
            yield f"const double y{k} = {_sum(f'b[rows[{number}]]', products)};"
        for k in reversed(range(self.size)):
            products = ((self._f(k, m), f"x{m}") for m in by_row[k] if m > k)
            yield f"const double x{k} = {_sum(f'y{k} * {self._f(k, k)}', products)};"
            yield f"x[columns[{self.pivot_columns[k]}]] = x{k};"


def _sum(start: str, products: Iterator[tuple[str, str]]) -> str:
    return start + "".join(f" - {one} * {other}" for one, other in products)


def local_columns(
    pointers: Sequence[int], indices: Sequence[int], rows: Sequence[int], columns: Sequence[int]
) -> tuple[tuple[int, ...], ...]:
    """Number the nonzeros of a block by its rows.

    Args:
        pointers: of the columns of the matrix.
        indices: rows of its nonzeros, ascending in each column.
        rows: of the block, ascending.
        columns: of the block.
    """
    number = {row: k for k, row in enumerate(rows)}
    return tuple(tuple(number[row] for row in indices[pointers[c] : pointers[c + 1]]) for c in columns)
