"""The derivative of a program is the derivative of its outputs, entry by entry: exact in rationals, by dual numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codegen.ir.evaluate import Domain, evaluate, float_domain, fraction_domain
from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.passes.differentiate import differentiate
from tests.ir.programs import ARGUMENTS, FUSED_OPS, RANDOM, RATIONAL_OPS, inputs_of, matrices, programs, small_fractions

from .test_rules import Expression, program_of


@dataclass(frozen=True)
class Dual:
    """A value and its derivative."""

    value: Any
    slope: Any = 0

    def __neg__(self) -> Dual:
        return Dual(-self.value, -self.slope)

    def __add__(self, other: Dual) -> Dual:
        return Dual(self.value + other.value, self.slope + other.slope)

    def __sub__(self, other: Dual) -> Dual:
        return self + -other

    def __mul__(self, other: Dual) -> Dual:
        return Dual(self.value * other.value, self.value * other.slope + self.slope * other.value)

    def __truediv__(self, other: Dual) -> Dual:
        quotient = self.value / other.value
        return Dual(quotient, (self.slope - quotient * other.slope) / other.value)

    def __abs__(self) -> Dual:
        return -self if self.value < 0 else self

    def __lt__(self, other: Dual) -> bool:
        return bool(self.value < other.value)


def refused(*_: Dual) -> Dual:
    raise ArithmeticError("the program is not rational")


DUAL = Domain("dual", lambda c: Dual(Fraction(c.rational)), refused, refused, refused, refused)


@RANDOM
@given(programs(ops=(*FUSED_OPS, Op.DIVIDE), size=8), inputs_of(small_fractions()))
def test_derivatives_of_rational_programs_are_exact(program: Program, inputs: dict[str, list[Fraction]]) -> None:
    derivative = differentiate(program)
    lengths = {output.name: output.sparsity.nrow for output in program.outputs}
    try:
        found = matrices(derivative, inputs, fraction_domain())
        assert matrices(simplify(derivative), inputs, fraction_domain()).items() <= found.items()
        for argument in ARGUMENTS:
            for k in range(argument.length):
                duals = {
                    name: [
                        Dual(value, Fraction(int((name, i) == (argument.name, k)))) for i, value in enumerate(values)
                    ]
                    for name, values in inputs.items()
                }
                for (name, row, column), dual in matrices(program, duals, DUAL).items():
                    place = (f"jac_{name}_{argument.name}", column * lengths[name] + row, k)
                    assert found.get(place, 0) == dual.slope
    except ZeroDivisionError:
        assume(False)


@pytest.mark.parametrize(
    ("expression", "slopes"),
    [
        (("sqrt", "x"), lambda x, y: (0.5 / math.sqrt(x), 0.0)),
        (("sin", ("mul", "x", "y")), lambda x, y: (y * math.cos(x * y), x * math.cos(x * y))),
        (("cos", "x"), lambda x, y: (-math.sin(x), 0.0)),
        (("sine_of", ("sincos", "x")), lambda x, y: (math.cos(x), 0.0)),
        (("cosine_of", ("sincos", "x")), lambda x, y: (-math.sin(x), 0.0)),
        (("atan2", "x", "y"), lambda x, y: (y / (x * x + y * y), -x / (x * x + y * y))),
    ],
    ids=lambda value: value[0] if isinstance(value, tuple) else "",
)
@RANDOM
@given(x=st.floats(0.1, 3), y=st.floats(0.1, 3))
def test_derivatives_of_roots_and_angles(expression: Expression, slopes: Any, x: float, y: float) -> None:
    program = differentiate(program_of(expression))
    found = matrices(program, {"v": [x, y, 0.0]}, float_domain())
    for k, slope in enumerate(slopes(x, y)):
        assert math.isclose(found.get(("jac_out_v", 0, k), 0.0), slope, rel_tol=1e-14, abs_tol=1e-15)


@RANDOM
@given(programs(ops=RATIONAL_OPS))
def test_what_an_output_does_not_depend_on_is_a_structural_zero(program: Program) -> None:
    for output in program.outputs:
        alone = replace(program, outputs=(output,))
        used = {i.source for i, alive in zip(alone.instructions, alone.live(), strict=True) if alive and i.source}
        for block in differentiate(alone).outputs:
            argument = block.name.removeprefix(f"jac_{output.name}_")
            assert {(argument, column) for _, column in block.sparsity.entries()} <= used
    assert set(evaluate(differentiate(program), {"a": [1] * 3, "B": [1] * 4}, fraction_domain())) == {
        f"jac_{output.name}_{argument.name}" for output in program.outputs for argument in program.used_arguments()
    }
