"""Whether a routine reads its inputs again, by the model of registers; programs by hand."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from codegen.emit.registers import REGISTERS, is_better_read_again
from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity

TOGETHER = 4


def pairs(width: int, ops: Sequence[Op]) -> Program:
    """Operations on neighbouring inputs, all pairs with the first operation, then all with the next."""
    builder = Builder()
    taken = [(builder.input("x", k), builder.input("x", k + 1)) for k in range(0, width, 2)]
    values = tuple(builder.emit(op, *pair) for op in ops for pair in taken)
    pattern = Sparsity.of_entries(len(values), 1, [(k, 0) for k in range(len(values))])
    return builder.freeze((Argument("x", (width, 1)),), (Output("y", pattern, values),), {})


def test_inputs_that_are_used_again_behind_more_others_than_there_are_registers_are_read_again() -> None:
    assert is_better_read_again(pairs(2 * REGISTERS, (Op.ADD, Op.SUBTRACT)), TOGETHER)


@pytest.mark.parametrize(
    ("width", "ops"),
    [(REGISTERS // 2, (Op.ADD, Op.SUBTRACT)), (2 * REGISTERS, (Op.ADD,))],
    ids=["inputs that fit the registers", "inputs that are used once"],
)
def test_other_inputs_are_kept(width: int, ops: Sequence[Op]) -> None:
    assert not is_better_read_again(pairs(width, ops), TOGETHER)
