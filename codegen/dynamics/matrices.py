"""Sparse matrices whose entries are values of a program under construction."""

from __future__ import annotations

from collections.abc import Iterable

from codegen.ir.builder import Builder
from codegen.ir.inline import Entries
from codegen.ir.ops import Op


class Matrices:
    """Arithmetic of matrices over a builder; nothing is simplified, that is for the passes."""

    def __init__(self, builder: Builder) -> None:
        self.builder = builder

    def total(self, parts: Iterable[Entries]) -> Entries:
        """Add matrices up."""
        found: Entries = {}
        for part in parts:
            for place, value in part.items():
                found[place] = self.builder.emit(Op.ADD, found[place], value) if place in found else value
        return found

    def product(self, left: Entries, right: Entries) -> Entries:
        """``left right``."""
        rows: dict[int, list[tuple[int, int]]] = {}
        for (row, column), value in right.items():
            rows.setdefault(row, []).append((column, value))
        found: Entries = {}
        for (row, inner), a in left.items():
            for column, b in rows.get(inner, ()):
                term = self.builder.emit(Op.MULTIPLY, a, b)
                place = row, column
                found[place] = self.builder.emit(Op.ADD, found[place], term) if place in found else term
        return found

    def scaled(self, factor: int, matrix: Entries) -> Entries:
        """A value times a matrix."""
        return {place: self.builder.emit(Op.MULTIPLY, factor, value) for place, value in matrix.items()}

    def negative(self, matrix: Entries) -> Entries:
        """``-matrix``."""
        return {place: self.builder.emit(Op.NEGATE, value) for place, value in matrix.items()}

    def skew(self, vector: Iterable[int]) -> Entries:
        """S1's tilde of three values."""
        x, y, z = vector
        signed = {(2, 1): x, (0, 2): y, (1, 0): z}
        return signed | self.negative({(column, row): value for (row, column), value in signed.items()})


def transposed(matrix: Entries) -> Entries:
    """Transpose."""
    return {(column, row): value for (row, column), value in matrix.items()}


def moved(matrix: Entries, row: int, column: int) -> Entries:
    """The same entries further down and to the right."""
    return {(row + i, column + k): value for (i, k), value in matrix.items()}
