"""Rotations and vectors in twice the precision of doubles, over many poses at once: entries are arrays."""

from __future__ import annotations

import numpy as np

from codegen.measure.double_double import DoubleDouble

Vector = list[DoubleDouble]
Matrix = list[list[DoubleDouble]]
"""Rows of entries."""


def rotation(q: Vector) -> Matrix:
    """Rotation of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    two, one = DoubleDouble.of(2.0), DoubleDouble.of(1.0)
    return [
        [one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)],
        [two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)],
        [two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)],
    ]


def small_rotation(v: Vector) -> Matrix:
    """Rotation by about the vector ``v``: that of the quaternion (1, v / 2), of norm 1."""
    half = DoubleDouble.of(0.5)
    q = [DoubleDouble.of(np.ones_like(v[0].high)), *(half * part for part in v)]
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    norm = square.sqrt()
    return rotation([part / norm for part in q])


def about(axis: int, sine_cosine: tuple[DoubleDouble, DoubleDouble]) -> Matrix:
    """Rotation about a coordinate axis, by the sine and cosine of its angle."""
    s, c = sine_cosine
    zero, one = DoubleDouble.of(np.zeros_like(s.high)), DoubleDouble.of(np.ones_like(s.high))
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix = [[one if row == column else zero for column in range(3)] for row in range(3)]
    matrix[a][a], matrix[a][b], matrix[b][a], matrix[b][b] = c, -s, s, c
    return matrix


def times(A: Matrix, B: Matrix) -> Matrix:
    """Product of two matrices."""
    return [[row[0] * B[0][k] + row[1] * B[1][k] + row[2] * B[2][k] for k in range(3)] for row in A]


def apply(A: Matrix, v: Vector) -> Vector:
    """A matrix times a vector."""
    return [row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in A]


def transposed(A: Matrix) -> Matrix:
    """The transposed matrix."""
    return [[A[row][column] for row in range(3)] for column in range(3)]


def packed(A: Matrix) -> Vector:
    """Entries column by column."""
    return [A[row][column] for column in range(3) for row in range(3)]


def plus(a: Vector, b: Vector) -> Vector:
    """Sum of two vectors."""
    return [x + y for x, y in zip(a, b, strict=True)]


def minus(a: Vector, b: Vector) -> Vector:
    """Difference of two vectors."""
    return [x - y for x, y in zip(a, b, strict=True)]
