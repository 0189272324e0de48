"""Pair the sine and the cosine of one angle: one `SINCOS` and two free projections."""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program
from codegen.passes.rewrite import rebuild


def pair_sincos(program: Program) -> Program:
    """Replace sine and cosine by projections of a pair where an angle has both."""
    angles = {
        op: {instruction.operands for instruction in program.instructions if instruction.op is op}
        for op in (Op.SIN, Op.COS)
    }
    paired = angles[Op.SIN] & angles[Op.COS]
    wanted = [
        instruction.op in (Op.SIN, Op.COS) and instruction.operands in paired for instruction in program.instructions
    ]
    remaining = iter(wanted)

    def place(builder: Builder, instruction: Instruction) -> int:
        if not next(remaining):
            return builder.append(instruction)
        pair = builder.emit(Op.SINCOS, *instruction.operands)
        return builder.emit(Op.SINE_OF if instruction.op is Op.SIN else Op.COSINE_OF, pair)

    return rebuild(program, place)
