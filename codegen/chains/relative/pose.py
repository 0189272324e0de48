"""Poses as exact numbers, and the rows of a chain's table that say them."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction

import mpmath

from codegen.spec.chain import Row
from codegen.spec.placement import IDENTITY, dot, square_root, times, transposed
from codegen.spec.scene import ZERO_VECTOR, Matrix, Vector

_DIGITS = 50
_NONE = Fraction(1, 10**30)
"""What is smaller comes from the digits of square roots."""


@dataclass(frozen=True, slots=True)
class Pose:
    """A frame in another: rotation, its columns are the frame's axes, and origin in m."""

    R: Matrix = IDENTITY
    p: Vector = ZERO_VECTOR

    def __matmul__(self, other: Pose) -> Pose:
        turned = times(self.R, other.p)
        return Pose(multiplied(self.R, other.R), _vector(a + b for a, b in zip(self.p, turned, strict=True)))

    @property
    def inverse(self) -> Pose:
        """The other frame in this one."""
        back = transposed(self.R)
        return Pose(back, _vector(-x for x in times(back, self.p)))


def multiplied(a: Matrix, b: Matrix) -> Matrix:
    """Matrix times matrix."""
    columns = transposed(b)
    return tuple(_vector(dot(row, column) for column in columns) for row in a)  # type: ignore[return-value]


def row_of(pose: Pose) -> Row:
    """The six constants of a pose."""
    R, (x, y, z) = pose.R, pose.p
    sine = square_root(R[0][2] ** 2 + R[1][2] ** 2)
    if sine < _NONE:
        return _parallel(R, pose.p)
    psi, alpha, theta = angle(R[0][2], -R[1][2]), angle(sine, R[2][2]), angle(R[2][0], R[2][1])
    across = -R[1][2] / sine, R[0][2] / sine
    d = -(y * across[0] - x * across[1]) / sine
    return Row(psi, _whole(z - d * R[2][2]), alpha, _whole(x * across[0] + y * across[1]), theta, _whole(d))


def _parallel(R: Matrix, p: Vector) -> Row:
    """The same where both axes z are parallel."""
    x, y, z = p
    away = square_root(x * x + y * y)
    psi = angle(y, x) if away > _NONE else Fraction(0)
    turned = angle(R[1][0], R[0][0])
    is_same = R[2][2] > 0
    theta = turned - psi if is_same else psi - turned
    return Row(psi, _whole(z), Fraction(0) if is_same else angle(Fraction(0), Fraction(-1)), _whole(away), theta)


def angle(sine: Fraction, cosine: Fraction) -> Fraction:
    """The angle in rad of which these are sine and cosine, or multiples of them."""
    if abs(sine) < _NONE and cosine > 0:
        return Fraction(0)
    with mpmath.workdps(_DIGITS):
        found = mpmath.atan2(_number(sine), _number(cosine))
        return Fraction(mpmath.nstr(found, _DIGITS))


def _number(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator


def _whole(value: Fraction) -> Fraction:
    return value if abs(value) > _NONE else Fraction(0)


def _vector(values: Iterable[Fraction]) -> Vector:
    x, y, z = values
    return x, y, z
