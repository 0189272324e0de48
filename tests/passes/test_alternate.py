"""In the order for several units additions and multiplications alternate, and roots come as early as they can."""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import LEAVES, Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.alternate import alternate

_COUNT = 6


def test_additions_and_multiplications_that_wait_for_nothing_alternate() -> None:
    ops = _ops(alternate(_grouped([Op.ADD, Op.MULTIPLY])))
    assert ops == [Op.ADD, Op.MULTIPLY] * _COUNT


def test_a_root_starts_while_others_add() -> None:
    ops = _ops(alternate(_grouped([Op.ADD, Op.SQRT])))
    assert ops[:2] == [Op.ADD, Op.SQRT]
    assert ops[2 : _COUNT + 1] == [Op.ADD] * (_COUNT - 1)


def _ops(program: Program) -> list[Op]:
    return [instruction.op for instruction in program.instructions if instruction.op not in LEAVES]


def _grouped(ops: list[Op]) -> Program:
    """All operations of one kind before those of the next, each on numbers of its own."""
    builder = Builder()
    ends = []
    for k, op in enumerate(ops):
        for i in range(_COUNT):
            x = builder.input("x", k * _COUNT + i)
            ends.append(builder.emit(op, x) if op is Op.SQRT else builder.emit(op, x, builder.input("x", 0)))
    length = len(ends)
    full = Sparsity.of_entries(length, 1, [(k, 0) for k in range(length)])
    return builder.freeze((Argument("x", (length, 1)),), (Output("y", full, tuple(ends)),))
