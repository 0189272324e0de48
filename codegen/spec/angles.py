"""Angles as exact numbers in rad: multiples of pi to 50 digits, and their sines and cosines to 45.

An angle within 1e-9 rad of a multiple of a right angle is that multiple: its sine and cosine are 0, 1 or -1.
"""

from __future__ import annotations

from decimal import Context, Decimal
from fractions import Fraction

PI = Fraction("3.14159265358979323846264338327950288419716939937511")
"""Pi to 50 digits."""

NEARLY = Fraction(1, 10**9)
"""Angles that are closer to a right angle, in rad, mean one."""

_SIMPLE = Fraction(1, 10**40)
_DIGITS = Context(prec=55)
_TERMS = 40


def quarter_turns(angle: Fraction) -> int | None:
    """The number of right angles that an angle in rad is; None if it is no multiple of one."""
    quarters = round(angle / (PI / 2))
    return quarters if abs(angle - quarters * PI / 2) <= NEARLY else None


def cosine_and_sine(angle: Fraction) -> tuple[Fraction, Fraction]:
    """Cosine and sine of an angle in rad: exact where they are multiples of 1/2, else to 45 digits."""
    quarters = round(angle / (PI / 2))
    rest = Fraction(0) if quarter_turns(angle) is not None else angle - quarters * PI / 2
    cosine, sine = _series(rest, 0), _series(rest, 1)
    for _ in range(quarters % 4):
        cosine, sine = -sine, cosine
    return cosine, sine


def _series(angle: Fraction, first: int) -> Fraction:
    """The cosine (first = 0) or sine (first = 1) of an angle of at most a right angle, by its power series."""
    x = _DIGITS.divide(Decimal(angle.numerator), Decimal(angle.denominator))
    square = _DIGITS.multiply(x, x)
    term = Decimal(1) if first == 0 else x
    total = term
    for k in range(1, _TERMS):
        divisor = Decimal(-(2 * k + first) * (2 * k + first - 1))
        term = _DIGITS.divide(_DIGITS.multiply(term, square), divisor)
        total = _DIGITS.add(total, term)
    return _rounded(Fraction(total))


def _rounded(value: Fraction) -> Fraction:
    """Multiples of 1/2 as they are meant, other values to 45 digits."""
    simple = Fraction(round(2 * value), 2)
    return simple if abs(value - simple) < _SIMPLE else Fraction(round(value * 10**45), 10**45)
