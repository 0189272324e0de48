"""Numbers that remember the floating-point operations they come from.

Two values with one form are the same to the last bit: sums and products commute, a sign may be moved through them, and
zero, one and constants whose result is a double take no rounding.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from codegen.ir.evaluate import Domain
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant

_forms: dict[tuple[Any, ...], Form]


class Form:
    """An expression in inputs and constants; equal ones are one object."""

    __slots__ = ("key", "number")

    def __init__(self, key: tuple[Any, ...], number: int) -> None:
        self.key = key
        self.number = number

    def __neg__(self) -> Form:
        if self.key[0] == "constant":
            return constant(-self.key[1])
        return self.key[1] if self.key[0] == "minus" else form("minus", self)

    def __add__(self, other: Any) -> Form:
        other = known(other)
        if ZERO in (self, other):
            return self if other is ZERO else other
        folded = _folded(self, other, lambda a, b: a + b)
        if folded is not None:
            return folded
        if self.key[0] == other.key[0] == "minus":
            return -(self.key[1] + other.key[1])
        return form("sum", *sorted((self, other), key=lambda part: part.number))

    def __mul__(self, other: Any) -> Form:
        other = known(other)
        if ZERO in (self, other):
            return ZERO
        for one, rest in ((self, other), (other, self)):
            if one is ONE:
                return rest
            if one.key[0] == "minus":
                return -(one.key[1] * rest)
            if one.key[0] == "constant" and one.key[1] < 0:
                return -(-one * rest)
        folded = _folded(self, other, lambda a, b: a * b)
        return folded or form("product", *sorted((self, other), key=lambda part: part.number))

    def __truediv__(self, other: Form) -> Form:
        return form("quotient", self, other)

    def __sub__(self, other: Any) -> Form:
        return self + -known(other)

    __radd__ = __add__
    __rmul__ = __mul__


_forms = {}


def form(*key: Any) -> Form:
    """The expression of an operation and its operands."""
    return _forms.setdefault(key, Form(key, len(_forms)))


def constant(value: Fraction) -> Form:
    """A number that is a double."""
    return form("constant", value)


def rounded(value: Any) -> Form:
    """The double nearest to a number."""
    return constant(Fraction(float(value)))


def known(value: Any) -> Form:
    """An operand."""
    return value if isinstance(value, Form) else rounded(value)


def _folded(a: Form, b: Form, operation: Any) -> Form | None:
    if a.key[0] != "constant" or b.key[0] != "constant":
        return None
    value = operation(a.key[1], b.key[1])
    return constant(value) if Fraction(float(value)) == value else None


def _constant_of(value: Constant) -> Form:
    return rounded(nearest_double(value))


ZERO, ONE = constant(Fraction(0)), constant(Fraction(1))

FORMS = Domain(
    "forms",
    _constant_of,
    lambda x: form("sqrt", x),
    lambda x: form("sin", x),
    lambda x: form("cos", x),
    lambda y, x: form("atan2", y, x),
)
"""What a program computes, as forms."""
