"""A program means the same over every number type."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import Any

import flint
import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codegen.ir.evaluate import (
    arb_domain,
    evaluate,
    float_domain,
    fraction_domain,
    mpmath_domain,
    numpy_domain,
)
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity

from .programs import FUSED_OPS, OPS, RANDOM, RATIONAL_OPS, bits, inputs_of, matrices, programs, small_fractions

PRECISION = 200
ANGLES = (Op.SINCOS, Op.SIN, Op.COS, Op.ATAN2, Op.SQRT)


def arb(value: Fraction) -> Any:
    return flint.arb(value.numerator) / value.denominator


@pytest.fixture(autouse=True)
def precise() -> Any:
    """200 bits for the arbitrary precision types."""
    before = flint.ctx.prec, mpmath.mp.prec
    flint.ctx.prec = mpmath.mp.prec = PRECISION
    yield
    flint.ctx.prec, mpmath.mp.prec = before


def converted(inputs: dict[str, list[Fraction]], convert: Any) -> dict[str, list[Any]]:
    return {name: [convert(value) for value in values] for name, values in inputs.items()}


@RANDOM
@given(programs(ops=(*FUSED_OPS, Op.DIVIDE)), inputs_of(small_fractions()))
def test_balls_and_mpmath_hold_the_exact_rational_value(program: Program, inputs: dict[str, list[Fraction]]) -> None:
    try:
        exact = matrices(program, inputs, fraction_domain())
    except ZeroDivisionError:
        assume(False)
        return
    balls = matrices(program, converted(inputs, arb), arb_domain())
    numbers = matrices(program, converted(inputs, lambda x: mpmath.mpf(x.numerator) / x.denominator), mpmath_domain())
    for entry, value in exact.items():
        ball = balls[entry]
        assume(ball.is_finite())  # a divisor that is zero within rounding
        assert (ball * value.denominator - value.numerator).contains(0)
        rounded = mpmath.mpf(value.numerator) / value.denominator
        assert abs(numbers[entry] - rounded) <= mpmath.mpf(2) ** -140 * max(1, abs(rounded))


@RANDOM
@given(programs(ops=(*RATIONAL_OPS, *RATIONAL_OPS, Op.SIN, Op.COS, Op.ATAN2), pi=True), inputs_of(small_fractions()))
def test_balls_and_mpmath_agree_on_angles(program: Program, inputs: dict[str, list[Fraction]]) -> None:
    balls = matrices(program, converted(inputs, arb), arb_domain())
    numbers = matrices(program, converted(inputs, lambda x: mpmath.mpf(x.numerator) / x.denominator), mpmath_domain())
    for entry, ball in balls.items():
        assume(ball.is_finite() and ball.rad() < 1e-30 * (1 + abs(float(ball.mid()))))  # no branch cut within the ball
        middle = mpmath.mpf(ball.mid().str(60, radius=False))
        assert abs(numbers[entry] - middle) <= mpmath.mpf(2) ** -100 * max(1, abs(middle))


@RANDOM
@given(programs(ops=(*FUSED_OPS, Op.DIVIDE)), inputs_of(st.floats(-10, 10).filter(lambda x: x == 0 or abs(x) > 1e-3)))
def test_numpy_gives_the_bits_of_python_floats(program: Program, inputs: dict[str, list[float]]) -> None:
    try:
        floats = matrices(program, inputs, float_domain())
    except (ZeroDivisionError, OverflowError):
        assume(False)
        return
    with np.errstate(all="ignore"):
        arrays = matrices(program, {n: [np.array([x, x]) for x in v] for n, v in inputs.items()}, numpy_domain())
    for entry, value in floats.items():
        for lane in np.broadcast_to(arrays[entry], (2,)):
            assert bits(lane) == bits(value)


@RANDOM
@given(programs(ops=OPS, pi=True), inputs_of(st.floats(0.5, 2.0)))
def test_floats_and_numpy_agree_on_roots_and_angles(program: Program, inputs: dict[str, list[float]]) -> None:
    try:
        floats = matrices(program, inputs, float_domain())
    except (ArithmeticError, ValueError):
        assume(False)
        return
    balls = matrices(program, {n: [flint.arb(x) for x in v] for n, v in inputs.items()}, arb_domain())
    with np.errstate(all="ignore"):
        arrays = matrices(program, {n: [np.float64(x) for x in v] for n, v in inputs.items()}, numpy_domain())
    for entry, value in floats.items():
        if balls[entry].is_finite() and _is_stable(value, float(balls[entry].mid())):
            assert math.isclose(float(arrays[entry]), value, rel_tol=1e-6, abs_tol=1e-6)


def _is_stable(value: float, exact: float) -> bool:
    """Whether rounding has not been blown up by cancellation, a pole or a branch cut."""
    return math.isclose(value, exact, rel_tol=1e-9, abs_tol=1e-9)


def unary(op: Op) -> Program:
    pattern = Sparsity.of_entries(1, 1, [(0, 0)])
    operands = (0,) if op is not Op.ATAN2 else (0, 0)
    instructions = (Instruction(Op.INPUT, source=("x", 0)), Instruction(op, operands))
    return Program((Argument("x", (1, 1)),), instructions, (Output("y", pattern, (1,)),))


@pytest.mark.parametrize("op", ANGLES)
def test_rationals_refuse_roots_and_angles(op: Op) -> None:
    with pytest.raises(ArithmeticError, match="the program is not rational"):
        evaluate(unary(op), {"x": [Fraction(1)]}, fraction_domain())


def test_rationals_refuse_pi() -> None:
    pattern = Sparsity.of_entries(1, 1, [(0, 0)])
    pi = Instruction(Op.CONSTANT, constant=Constant(Fraction(2), 1))
    program = Program((), (pi,), (Output("y", pattern, (0,)),))
    with pytest.raises(ArithmeticError, match="pi is not rational"):
        evaluate(program, {}, fraction_domain())
    assert evaluate(program, {}) == {"y": [2 * math.pi]}


def test_a_missing_argument_is_a_key_error() -> None:
    with pytest.raises(KeyError, match="x"):
        evaluate(unary(Op.NEGATE), {})
