"""Matrices as lists of rows over the scalars of any tool.

Plain lists, since scalars of some tools do not live in numpy arrays. The numbers 0 and 1 are Python's, so that a zero
never reaches a tool that would keep it.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Scalar = Any
Vector = list[Scalar]
Matrix = list[list[Scalar]]


def is_zero(x: Scalar) -> bool:
    """Tell Python's 0, the structural zero."""
    return isinstance(x, int) and x == 0


def add(a: Scalar, b: Scalar) -> Scalar:
    """Sum of two scalars."""
    return b if is_zero(a) else a if is_zero(b) else a + b


def multiply(a: Scalar, b: Scalar) -> Scalar:
    """Product of two scalars."""
    if is_zero(a) or is_zero(b):
        return 0
    for x, y in ((a, b), (b, a)):
        if isinstance(x, int) and abs(x) == 1:
            return y if x == 1 else -y
    return a * b


def dot(a: Sequence[Scalar], b: Sequence[Scalar]) -> Scalar:
    """Scalar product of two vectors of the same length."""
    total: Scalar = 0
    for x, y in zip(a, b, strict=True):
        total = add(total, multiply(x, y))
    return total


def identity() -> Matrix:
    """The 3 x 3 identity."""
    return [[int(row == column) for column in range(3)] for row in range(3)]


def zeros(rows: int, columns: int) -> Matrix:
    """A matrix of structural zeros."""
    return [[0] * columns for _ in range(rows)]


def transpose(a: Matrix) -> Matrix:
    """Transpose of a matrix."""
    return [list(column) for column in zip(*a, strict=True)]


def product(a: Matrix, b: Matrix) -> Matrix:
    """Matrix product."""
    columns = transpose(b)
    return [[dot(row, column) for column in columns] for row in a]


def apply(a: Matrix, x: Vector) -> Vector:
    """Matrix times vector."""
    return [dot(row, x) for row in a]


def plus(a: Matrix, b: Matrix) -> Matrix:
    """Matrix sum."""
    return [[add(x, y) for x, y in zip(p, q, strict=True)] for p, q in zip(a, b, strict=True)]


def scaled(factor: Scalar, a: Matrix) -> Matrix:
    """Matrix times scalar."""
    return [[multiply(factor, x) for x in row] for row in a]


def negative(a: Matrix) -> Matrix:
    """Matrix with the signs changed."""
    return scaled(-1, a)


def sum_of(vectors: Sequence[Vector]) -> Vector:
    """Sum of vectors."""
    total: Vector = [0] * len(vectors[0])
    for vector in vectors:
        total = [add(x, y) for x, y in zip(total, vector, strict=True)]
    return total


def opposite(a: Vector) -> Vector:
    """Vector with the signs changed."""
    return [multiply(-1, x) for x in a]


def tilde(a: Vector) -> Matrix:
    """The skew matrix ``a~`` with ``a~ b = a x b``."""
    x, y, z = a
    return [[0, -z, y], [z, 0, -x], [-y, x, 0]]
