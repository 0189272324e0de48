"""A program keeps its promises: operands precede uses, patterns fit values, text is a function of the program."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.ops import ARITY, Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity
from codegen.ir.text import dump

from .programs import OPS, RANDOM, programs, sparsities

X = Instruction(Op.INPUT, source=("x", 0))
SCALAR = Sparsity.of_entries(1, 1, [(0, 0)])


def program(*instructions: Instruction, value: int = 0, pattern: Sparsity = SCALAR) -> Program:
    return Program((Argument("x", (1, 1)),), instructions, (Output("y", pattern, (value,)),))


@pytest.mark.parametrize("operand", [1, 2, 7, -1])
def test_a_value_is_not_used_before_it_is_computed(operand: int) -> None:
    with pytest.raises(InternalError, match="instruction 1 uses a value that is not computed before it"):
        program(X, Instruction(Op.NEGATE, (operand,)))


@pytest.mark.parametrize("op", list(Op))
def test_an_operation_takes_as_many_operands_as_its_arity_says(op: Op) -> None:
    assert program(X, Instruction(op, (0,) * ARITY[op])).instructions[1].op is op
    for wrong in {0, 1, 2, 3} - {ARITY[op]}:
        with pytest.raises(InternalError, match=f"instruction 1: {op.value}"):
            program(X, Instruction(op, (0,) * wrong))


def test_an_output_has_a_value_for_each_nonzero_of_its_pattern() -> None:
    with pytest.raises(InternalError, match="output y: 1 values for its pattern"):
        program(X, pattern=Sparsity.of_entries(2, 1, [(0, 0), (1, 0)]))


def test_an_output_is_found_by_its_name() -> None:
    assert program(X).output("y").values == (0,)
    with pytest.raises(KeyError):
        program(X).output("z")


@RANDOM
@given(sparsities())
def test_a_pattern_is_the_set_of_its_entries(pattern: Sparsity) -> None:
    entries = pattern.entries()
    assert Sparsity.of_entries(pattern.nrow, pattern.ncol, reversed(entries)) == pattern
    assert len(set(entries)) == len(entries) == pattern.nonzeros == pattern.colind[-1]
    assert entries == sorted(entries, key=lambda entry: (entry[1], entry[0]))
    assert all(0 <= row < pattern.nrow and 0 <= column < pattern.ncol for row, column in entries)


@RANDOM
@given(st.integers(1, 5), st.integers(1, 5))
def test_a_full_pattern_is_column_major(nrow: int, ncol: int) -> None:
    pattern = Sparsity.of_entries(nrow, ncol, [(r, c) for r in range(nrow) for c in range(ncol)])
    assert pattern.colind == tuple(range(0, nrow * ncol + 1, nrow))
    assert pattern.row == tuple(range(nrow)) * ncol


@RANDOM
@given(programs(ops=OPS, pi=True))
def test_equal_programs_have_equal_text(program: Program) -> None:
    copy = Program(tuple(program.arguments), tuple(program.instructions), tuple(program.outputs), tuple(program.legend))
    assert copy == program
    assert dump(copy) == dump(program)


@RANDOM
@given(programs(ops=OPS, pi=True), st.data())
def test_a_change_of_the_program_shows_in_the_text(program: Program, data: st.DataObject) -> None:
    position = data.draw(st.integers(0, len(program.instructions) - 1))
    instruction = program.instructions[position]
    others = [op for op in Op if ARITY[op] == ARITY[instruction.op] and op is not instruction.op]
    if instruction.operands and not others:
        changed = Instruction(Op.ADD, instruction.operands[:2])
    elif instruction.operands:
        changed = instruction._replace(op=data.draw(st.sampled_from(others)))
    elif instruction.constant is not None:
        changed = instruction._replace(constant=Constant(instruction.constant.rational + 1, 1))
    else:
        changed = instruction._replace(source=("a", 17))
    instructions = (*program.instructions[:position], changed, *program.instructions[position + 1 :])
    assert dump(replace(program, instructions=instructions)) != dump(program)


def test_the_text_names_every_instruction_and_output() -> None:
    builder = Builder()
    x = builder.input("x", 0)
    half = builder.constant(Constant(Fraction(1, 2), 1))
    product = builder.emit(Op.MULTIPLY, x, half)
    builder.label(product, ("v", 2))
    frozen = builder.freeze((Argument("x", (1, 1)),), (Output("y", SCALAR, (product,)),))
    assert dump(frozen) == (
        "argument x 1x1\n%0 = x[0]\n%1 = constant 1/2 pi\n%2 = mul %0 %1  ; v[2]\noutput y 1x1\n  [0,0] = %2\n"
    )


def test_the_builder_keeps_equal_operations_once_and_no_label_on_leaves() -> None:
    builder = Builder()
    x, y = builder.input("x", 0), builder.input("x", 1)
    builder.label(x, ("v", 0))
    assert builder.input("x", 0) == x
    assert builder.emit(Op.ADD, x, y) == builder.emit(Op.ADD, y, x)
    assert builder.emit(Op.SUBTRACT, x, y) != builder.emit(Op.SUBTRACT, y, x)
    assert builder.constant(1) == builder.constant(Fraction(1))
    assert builder.instructions[x].label is None


@RANDOM
@given(programs(ops=OPS))
def test_the_live_instructions_are_those_an_output_is_reached_from(program: Program) -> None:
    reached: set[int] = set()
    waiting = [value for output in program.outputs for value in output.values]
    while waiting:
        position = waiting.pop()
        if position not in reached:
            reached.add(position)
            waiting += program.instructions[position].operands
    assert [k for k, alive in enumerate(program.live()) if alive] == sorted(reached)
    names = {i.source[0] for k, i in enumerate(program.instructions) if k in reached and i.source is not None}
    assert {argument.name for argument in program.used_arguments()} == names
