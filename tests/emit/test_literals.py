"""Literals round-trip: the compiler reads the double that is nearest to the exact constant."""

from __future__ import annotations

import math
import re
from fractions import Fraction

import flint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.emit.literals import literal
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant
from tests.ir.programs import RANDOM

RATIONALS = st.fractions(min_value=-(10**6), max_value=10**6, max_denominator=10**9)


@RANDOM
@given(RATIONALS, st.integers(-3, 3))
def test_a_literal_is_the_nearest_double(rational: Fraction, power: int) -> None:
    text = literal(Constant(rational, power))
    match = re.fullmatch(r"JG_REAL\((-?\d+(?:\.\d+)?(?:e[-+]\d+)?)\)", text)
    assert match is not None, text
    number = float(match[1])
    before = flint.ctx.prec
    flint.ctx.prec = 300
    try:
        exact = flint.arb(rational.numerator) / rational.denominator * flint.arb.pi() ** power
        error = abs(exact - flint.arb(number))
        for neighbour in (math.nextafter(number, math.inf), math.nextafter(number, -math.inf)):
            assert not error > abs(exact - flint.arb(neighbour))
    finally:
        flint.ctx.prec = before


@RANDOM
@given(st.floats(allow_nan=False, allow_infinity=False))
def test_every_double_is_kept(number: float) -> None:
    constant = Constant(Fraction(number))
    assert nearest_double(constant) == number
    assert float(literal(constant).removeprefix("JG_REAL(").removesuffix(")")) == number


@pytest.mark.parametrize("power", [1, 2, -1])
def test_pi_is_pi(power: int) -> None:
    assert math.isclose(nearest_double(Constant(Fraction(1), power)), math.pi**power, rel_tol=1e-15)
    assert nearest_double(Constant(Fraction(1), 1)) == math.pi


def test_a_literal_is_a_floating_constant_in_both_number_types() -> None:
    """``1`` would be an integer, and ``1f`` no constant at all."""
    for number in (0, 1, -1, 10**6, 10**20, Fraction(1, 3), Fraction(1, 10**30)):
        digits = literal(Constant(Fraction(number))).removeprefix("JG_REAL(").removesuffix(")")
        assert "." in digits or "e" in digits
