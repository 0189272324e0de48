"""Numbers of twice the precision of doubles, many at once: an unevaluated sum of two arrays of doubles.

About 106 bits, relative error a few 2^-104 an operation (Dekker 1971, error-free sums and products). As a `Domain` they
evaluate a `Program` over thousands of poses in the time that Arb takes for ten; that both agree is tested.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from codegen.ir.evaluate import Domain
from codegen.ir.ops import Constant

Array = NDArray[np.float64]

_SPLITTER = 134217729.0
"""2^27 + 1: halves the digits of a double."""


PI = Fraction(
    "3.1415926535897932384626433832795028841971693993751058209749445923"
    "078164062862089986280348253421170679821480865132823066470938446095"
)
"""To 130 digits."""

_TERMS = 14
"""Of the series of sine and cosine up to an eighth of a turn: the next one is below 1e-34."""

_SMALL = 10
"""The terms from here on are below 1e-20: doubles are enough for them."""


@dataclass(frozen=True, slots=True, eq=False)
class DoubleDouble:
    """An array of numbers.

    Attributes:
        high: the nearest doubles.
        low: what is left, at most half a unit in their last place.
    """

    high: Array
    low: Array

    __array_ufunc__ = None

    @classmethod
    def of(cls, value: Any) -> Self:
        """Take doubles, exactly."""
        high = np.asarray(value, dtype=np.float64)
        return cls(high, np.zeros_like(high))

    @classmethod
    def exact(cls, value: Fraction) -> Self:
        """Round a rational number to twice the precision."""
        high = _nearest(value)
        return cls(np.float64(high), np.float64(_nearest(value - Fraction(high)) if math.isfinite(high) else 0.0))  # type: ignore[arg-type]

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __add__(self, other: DoubleDouble) -> DoubleDouble:
        high, error = _sum(self.high, other.high)
        low, lost = _sum(self.low, other.low)
        high, error = _quick_sum(high, error + low)
        return DoubleDouble(*_quick_sum(high, error + lost))

    def __sub__(self, other: DoubleDouble) -> DoubleDouble:
        return self + (-other)

    def __mul__(self, other: DoubleDouble) -> DoubleDouble:
        high, error = _product(self.high, other.high)
        return DoubleDouble(*_quick_sum(high, error + (self.high * other.low + self.low * other.high)))

    def __truediv__(self, other: DoubleDouble) -> DoubleDouble:
        first = self.high / other.high
        rest = self - other * DoubleDouble.of(first)
        second = rest.high / other.high
        rest = rest - other * DoubleDouble.of(second)
        high, low = _quick_sum(first, second)
        return DoubleDouble(high, low) + DoubleDouble.of(rest.high / other.high)

    def sqrt(self) -> DoubleDouble:
        """Square root, by one step of Newton from that of the high part."""
        root = np.sqrt(self.high)
        square, error = _product(root, root)
        rest = self - DoubleDouble(square, error)
        with np.errstate(divide="ignore", invalid="ignore"):
            step = np.where(root > 0, rest.high / (2 * root), 0.0)
        return DoubleDouble(*_quick_sum(root, step))

    def sine_and_cosine(self) -> tuple[DoubleDouble, DoubleDouble]:
        """Sine and cosine, of angles up to 1e9 rad."""
        turns = np.rint(self.high * (2 / math.pi))
        angle = self
        for part in _half_pi():
            product, error = _product(turns, np.float64(part))  # type: ignore[arg-type]
            angle = angle - DoubleDouble(product, error)
        square = angle * angle
        sine, cosine = (_series(square, start) for start in (1, 0))
        sine = angle * sine
        quarter = turns.astype(np.int64) % 4
        swapped = quarter % 2 == 1
        s, c = _chosen(swapped, cosine, sine), _chosen(swapped, sine, cosine)
        return _signed(quarter >= 2, s), _signed((quarter == 1) | (quarter == 2), c)

    def sin(self) -> DoubleDouble:
        """Sine."""
        return self.sine_and_cosine()[0]

    def cos(self) -> DoubleDouble:
        """Cosine."""
        return self.sine_and_cosine()[1]


def arc_tangent(y: DoubleDouble, x: DoubleDouble) -> DoubleDouble:
    """Angle of (y, x): that of the high parts, turned by the small angle that is left."""
    angle = DoubleDouble.of(np.arctan2(y.high, x.high))
    sine, cosine = angle.sine_and_cosine()
    return angle + (y * cosine - x * sine) / (x * cosine + y * sine)


def double_double_domain() -> Domain:
    """Arrays of `DoubleDouble`, elementwise; constants are rounded to twice the precision."""
    return Domain(
        "double-double",
        _constant,
        DoubleDouble.sqrt,
        DoubleDouble.sin,
        DoubleDouble.cos,
        arc_tangent,
    )


@cache
def _constant(constant: Constant) -> DoubleDouble:
    return DoubleDouble.exact(constant.rational * PI**constant.pi_power)


@cache
def _half_pi() -> tuple[float, ...]:
    """Half pi as four doubles, each as long as it can be."""
    parts, rest = [], PI / 2
    for _ in range(4):
        parts.append(_nearest(rest))
        rest -= Fraction(parts[-1])
    return tuple(parts)


def _nearest(value: Fraction) -> float:
    return value.numerator / value.denominator


def _series(square: DoubleDouble, start: int) -> DoubleDouble:
    """Sum of ``(-x^2)^k / (2 k + start)!``."""
    small = np.zeros_like(square.high)
    for k in range(_TERMS, _SMALL - 1, -1):
        small = small * square.high + _coefficient(k, start).high
    total = DoubleDouble.of(small)
    for k in range(_SMALL - 1, -1, -1):
        total = total * square + _coefficient(k, start)
    return total


@cache
def _coefficient(k: int, start: int) -> DoubleDouble:
    return DoubleDouble.exact(Fraction((-1) ** k, math.factorial(2 * k + start)))


def _chosen(condition: Any, first: DoubleDouble, second: DoubleDouble) -> DoubleDouble:
    return DoubleDouble(np.where(condition, first.high, second.high), np.where(condition, first.low, second.low))


def _signed(condition: Any, value: DoubleDouble) -> DoubleDouble:
    return _chosen(condition, -value, value)


def _sum(a: Array, b: Array) -> tuple[Array, Array]:
    """Sum and its rounding error (Knuth)."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _quick_sum(a: Array, b: Array) -> tuple[Array, Array]:
    """Sum and its rounding error where ``a`` is the larger."""
    total = a + b
    return total, b - (total - a)


def _product(a: Array, b: Array) -> tuple[Array, Array]:
    """Product and its rounding error (Dekker, Veltkamp)."""
    product = a * b
    a_high, a_low = _halves(a)
    b_high, b_low = _halves(b)
    return product, a_low * b_low - (((product - a_high * b_high) - a_low * b_high) - a_high * b_low)


def _halves(a: Array) -> tuple[Array, Array]:
    scaled = _SPLITTER * a
    high = scaled - (scaled - a)
    return high, a - high
