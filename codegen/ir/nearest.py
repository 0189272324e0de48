"""Exact constants rounded to doubles: the one rounding that the evaluator and every emitter share."""

from __future__ import annotations

from fractions import Fraction

from codegen.ir.ops import Constant

_PI_DIGITS = 3141592653589793238462643383279502884197169399375105820974944592307816406286208998628034825342117067982148
_PI = Fraction(_PI_DIGITS, 10 ** (len(str(_PI_DIGITS)) - 1))


def nearest_double(constant: Constant) -> float:
    """Round an exact constant to the nearest double."""
    return float(constant.rational * _PI**constant.pi_power if constant.pi_power else constant.rational)
