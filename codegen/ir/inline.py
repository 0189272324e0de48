"""Evaluate a program inside another one: its instructions are repeated on values of a builder."""

from __future__ import annotations

from collections.abc import Callable

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Program

Entries = dict[tuple[int, int], int]
"""A matrix under construction: (row, column) -> position of a value; what is missing is zero."""


def inline(builder: Builder, program: Program, read: Callable[[str, int], int]) -> dict[str, Entries]:
    """Append a program.

    Args:
        builder: where its instructions go.
        program: what to evaluate.
        read: gives the position of the value that stands for an entry of an argument.

    Returns:
        The structural nonzeros of each output.
    """
    places: list[int] = []
    for instruction in program.instructions:
        if instruction.op is not Op.INPUT:
            operands = tuple(places[operand] for operand in instruction.operands)
            places.append(builder.append(instruction.with_operands(operands)))
        elif instruction.source is not None:
            places.append(read(*instruction.source))
        else:
            raise InternalError("an input without a source")
    return {
        output.name: {
            place: places[value] for place, value in zip(output.sparsity.entries(), output.values, strict=True)
        }
        for output in program.outputs
    }
