"""Preparing early values and taking them is the same, bit for bit, as computing them at every step."""

from __future__ import annotations

import random
import struct
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from codegen import build, models
from codegen.ir.evaluate import evaluate
from codegen.ir.ops import LEAVES, Op
from codegen.ir.program import Program
from codegen.mechanics.joints import JOINTS
from codegen.passes.drop_unused import drop_unused
from codegen.passes.split_geometry import Split, early_values, split_geometry
from codegen.spec.request import Variant
from codegen.spec.selection import library_variants
from flopcount.count import count
from tests.ir.programs import ARGUMENTS, FUSED_OPS, OPS, RANDOM, inputs_of, programs

from .test_rules import Expression, expressions_of, program_of

EARLY = ("B",)


def bits(values: Any) -> list[bytes]:
    """All bits of each number, NaNs alike."""
    return [b"nan" if x != x else struct.pack("<d", x) for x in values]


def outputs(program: Program, inputs: dict[str, Any]) -> dict[str, list[bytes]]:
    return {name: bits(values) for name, values in evaluate(program, inputs).items()}


def step_outputs(split: Split, inputs: dict[str, Any], early: tuple[str, ...]) -> list[dict[str, list[bytes]]]:
    prepared = evaluate(split.prepare, {name: inputs[name] for name in early})
    later = {name: values for name, values in inputs.items() if name not in early} | prepared
    return [outputs(step, later) for step in split.steps]


@RANDOM
@given(programs(ops=(*FUSED_OPS, Op.DIVIDE, Op.SIN)), programs(ops=FUSED_OPS), inputs_of(st.floats(-9, 9)))
def test_the_steps_have_the_bits_of_the_programs(first: Program, second: Program, inputs: dict[str, Any]) -> None:
    try:
        expected = [outputs(program, inputs) for program in (first, second)]
    except (ArithmeticError, ValueError):
        assume(False)
        return
    assert step_outputs(split_geometry([first, second], EARLY), inputs, EARLY) == expected


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_no_step_depends_on_an_early_argument_and_none_repeats_early_work(program: Program) -> None:
    split = split_geometry([program], EARLY)
    (step,) = split.steps
    assert {i.source[0] for i in step.instructions if i.source} <= {"a", "prepared"}
    assert {i.source[0] for i in split.prepare.instructions if i.source} <= set(EARLY)
    again = early_values(step, ("prepared",))
    for instruction, is_early in zip(step.instructions, again, strict=True):
        assert not is_early or instruction.op in (*LEAVES, Op.NEGATE)


@RANDOM
@given(programs(ops=OPS, pi=True), programs(ops=OPS, pi=True))
def test_what_is_prepared_is_needed_and_there_once(first: Program, second: Program) -> None:
    split = split_geometry([first, second], EARLY)
    stored = split.prepare.outputs[0].values
    assert len(set(stored)) == len(stored)
    assert all(split.prepare.instructions[value].op is not Op.NEGATE for value in stored)
    taken = {i.source[1] for step in split.steps for i in step.instructions if i.source and i.source[0] == "prepared"}
    assert taken == set(range(len(stored)))


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_steps_and_preparation_do_together_what_the_program_does(program: Program) -> None:
    program = drop_unused(program)
    split = split_geometry([program], EARLY)
    late = [not early for early in early_values(program, EARLY)]
    operations = sum(
        late[k] and i.op not in (*LEAVES, Op.NEGATE, Op.SINE_OF, Op.COSINE_OF)
        for k, i in enumerate(program.instructions)
    )
    assert count(split.steps[0]).roundings <= operations
    assert count(split.prepare).total + count(split.steps[0]).total <= count(program).total


@RANDOM
@given(programs(ops=OPS), st.sampled_from([(), ("a",), ("a", "B")]))
def test_any_arguments_may_be_the_early_ones(program: Program, early: tuple[str, ...]) -> None:
    split = split_geometry([program], early, "known")
    assert [a.name for a in split.prepare.arguments] == [a.name for a in ARGUMENTS if a.name in early]
    names = [a.name for a in split.steps[0].arguments]
    assert names == {(): ["a", "B"], ("a",): ["known", "B"], ("a", "B"): ["known"]}[early]


@pytest.mark.parametrize(
    ("expression", "left"),
    [
        (("add", "x", "y"), ("add", "x", "y")),
        (("neg", "x"), ("neg", "x")),
        (("mul", ("mul", "x", "x"), "x"), "x"),
        (("neg", ("mul", "x", 2)), ("neg", "x")),
        (("add", 1, 2), ("add", 1, 2)),
        (("sine_of", ("sincos", "x")), "x"),
    ],
    ids=str,
)
def test_a_step_is_left_with_what_is_free(expression: Expression, left: Expression) -> None:
    """All inputs are early: a step copies, changes signs and knows constants."""
    (step,) = split_geometry([program_of(expression)], ("v",)).steps
    if expression == ("add", "x", "y"):
        left = "x"
    assert expressions_of(step) == [left]


@pytest.mark.parametrize("joint", JOINTS)
def test_every_variant_of_the_library_keeps_its_bits(joint: str) -> None:
    draw = random.Random(joint)
    for variant in library_variants(JOINTS[joint]):
        routines = build.routines(variant)
        split = split_geometry([routine.program for routine in routines])
        inputs = {
            a.name: [draw.uniform(-2, 2) for _ in range(a.length)]
            for routine in routines
            for a in routine.program.used_arguments()
        }
        expected = [outputs(routine.program, inputs) for routine in routines]
        assert step_outputs(split, inputs, ("geometry",)) == expected, variant.stem
        for step in split.steps:
            assert "geometry" not in {argument.name for argument in step.arguments}


def test_the_translational_joint_takes_fifteen_operations_a_step() -> None:
    variant = Variant("translational", "parametric", "regular", "substituted")
    programs_ = [models.model(variant).program([name]) for name in ("phi_q", "phi_q_t_lambda_q")]
    assert sum(count(step).total for step in split_geometry(programs_).steps) == 15
    together = models.model(variant).program(("phi_q", "phi_q_t_lambda_q"))
    assert count(split_geometry([together]).steps[0]).total == 15
