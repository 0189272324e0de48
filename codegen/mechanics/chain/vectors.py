"""Vectors of three scalars (sympy), and 3 x 3 matrices as rows of them; nothing is expanded."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import sympy

Vector = tuple[Any, Any, Any]
"""Three scalars."""

Rows = tuple[Vector, Vector, Vector]
"""A matrix."""

ZERO: Vector = (sympy.S.Zero,) * 3
IDENTITY: Rows = tuple(tuple(sympy.Integer(int(i == k)) for k in range(3)) for i in range(3))  # type: ignore[assignment]


def vector(values: Iterable[Any]) -> Vector:
    """Three scalars from anything that yields them."""
    x, y, z = values
    return x, y, z


def dot(a: Sequence[Any], b: Sequence[Any]) -> Any:
    """Scalar product."""
    return sympy.Add(*(x * y for x, y in zip(a, b, strict=True)))


def cross(a: Vector, b: Vector) -> Vector:
    """Vector product."""
    return vector(a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3] for k in range(3))


def added(*terms: Sequence[Any]) -> Vector:
    """Sum of vectors."""
    return vector(sympy.Add(*entries) for entries in zip(*terms, strict=True))


def negative(a: Vector) -> Vector:
    """The opposite vector."""
    return vector(-x for x in a)


def scaled(factor: Any, a: Vector) -> Vector:
    """Scalar times vector."""
    return vector(factor * x for x in a)


def times(matrix: Sequence[Sequence[Any]], a: Vector) -> Vector:
    """Matrix times vector."""
    return vector(dot(row, a) for row in matrix)


def product(a: Rows, b: Rows) -> Rows:
    """Matrix times matrix."""
    columns = transposed(b)
    return rows([dot(row, column) for column in columns] for row in a)


def transposed(matrix: Rows) -> Rows:
    """Transpose: columns from rows, rows from columns."""
    return rows(zip(*matrix, strict=True))


def rows(values: Iterable[Iterable[Any]]) -> Rows:
    """A matrix from anything that yields its rows."""
    a, b, c = (vector(row) for row in values)
    return a, b, c


def is_zero(a: Iterable[Any]) -> bool:
    """Whether all entries are identically zero."""
    return all(x == 0 for x in a)
