"""What each pass does to the smallest programs it is for, written as expressions."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import pytest

from codegen.ir.builder import Builder
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity
from codegen.passes import simplify
from codegen.passes.absorb_negations import absorb_negations
from codegen.passes.drop_unused import drop_unused
from codegen.passes.eliminate_zeros import compress, eliminate_zeros
from codegen.passes.fold_constants import fold_constants
from codegen.passes.pair_sincos import pair_sincos
from codegen.passes.schedule import schedule
from codegen.passes.share_subexpressions import share_subexpressions

Expression = tuple[object, ...] | str | int | Fraction | Constant
"""``("add", "x", 0)``: the name of an operation and its operands; letters are inputs."""

LETTERS = "xyz"


def program_of(*expressions: Expression) -> Program:
    """A vector of expressions, nothing shared between them but the inputs."""
    instructions = [Instruction(Op.INPUT, source=("v", k)) for k in range(len(LETTERS))]

    def place(expression: Expression) -> int:
        if isinstance(expression, str):
            return LETTERS.index(expression)
        if isinstance(expression, tuple):
            operands = tuple(place(operand) for operand in expression[1:])  # type: ignore[arg-type]
            instructions.append(Instruction(Op(expression[0]), operands))
        else:
            constant = expression if isinstance(expression, Constant) else Constant(Fraction(expression))
            instructions.append(Instruction(Op.CONSTANT, constant=constant))
        return len(instructions) - 1

    values = tuple(place(expression) for expression in expressions)
    pattern = Sparsity.of_entries(len(values), 1, [(row, 0) for row in range(len(values))])
    return Program((Argument("v", (3, 1)),), tuple(instructions), (Output("out", pattern, values),))


def expressions_of(program: Program) -> list[Expression]:
    """The outputs of a program as expressions; the inverse of `program_of`."""

    def read(position: int) -> Expression:
        instruction = program.instructions[position]
        if instruction.source is not None:
            return LETTERS[instruction.source[1]]
        if instruction.constant is not None:
            constant = instruction.constant
            return constant if constant.pi_power else constant.rational
        return (instruction.op.value, *(read(operand) for operand in instruction.operands))

    return [read(value) for output in program.outputs for value in output.values]


def operations(program: Program, op: Op) -> int:
    return sum(instruction.op is op for instruction in program.instructions)


PI = Constant(Fraction(1), 1)


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        (("add", "x", 0), "x"),
        (("add", 0, "x"), "x"),
        (("sub", "x", 0), "x"),
        (("sub", 0, "x"), ("neg", "x")),
        (("sub", "x", "x"), 0),
        (("mul", "x", 0), 0),
        (("mul", 0, "x"), 0),
        (("mul", 1, "x"), "x"),
        (("mul", "x", -1), ("neg", "x")),
        (("div", 0, "x"), 0),
        (("div", "x", 1), "x"),
        (("neg", 0), 0),
        (("fma", "x", 0, "y"), "y"),
        (("fma", 1, "x", "y"), ("add", "x", "y")),
        (("fma", "x", -1, "y"), ("sub", "y", "x")),
        (("fma", "x", "y", 0), ("mul", "x", "y")),
        (("fma", "x", 1, 0), "x"),
        (("fma", "x", -1, "x"), 0),
        (("add", "x", "y"), ("add", "x", "y")),
        (("mul", "x", ("sub", ("add", "y", 0), "y")), 0),
    ],
    ids=str,
)
def test_arithmetic_with_zero_and_one_disappears(expression: Expression, result: Expression) -> None:
    assert expressions_of(eliminate_zeros(program_of(expression))) == [result]


@pytest.mark.parametrize(
    ("expression", "result"),
    [
        (("add", 2, 3), 5),
        (("sub", 1, Fraction(1, 3)), Fraction(2, 3)),
        (("mul", PI, ("mul", 2, PI)), Constant(Fraction(2), 2)),
        (("div", 1, PI), Constant(Fraction(1), -1)),
        (("div", PI, PI), 1),
        (("add", PI, PI), Constant(Fraction(2), 1)),
        (("add", PI, 1), ("add", PI, Fraction(1))),
        (("div", 1, 0), ("div", Fraction(1), Fraction(0))),
        (("neg", ("mul", 2, 3)), -6),
        (("fma", 2, 3, -6), 0),
        (("fma", 2, PI, PI), Constant(Fraction(3), 1)),
        (("fma", 2, PI, 1), ("fma", Fraction(2), PI, Fraction(1))),
        (("sin", 0), 0),
        (("cos", 0), 1),
        (("sqrt", 4), ("sqrt", Fraction(4))),
    ],
    ids=str,
)
def test_constants_are_folded_exactly_or_not_at_all(expression: Expression, result: Expression) -> None:
    assert expressions_of(fold_constants(program_of(expression))) == [result]


def test_zero_times_pi_is_zero() -> None:
    assert expressions_of(simplify(program_of(("add", "x", ("mul", 0, PI))))) == ["x"]
    assert expressions_of(simplify(program_of(("add", "x", ("sub", PI, PI))))) == ["x"]


@pytest.mark.parametrize(
    ("expressions", "op", "number"),
    [
        ((("mul", "x", "y"), ("mul", "y", "x"), ("mul", ("neg", "x"), "y")), Op.MULTIPLY, 1),
        ((("div", "x", "y"), ("neg", ("div", "x", ("neg", "y")))), Op.DIVIDE, 1),
        ((("sub", "x", "y"), ("sub", "y", "x"), ("add", "x", ("neg", "y"))), Op.SUBTRACT, 1),
        ((("add", "x", "y"), ("sub", ("neg", "y"), "x")), Op.ADD, 1),
        ((("sin", "x"), ("sin", ("neg", "x"))), Op.SIN, 1),
        ((("cos", "x"), ("cos", ("neg", "x"))), Op.COS, 1),
        ((("mul", 3, "x"), ("mul", -3, "x")), Op.MULTIPLY, 1),
        ((("fma", "x", "y", "z"), ("fma", ("neg", "y"), ("neg", "x"), "z")), Op.FMA, 1),
        ((("fma", "x", "y", ("neg", "z")), ("fma", "y", ("neg", "x"), "z")), Op.FMA, 1),
        ((("fma", "x", "y", "z"), ("fma", "x", "z", "y")), Op.FMA, 2),
        ((("div", "x", "y"), ("div", "y", "x")), Op.DIVIDE, 2),
        ((("atan2", "x", "y"), ("atan2", "y", "x"), ("atan2", "x", "y")), Op.ATAN2, 2),
    ],
    ids=str,
)
def test_equal_values_are_computed_once_up_to_sign(expressions: tuple[Expression, ...], op: Op, number: int) -> None:
    assert operations(share_subexpressions(program_of(*expressions)), op) == number


def test_the_negative_of_a_difference_is_the_difference_the_other_way_round() -> None:
    assert expressions_of(absorb_negations(program_of(("neg", ("sub", "x", "y"))))) == [("sub", "y", "x")]
    builder = Builder()
    x, y = builder.input("v", 0), builder.input("v", 1)
    difference = builder.emit(Op.SUBTRACT, x, y)
    values = (difference, builder.emit(Op.NEGATE, difference))
    pattern = Sparsity.of_entries(2, 1, [(0, 0), (1, 0)])
    used_twice = builder.freeze((Argument("v", (3, 1)),), (Output("out", pattern, values),))
    assert absorb_negations(used_twice) == used_twice


def test_sine_and_cosine_of_one_angle_become_a_pair() -> None:
    pair = pair_sincos(program_of(("sin", "x"), ("cos", "x"), ("sin", "y")))
    assert expressions_of(pair) == [("sine_of", ("sincos", "x")), ("cosine_of", ("sincos", "x")), ("sin", "y")]
    assert operations(pair, Op.SINCOS) == 1


def test_a_matrix_keeps_its_structural_nonzeros_and_a_vector_all_its_entries() -> None:
    vector = program_of("x", 0)
    assert compress(vector) == vector
    full = Sparsity.of_entries(1, 2, [(0, 0), (0, 1)])
    matrix = Program(vector.arguments, vector.instructions, (Output("out", full, vector.outputs[0].values),))
    assert compress(matrix).outputs == (Output("out", Sparsity.of_entries(1, 2, [(0, 0)]), (0,)),)


def test_only_what_an_output_needs_is_kept() -> None:
    program = program_of(("mul", "x", "z"))
    assert [i.source for i in drop_unused(program).instructions if i.source] == [("v", 0), ("v", 2)]


def test_the_order_is_depth_first_with_the_heavier_operand_first() -> None:
    heavy: Expression = ("mul", ("add", "x", "y"), ("add", "y", "z"))
    ordered = schedule(program_of(("sub", ("neg", "x"), heavy), ("neg", "z")))
    assert [i.op.value for i in ordered.instructions if i.operands] == ["add", "add", "mul", "neg", "sub", "neg"]


def test_simplify_goes_on_until_nothing_is_left_to_do() -> None:
    x, minus_one = Instruction(Op.INPUT, source=("v", 0)), Instruction(Op.CONSTANT, constant=Constant(Fraction(-1)))
    negative, quotient = Instruction(Op.NEGATE, (0,)), Instruction(Op.DIVIDE, (2, 1))
    pattern = Sparsity.of_entries(3, 1, [(0, 0), (1, 0), (2, 0)])
    outputs = (Output("out", pattern, (1, 2, 3)),)
    program = Program((Argument("v", (3, 1)),), (x, minus_one, negative, quotient, negative), outputs)
    assert expressions_of(simplify(program)) == [-1, ("neg", "x"), "x"]


@pytest.mark.parametrize("apply", [simplify, schedule, drop_unused])
def test_nothing_is_computed_in_vain(apply: Callable[[Program], Program]) -> None:
    simplified = apply(program_of(("mul", "x", 2), ("add", "x", "z")))
    assert all(simplified.live())
