"""Number types of the reference: float, complex, `flint.arb`, `Jet`, and functions that work for all of them.

A `Jet` carries a value together with its derivatives along two *independent* families of infinitesimals,
`outer` e_k and `inner` d_l (e_k e_m = 0, d_l d_n = 0): x = value + sum outer[k] e_k + sum inner[l] d_l + sum
cross[k, l] e_k d_l.  Products are exact, so one evaluation of a function of a pose gives all its second
derivatives, in whatever order of rotations the caller composed the two families (virtual rotations do not
commute).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Scalar = Any  # float, complex, flint.arb or Jet
Array = NDArray[Any]


class Jet:
    """value (scalar), outer [n1], inner [n2], cross [n1, n2]; components are float or flint.arb."""

    __slots__ = ("cross", "inner", "outer", "value")

    def __init__(self, value: Scalar, outer: Array, inner: Array, cross: Array) -> None:
        self.value = value
        self.outer = outer
        self.inner = inner
        self.cross = cross

    def chain(self, f: Scalar, f_1: Scalar, f_2: Scalar) -> Jet:
        """f(self) from the value, the first and the second derivative of f at `self.value`."""
        cross = self.cross * f_1 + np.multiply.outer(self.outer, self.inner) * f_2
        return Jet(f, self.outer * f_1, self.inner * f_1, cross)

    def __add__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented
        if isinstance(other, Jet):
            return Jet(
                self.value + other.value,
                self.outer + other.outer,
                self.inner + other.inner,
                self.cross + other.cross,
            )
        return Jet(self.value + other, self.outer, self.inner, self.cross)

    def __mul__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented
        if isinstance(other, Jet):
            cross = self.cross * other.value + other.cross * self.value
            cross = cross + np.multiply.outer(self.outer, other.inner)
            cross = cross + np.multiply.outer(other.outer, self.inner)
            return Jet(
                self.value * other.value,
                self.outer * other.value + other.outer * self.value,
                self.inner * other.value + other.inner * self.value,
                cross,
            )
        return Jet(self.value * other, self.outer * other, self.inner * other, self.cross * other)

    def __neg__(self) -> Jet:
        return self * (-1)

    def __sub__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Jet:
        return (-self).__add__(other)

    def __truediv__(self, other: Any) -> Jet:
        if isinstance(other, np.ndarray):
            return NotImplemented
        if isinstance(other, Jet):
            v = other.value
            return self * other.chain(1 / v, -1 / (v * v), 2 / (v * v * v))
        return Jet(self.value / other, self.outer / other, self.inner / other, self.cross / other)

    __radd__ = __add__
    __rmul__ = __mul__

    def __repr__(self) -> str:
        return f"Jet({self.value!r}; {self.outer.size} outer, {self.inner.size} inner)"


def sin(x: Scalar) -> Scalar:
    """Sine of a float, complex, arb or Jet, radians."""
    if isinstance(x, Jet):
        return x.chain(sin(x.value), cos(x.value), -sin(x.value))
    return x.sin() if hasattr(x, "sin") else np.sin(x)


def cos(x: Scalar) -> Scalar:
    """Cosine of a float, complex, arb or Jet, radians."""
    if isinstance(x, Jet):
        return x.chain(cos(x.value), -sin(x.value), -cos(x.value))
    return x.cos() if hasattr(x, "cos") else np.cos(x)


def base(x: Scalar) -> Scalar:
    """Value without infinitesimal part: of a Jet its value, of a complex number its real part."""
    if isinstance(x, Jet):
        return x.value
    return float(x.real) if isinstance(x, (complex, np.complexfloating)) else x


def atan2(y: Scalar, x: Scalar) -> Scalar:
    """Angle of (x, y) in (-pi, pi], radians.  For complex and Jet: base angle + w/u in axes turned to it.

    With w = 0 at the base point atan(w/u) = w/u - (w/u)^3/3 + ..., so w/u alone is right to second order in
    all infinitesimals together, which is all that complex steps (first order) and Jets (second order) hold.
    """
    y_0, x_0 = base(y), base(x)
    angle = math.atan2(y_0, x_0) if isinstance(y_0, (float, int)) else type(y_0).atan2(y_0, x_0)
    if not isinstance(y, (Jet, complex, np.complexfloating)):
        return angle
    return (y * x_0 - x * y_0) / (x * x_0 + y * y_0) + angle


def cast(array: Any, like: Scalar) -> Array:
    """Array with every entry converted to the number type of `like`; float stays a plain float array."""
    array = np.asarray(array)
    if isinstance(like, (float, int)):
        return np.asarray(array, dtype=float)
    out = np.empty(array.shape, dtype=object)
    for index in np.ndindex(array.shape):
        out[index] = type(like)(array[index])
    return out


def to_float(array: Any) -> NDArray[np.float64]:
    """Array of floats nearest to the entries (float, arb)."""
    array = np.asarray(array)
    return np.array([float(x) for x in array.ravel()]).reshape(array.shape)
