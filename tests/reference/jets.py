"""Values with their first and second derivative, carried through arithmetic: exact derivatives without expressions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Jet:
    """A function of one variable at a place.

    Attributes:
        f: value.
        d: first derivative.
        dd: second derivative.
    """

    f: float
    d: float = 0.0
    dd: float = 0.0

    def __add__(self, other: Any) -> Jet:
        o = jet(other)
        return Jet(self.f + o.f, self.d + o.d, self.dd + o.dd)

    def __mul__(self, other: Any) -> Jet:
        o = jet(other)
        return Jet(self.f * o.f, self.d * o.f + self.f * o.d, self.dd * o.f + 2 * self.d * o.d + self.f * o.dd)

    def __pow__(self, p: float) -> Jet:
        return self.through(self.f**p, p * self.f ** (p - 1) if p else 0.0, p * (p - 1) * self.f ** (p - 2))

    def __neg__(self) -> Jet:
        return self * -1.0

    def __sub__(self, other: Any) -> Jet:
        return self + -jet(other)

    def __rsub__(self, other: Any) -> Jet:
        return self.__neg__().__add__(other)

    def __truediv__(self, other: Any) -> Jet:
        return self.__mul__(jet(other).__pow__(-1))

    def __rtruediv__(self, other: Any) -> Jet:
        return self.__pow__(-1).__mul__(other)

    __radd__ = __add__
    __rmul__ = __mul__

    def through(self, g: float, dg: float, ddg: float) -> Jet:
        """A function of this one, by its derivatives here."""
        return Jet(g, dg * self.d, ddg * self.d**2 + dg * self.dd)


def jet(value: Any) -> Jet:
    """A constant as a jet."""
    return value if isinstance(value, Jet) else Jet(float(value))


def sin(x: Any) -> Jet:
    return jet(x).through(np.sin(jet(x).f), np.cos(jet(x).f), -np.sin(jet(x).f))


def cos(x: Any) -> Jet:
    return jet(x).through(np.cos(jet(x).f), -np.sin(jet(x).f), -np.cos(jet(x).f))


def sqrt(x: Any) -> Jet:
    return jet(x).__pow__(0.5)


FUNCTIONS = {"sin": sin, "cos": cos, "sqrt": sqrt}
"""For sympy.lambdify."""
