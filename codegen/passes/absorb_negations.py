"""Turn ``-(a - b)`` into ``b - a`` where the difference has no other use; the same bits but for the sign of a zero."""

from __future__ import annotations

from dataclasses import replace

from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program
from codegen.passes.drop_unused import drop_unused


def absorb_negations(program: Program) -> Program:
    """Remove the negations that cost nothing to remove."""
    uses = program.uses()

    def absorbed(instruction: Instruction) -> Instruction:
        if instruction.op is not Op.NEGATE:
            return instruction
        inner = program.instructions[instruction.operands[0]]
        if inner.op is not Op.SUBTRACT or uses[instruction.operands[0]] > 1:
            return instruction
        return inner._replace(operands=inner.operands[::-1], label=instruction.label)

    return drop_unused(replace(program, instructions=tuple(absorbed(i) for i in program.instructions)))
