"""Turn ``-(a - b)`` into ``b - a`` where the difference has no other use."""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program
from codegen.passes.drop_unused import drop_unused
from codegen.passes.rewrite import rebuild


def absorb_negations(program: Program) -> Program:
    """Remove negations that cost nothing to remove; the bits of the results stay the same."""
    uses = [0] * len(program.instructions)
    for instruction in program.instructions:
        for operand in instruction.operands:
            uses[operand] += 1
    for output in program.outputs:
        for value in output.values:
            uses[value] += 1
    absorbed = {
        instruction.operands[0]
        for instruction in program.instructions
        if instruction.op is Op.NEGATE
        and program.instructions[instruction.operands[0]].op is Op.SUBTRACT
        and uses[instruction.operands[0]] == 1
    }
    flipped = {program.instructions[position].operands for position in absorbed}

    def place(builder: Builder, instruction: Instruction) -> int:
        if instruction.op is Op.NEGATE:
            inner = builder.instructions[instruction.operands[0]]
            if inner.op is Op.SUBTRACT and inner.operands in moved_pairs:
                return builder.emit(Op.SUBTRACT, *reversed(inner.operands))
        position = builder.append(instruction)
        if instruction.op is Op.SUBTRACT and counter[0] in absorbed:
            moved_pairs.add(builder.instructions[position].operands)
        return position

    if not flipped:
        return program
    moved_pairs: set[tuple[int, ...]] = set()
    counter = [-1]

    def counted(builder: Builder, instruction: Instruction) -> int:
        counter[0] += 1
        return place(builder, instruction)

    return drop_unused(rebuild(program, counted))
