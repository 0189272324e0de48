"""The planar quick return of S2 (after Haug) from its closed-form geometry; q is the angle of the crank from x."""

from __future__ import annotations

from functools import cache

import numpy as np
import sympy
from scipy.optimize import brentq

from .one_freedom import Body, OneFreedom, about_z, plane, q

CRANK, PIVOT, ROCKER, LINE, COUPLER = sympy.Rational(3, 2), 2, 4, 4, 2
"""Lengths in m: crank, height of its pivot above the rocker's, rocker, height of the slide, coupler."""

DRIVE = 165_521.0
"""N m on the crank."""

CUT, CUTTING = 200_000.0, (-4.0, 1.2)
"""N towards +x on the slider while it moves in -x within the range, m."""

START = 0.44
"""rad, of the crank at t = 0."""


@cache
def quick_return(J: int = 2000, branch: int = -1) -> OneFreedom:
    """The mechanism.

    Args:
        J: kg m^2, of the crank about its axis.
        branch: -1 with the slider on the left of the rocker's tip, 1 on the right.
    """
    pin = sympy.Matrix([CRANK * sympy.cos(q), PIVOT + CRANK * sympy.sin(q), 0])
    span = sympy.sqrt(pin.dot(pin))
    along = pin / span
    tip = ROCKER * along
    reach = branch * sympy.sqrt(COUPLER**2 - (LINE - tip[1]) ** 2)
    slider = sympy.Matrix([tip[0] + reach, LINE, 0])
    rocker = _turn(along)
    bodies = {
        "crank": Body(1000, about_z(J), sympy.Matrix([0, PIVOT, 0]), plane(q)),
        "block": Body(5, about_z(sympy.Rational(1, 2)), pin, rocker),
        "rocker": Body(100, about_z(100), tip / 2, rocker),
        "coupler": Body(30, about_z(10), (tip + slider) / 2, _turn((slider - tip) / COUPLER)),
        "slider": Body(50, about_z(sympy.Rational(3, 2)), slider, sympy.eye(3)),
    }
    outputs = {"x": slider[0], "span": span, "tip x": tip[0], "tip y": tip[1], "reach": reach}
    return OneFreedom(bodies, (0, -sympy.Rational(981, 100), 0), outputs)


def _turn(along: sympy.Matrix) -> sympy.Matrix:
    """A turn about z that takes x to a unit vector of the plane."""
    c, s = along[0], along[1]
    return sympy.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def crossings() -> tuple[float, float]:
    """Angles of the crank between 0 and 2 pi at which cutting begins and ends, the slider moving in -x."""
    x = quick_return().outputs["x"]
    place = sympy.lambdify(q, x)
    (lower, upper), left_going = CUTTING, (-0.8, 3.9)  # between the ends of the stroke
    begins, ends = (float(brentq(lambda a, wall=wall: place(a) - wall, *left_going)) for wall in (upper, lower))
    return begins, ends


def cutting_work(first: float, last: np.ndarray) -> np.ndarray:
    """Work of the cutting force, J, from one angle of the crank on to others."""
    begins, ends = crossings()
    place = sympy.lambdify(q, quick_return().outputs["x"])

    def since_zero(angle: np.ndarray) -> np.ndarray:
        """From ``begins`` on: the stroke's whole work each turn, and what of it is done in this one."""
        turns, within = np.divmod(np.asarray(angle) - begins, 2 * np.pi)
        within = np.minimum(within, ends - begins)
        return np.asarray(-CUT * (turns * (place(begins) - place(ends)) + place(begins) - place(begins + within)))

    return np.asarray(since_zero(last) - since_zero(np.asarray(first)))
