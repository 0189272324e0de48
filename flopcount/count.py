"""Count the operations of a program."""

from __future__ import annotations

from collections import Counter

from codegen.ir.looped import Looped
from codegen.ir.ops import Op
from codegen.ir.program import Program
from flopcount.counts import Counts

_KIND: dict[Op, str] = {
    Op.ADD: "add",
    Op.SUBTRACT: "add",
    Op.MULTIPLY: "mul",
    Op.DIVIDE: "div",
    Op.FMA: "fma",
    Op.SQRT: "sqrt",
    Op.SINCOS: "sincos",
    Op.SIN: "sin",
    Op.COS: "cos",
    Op.ATAN2: "atan2",
    Op.NEGATE: "neg",
    Op.ABS: "abs",
    Op.SELECT: "select",
}


def count(program: Program | Looped) -> Counts:
    """Count every instruction of the program; inputs, constants and projections are free.

    The operations of a loop are those of an instance times the number of instances.
    """
    if isinstance(program, Looped):
        return sum((count(loop.program).times(loop.count) for loop in program.loops), Counts())
    kinds = Counter(_KIND[instruction.op] for instruction in program.instructions if instruction.op in _KIND)
    return Counts(**kinds)
