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

from hypothesis import HealthCheck, settings
from hypothesis import strategies as st

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.ops import ARITY, COMMUTATIVE, Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity

ARGUMENTS = (Argument("a", (3, 1)), Argument("B", (2, 2)))
RATIONALS = [Fraction(n) for n in (0, 0, 1, 1, -1, -1, 2, -2, 3)] + [Fraction(1, 2), Fraction(-3, 4), Fraction(1, 3)]
RATIONAL_OPS = (Op.NEGATE, Op.ADD, Op.SUBTRACT, Op.MULTIPLY, Op.ABS, Op.SELECT)
FUSED_OPS = (*RATIONAL_OPS, *RATIONAL_OPS, Op.FMA)
OPS = (*RATIONAL_OPS, *FUSED_OPS, Op.DIVIDE, Op.SQRT, Op.SIN, Op.COS, Op.ATAN2)
_STEP = 2 + max(ARITY.values())
"""Bytes that tell an instruction: drawn at once, since hypothesis takes longer to draw than passes to run."""
LABELS = (None, None, ("A_ij", 0), ("A_ij", 1), ("d_ij", 0), ("v", 0))

RANDOM = settings(
    deadline=None,
    derandomize=True,
    max_examples=200,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much],
)
"""How random tests run: the same examples every time, however loaded the machine is."""


@st.composite
def programs(
    draw: st.DrawFn, *, ops: Sequence[Op] = (*RATIONAL_OPS, Op.DIVIDE), pi: bool = False, size: int = 14
) -> Program:
    """A random program; `pi`: constants may hold powers of pi."""
    sources = [(argument.name, k) for argument in ARGUMENTS for k in range(argument.length)]
    powers = (0, 0, 1, 2, -1) if pi else (0,)
    constants = st.builds(Constant, st.sampled_from(RATIONALS), st.sampled_from(powers))
    instructions = [
        Instruction(Op.INPUT, source=source)
        for source in draw(st.lists(st.sampled_from(sources), min_size=1, max_size=4))
    ]
    instructions += [Instruction(Op.CONSTANT, constant=c) for c in draw(st.lists(constants, max_size=3))]
    for step in draw(st.lists(st.binary(min_size=_STEP, max_size=_STEP), max_size=size)):
        op, label, *places = step
        operands = tuple(place % len(instructions) for place in places[: ARITY[ops[op % len(ops)]]])
        instructions.append(Instruction(ops[op % len(ops)], operands, label=LABELS[label % len(LABELS)]))
    outputs = tuple(draw(_outputs(name, len(instructions))) for name in ("x", "Y")[: draw(st.integers(1, 2))])
    return Program(ARGUMENTS, tuple(instructions), outputs, (("v", "a + B"),))


@st.composite
def sparsities(draw: st.DrawFn, largest: int = 4) -> Sparsity:
    """A random pattern."""
    nrow, ncol = draw(st.integers(1, largest)), draw(st.integers(1, largest))
    marks = draw(st.integers(0, 2 ** (nrow * ncol) - 1))
    return Sparsity.of_entries(nrow, ncol, [divmod(k, ncol) for k in range(nrow * ncol) if marks >> k & 1])


@st.composite
def _outputs(draw: st.DrawFn, name: str, length: int) -> Output:
    """A vector (full) or a matrix (any pattern), of values anywhere in the program, most of them late."""
    pattern = draw(sparsities(3))
    if pattern.ncol == 1:
        pattern = Sparsity.of_entries(pattern.nrow, 1, [(row, 0) for row in range(pattern.nrow)])
    places = [*range(length), *range(max(0, length - 4), length)]
    chosen = draw(st.binary(min_size=pattern.nonzeros, max_size=pattern.nonzeros))
    return Output(name, pattern, tuple(places[byte % len(places)] for byte in chosen))


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


def tree(program: Program, known: dict[object, int]) -> list[tuple[str, tuple[int, ...]]]:
    """Each output as numbers of its values in `known`: equal for programs that differ in order and naming only."""
    numbers: list[int] = []
    for i in program.instructions:
        operands = [numbers[operand] for operand in i.operands]
        factors = sorted(operands[:2]) if i.op in COMMUTATIVE else operands[:2]
        key = (i.op, (*factors, *operands[2:]), i.constant, i.source)
        numbers.append(known.setdefault(key, len(known)))
    return [(output.name, tuple(numbers[value] for value in output.values)) for output in program.outputs]
