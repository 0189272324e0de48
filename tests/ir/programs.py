"""Random programs for hypothesis, and what tests read off a program.

The programs are built without `Builder`, so that they hold what lowering and passes may meet: duplicates, dead code,
operations on constants 0, 1 and -1, repeated operands, negated negatives, outputs that are inputs or constants.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any

from hypothesis import strategies as st

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.ops import ARITY, Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity

ARGUMENTS = (Argument("a", (3, 1)), Argument("B", (2, 2)))
RATIONALS = [Fraction(n) for n in (0, 0, 1, 1, -1, -1, 2, -2, 3)] + [Fraction(1, 2), Fraction(-3, 4), Fraction(1, 3)]
RATIONAL_OPS = (Op.NEGATE, Op.ADD, Op.SUBTRACT, Op.MULTIPLY)
OPS = (*RATIONAL_OPS, *RATIONAL_OPS, Op.DIVIDE, Op.SQRT, Op.SIN, Op.COS, Op.ATAN2)
LABELS = ("A_ij", "d_ij", "v")


@st.composite
def programs(
    draw: st.DrawFn, *, ops: Sequence[Op] = (*RATIONAL_OPS, Op.DIVIDE), pi: bool = False, size: int = 14
) -> Program:
    """A random program; `pi`: constants may hold powers of pi."""
    instructions: list[Instruction] = []
    sources = [(argument.name, k) for argument in ARGUMENTS for k in range(argument.length)]
    for _ in range(draw(st.integers(1, 4))):
        instructions.append(Instruction(Op.INPUT, source=draw(st.sampled_from(sources))))
    for _ in range(draw(st.integers(0, 3))):
        power = draw(st.sampled_from((0, 0, 1, 2, -1))) if pi else 0
        constant = Constant(draw(st.sampled_from(RATIONALS)), power)
        instructions.append(Instruction(Op.CONSTANT, constant=constant))
    for _ in range(draw(st.integers(0, size))):
        op = draw(st.sampled_from(list(ops)))
        position = st.integers(0, len(instructions) - 1)
        operands = tuple(draw(position) for _ in range(ARITY[op]))
        label = draw(st.one_of(st.none(), st.tuples(st.sampled_from(LABELS), st.integers(0, 3))))
        instructions.append(Instruction(op, operands, label=label))
    outputs = tuple(draw(_outputs(name, len(instructions))) for name in ("x", "Y")[: draw(st.integers(1, 2))])
    return Program(ARGUMENTS, tuple(instructions), outputs, (("v", "a + B"),))


@st.composite
def sparsities(draw: st.DrawFn, largest: int = 4) -> Sparsity:
    """A random pattern."""
    nrow, ncol = draw(st.integers(1, largest)), draw(st.integers(1, largest))
    entries = draw(st.sets(st.tuples(st.integers(0, nrow - 1), st.integers(0, ncol - 1))))
    return Sparsity.of_entries(nrow, ncol, entries)


@st.composite
def _outputs(draw: st.DrawFn, name: str, length: int) -> Output:
    """A vector (full) or a matrix (any pattern), of values anywhere in the program, most of them late."""
    pattern = draw(sparsities(3))
    if pattern.ncol == 1:
        pattern = Sparsity.of_entries(pattern.nrow, 1, [(row, 0) for row in range(pattern.nrow)])
    late = st.integers(max(0, length - 4), length - 1)
    values = draw(
        st.lists(
            st.one_of(late, st.integers(0, length - 1)),
            min_size=pattern.nonzeros,
            max_size=pattern.nonzeros,
        )
    )
    return Output(name, pattern, tuple(values))


def inputs_of(numbers: st.SearchStrategy[Any]) -> st.SearchStrategy[dict[str, list[Any]]]:
    """Values for the arguments of random programs."""
    lists = {a.name: st.lists(numbers, min_size=a.length, max_size=a.length) for a in ARGUMENTS}
    return st.fixed_dictionaries(lists)


def small_fractions() -> st.SearchStrategy[Fraction]:
    """Rationals among which zero, one, and equal and opposite values are frequent."""
    numbers = st.integers(-3, 3)
    return st.one_of(numbers.map(Fraction), st.builds(Fraction, numbers, st.integers(1, 5)))


def matrices(program: Program, inputs: Mapping[str, Any], domain: Domain) -> dict[tuple[str, int, int], Any]:
    """Every nonzero of every output by (name, row, column); what is not stored is left out."""
    values = evaluate(program, inputs, domain)
    return {
        (output.name, row, column): value
        for output in program.outputs
        for (row, column), value in zip(output.sparsity.entries(), values[output.name], strict=True)
    }


def bits(value: float) -> bytes:
    """The bits of a float, with one NaN and one zero for all: their signs depend on the order of operands."""
    number = float(value)
    return b"nan" if math.isnan(number) else struct.pack("<d", 0.0 if number == 0.0 else number)
