"""Contraction keeps every value in exact arithmetic, leaves no product that a sum could take, and rounds less often."""

from __future__ import annotations

import random
from fractions import Fraction
from functools import cache
from typing import Any

import pytest
from hypothesis import assume, given

from codegen import models
from codegen.ir.evaluate import Domain, evaluate, fraction_domain
from codegen.ir.ops import Op
from codegen.ir.program import Program
from codegen.mechanics.joints import JOINTS
from codegen.passes.contract_fma import contract_fma
from codegen.passes.differentiate import differentiate
from codegen.passes.share_subexpressions import share_subexpressions
from codegen.spec.request import QUANTITIES, Variant
from codegen.spec.selection import library_variants
from flopcount.count import count
from flopcount.models import contractions
from tests.ir.programs import FUSED_OPS, RANDOM, inputs_of, matrices, programs, small_fractions

from .test_rules import Expression, expressions_of, operations, program_of


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        (("add", ("mul", "x", "y"), "z"), ("fma", "x", "y", "z")),
        (("add", "z", ("mul", "x", "y")), ("fma", "x", "y", "z")),
        (("sub", ("mul", "x", "y"), "z"), ("fma", "x", "y", ("neg", "z"))),
        (("sub", "z", ("mul", "x", "y")), ("fma", ("neg", "x"), "y", "z")),
        (("sub", "z", ("mul", "x", 2)), ("fma", -2, "x", "z")),
        (("sub", "z", ("mul", "x", ("neg", "y"))), ("fma", "y", "x", "z")),
        (("sub", ("mul", "x", "y"), ("neg", "z")), ("fma", "x", "y", "z")),
        (("sub", ("mul", "x", "y"), 3), ("fma", "x", "y", -3)),
        (("neg", ("add", ("mul", "x", "y"), "z")), ("fma", ("neg", "x"), "y", ("neg", "z"))),
        (("neg", ("sub", ("mul", "x", 2), "z")), ("fma", -2, "x", "z")),
        (
            ("neg", ("fma", ("fma", "x", "y", "z"), "y", "z")),
            ("fma", ("neg", "y"), ("fma", "x", "y", "z"), ("neg", "z")),
        ),
        (("mul", ("add", "x", "y"), "z"), ("mul", ("add", "x", "y"), "z")),
        (("div", ("mul", "x", "y"), "z"), ("div", ("mul", "x", "y"), "z")),
    ],
    ids=str,
)
def test_a_sum_takes_the_product_with_its_sign(expression: Expression, result: Expression) -> None:
    assert expressions_of(contract_fma(program_of(expression))) == [result]


@pytest.mark.parametrize("op", ["add", "sub"])
def test_of_two_products_the_one_that_is_ready_last_is_fused(op: str) -> None:
    late: Expression = ("mul", ("add", "x", "y"), "z")
    early: Expression = ("mul", "x", "y")
    for first, second in ((early, late), (late, early)):
        (result,) = expressions_of(contract_fma(program_of((op, first, second))))
        assert isinstance(result, tuple)
        assert result[0] == "fma"
        flat = str(result[1:3])
        assert "'add'" in flat, "the late factor is in the fused product"
        assert "'mul'" in str(result[3]), "the early product is rounded by itself"


def test_a_scalar_product_is_one_product_and_a_chain() -> None:
    products: list[Expression] = [("mul", "x", "y"), ("mul", "y", "z"), ("mul", "z", "x")]
    scalar_product = contract_fma(program_of(("add", ("add", products[0], products[1]), products[2])))
    assert expressions_of(scalar_product) == [("fma", "z", "x", ("fma", "y", "z", ("mul", "x", "y")))]


def test_a_product_that_is_used_twice_stays() -> None:
    shared = share_subexpressions(program_of(("add", ("mul", "x", "y"), "z"), ("add", ("mul", "x", "y"), "x")))
    assert operations(contract_fma(shared), Op.FMA) == 0
    output_too = share_subexpressions(program_of(("add", ("mul", "x", "y"), "z"), ("mul", "x", "y")))
    assert operations(contract_fma(output_too), Op.FMA) == 0


@RANDOM
@given(programs(ops=(*FUSED_OPS, Op.DIVIDE)), inputs_of(small_fractions()))
def test_values_are_the_same_in_rationals(program: Program, inputs: dict[str, list[Fraction]]) -> None:
    try:
        expected = matrices(program, inputs, fraction_domain())
    except ZeroDivisionError:
        assume(False)
        return
    assert matrices(contract_fma(program), inputs, fraction_domain()) == expected


@RANDOM
@given(programs(ops=FUSED_OPS))
def test_contraction_is_complete_and_happens_once(program: Program) -> None:
    contracted = contract_fma(program)
    assert contractions(contracted) == 0
    assert contract_fma(contracted) == contracted
    assert count(contracted).total <= count(program).total
    assert count(contracted).roundings <= count(program).roundings
    assert [(o.name, o.sparsity) for o in contracted.outputs] == [(o.name, o.sparsity) for o in program.outputs]


def stand_in(slope: int) -> Any:
    """A rational function in the place of a root or an angle: exact arithmetic does not ask what it means."""
    return lambda *x: slope * sum((k + 1) * value for k, value in enumerate(x)) + Fraction(1, slope)


RATIONAL = Domain(
    "rational stand-ins", lambda c: c.rational * Fraction(22, 7) ** c.pi_power, *(stand_in(k) for k in (2, 3, 5, 7))
)


@cache
def library_programs(joint: str) -> tuple[Program, ...]:
    symbolic = [models.model(variant) for variant in library_variants(JOINTS[joint])]
    return tuple(model.program(names) for model in symbolic for names in (*[[q] for q in QUANTITIES], QUANTITIES))


@pytest.mark.parametrize("joint", JOINTS)
def test_every_program_of_the_library_keeps_its_values_and_rounds_less(joint: str) -> None:
    draw = random.Random(joint)
    for program in library_programs(joint):
        contracted = contract_fma(program)
        inputs = {a.name: [Fraction(draw.randint(-9, 9), 8) for _ in range(a.length)] for a in program.arguments}
        assert evaluate(contracted, inputs, RATIONAL) == evaluate(program, inputs, RATIONAL)
        before, after = count(program), count(contracted)
        assert after.fma == contractions(program)
        assert after.total == before.total
        assert after.roundings == before.roundings - after.fma
        assert after.add + after.fma == before.add
        assert after.mul + after.fma == before.mul


def test_the_derivative_of_a_contracted_program_is_that_of_the_program() -> None:
    program = models.model(Variant("ball", "conventional", None)).program(["phi"])
    draw = random.Random(1)
    inputs = {a.name: [Fraction(draw.randint(-9, 9), 8) for _ in range(a.length)] for a in program.arguments}
    derivatives = [differentiate(p) for p in (program, contract_fma(program))]
    values = [matrices(derivative, inputs, fraction_domain()) for derivative in derivatives]
    assert values[0] == values[1] != {}
