"""Sine and cosine by short polynomials, to see what a cheap approximation costs in accuracy and saves in time."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from codegen.emit.environment import render

DEGREES = (5, 7, 9, 11)
"""Of the sine; the cosine has one less."""

_QUARTERS = (1.5707963109016418, 1.5893254712295857e-08, 6.123233995736766e-17)
"""A quarter turn in pieces: products of the first with up to 2^29 quarters are exact."""


def short_sincos(degree: int) -> str:
    """Write the C function that takes the place of ``jg_sincos``; for angles up to some thousand turns.

    Args:
        degree: of the sine, odd.
    """
    count = degree // 2
    return render(
        "measure/short_sincos.c.j2",
        degree=degree,
        per_quarter=repr(2 / math.pi),
        quarters=[repr(part) for part in _QUARTERS],
        sine=_horner(coefficients(_sine_over_angle, count)),
        cosine=_horner(coefficients(lambda t: math.cos(math.sqrt(t)), count)),
    )


def coefficients(function: Callable[[float], float], degree: int) -> tuple[float, ...]:
    """Interpolate a function of the square of the angle at Chebyshev points up to an eighth of a turn."""
    end = (math.pi / 4) ** 2
    points = [end / 2 * (1 + math.cos(math.pi * (k + 0.5) / (degree + 1))) for k in range(degree + 1)]
    powers = np.vander(np.array(points) / end, increasing=True)
    found = np.linalg.solve(powers, np.array([function(t) for t in points]))
    return tuple(float(c) / end**k for k, c in enumerate(found))


def _sine_over_angle(t: float) -> float:
    return math.sin(math.sqrt(t)) / math.sqrt(t)


def _horner(values: tuple[float, ...]) -> str:
    *others, text = [f"JG_REAL({value!r})" for value in values]
    for value in reversed(others):
        text = f"{value} + t * ({text})"
    return text
