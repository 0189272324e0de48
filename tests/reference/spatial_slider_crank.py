"""The spatial slider-crank of S2 from its closed-form geometry; q is the angle of the crank from +z towards +y."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from typing import Any

import sympy

from .one_freedom import Body, OneFreedom, q

OFFSETS, CRANK = (sympy.Rational(1, 10), sympy.Rational(12, 100)), sympy.Rational(8, 100)
"""m: the crank's axis is parallel to x through (0, 0.1, 0.12)."""

LENGTHS = (Fraction(24, 100), Fraction(27, 100), Fraction(30, 100))
"""m, of the rod."""

SPEED = 2 * sympy.pi


@cache
def spatial_slider_crank(length: Fraction, branch: int = 1) -> OneFreedom:
    """The mechanism.

    Args:
        length: of the rod, m.
        branch: 1 with the slider on the side of +x, -1 on the other.
    """
    L = sympy.Rational(length.numerator, length.denominator)
    y, z = OFFSETS[0] + CRANK * sympy.sin(q), OFFSETS[1] + CRANK * sympy.cos(q)
    x = branch * sympy.sqrt(L**2 - y**2 - z**2)
    pin, slider = sympy.Matrix([0, y, z]), sympy.Matrix([x, 0, 0])
    aside = sympy.sqrt(y**2 + z**2)
    along = (pin - slider) / L
    axis = sympy.Matrix([0, -z, y]) / aside  # perpendicular to rod and x
    rod = sympy.Matrix.hstack(axis.cross(along) * -1, along, axis)
    crank = _about_x(-q)
    bodies = {
        "crank": Body(_d("0.12"), _diag("0.0001", "0.00001", "0.0001"), sympy.Matrix([0, *OFFSETS]), crank),
        "rod": Body(_d("0.5"), _diag("0.004", "0.0004", "0.004"), (pin + slider) / 2, rod),
        "slider": Body(2, _diag("0.0001", "0.0001", "0.0001"), slider, sympy.eye(3)),
    }
    return OneFreedom(bodies, (0, 0, -_d("9.81")), {"x": x, "azimuth": sympy.atan2(-y, z), "aside": aside})


def lock_up() -> Any:
    """The shortest rod with which the crank turns over."""
    return sympy.sqrt(OFFSETS[0] ** 2 + OFFSETS[1] ** 2) + CRANK


def _about_x(angle: Any) -> sympy.Matrix:
    c, s = sympy.cos(angle), sympy.sin(angle)
    return sympy.Matrix([[1, 0, 0], [0, c, -s], [0, s, c]])


def _d(decimal: str) -> Any:
    return sympy.Rational(Fraction(decimal).numerator, Fraction(decimal).denominator)


def _diag(*moments: str) -> sympy.Matrix:
    return sympy.diag(*map(_d, moments))
