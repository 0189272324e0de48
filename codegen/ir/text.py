"""The text form of a program: one instruction a line, for ``--dump program``, diffs and hashes."""

from __future__ import annotations

from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program


def dump(program: Program) -> str:
    """Write the program as text; equal programs give equal text."""
    lines = [f"argument {argument.name} {argument.shape[0]}x{argument.shape[1]}" for argument in program.arguments]
    lines += [f"%{position} = {_instruction(instruction)}" for position, instruction in enumerate(program.instructions)]
    for output in program.outputs:
        pattern = output.sparsity
        lines.append(f"output {output.name} {pattern.nrow}x{pattern.ncol}")
        lines += [
            f"  [{row},{column}] = %{value}"
            for (row, column), value in zip(pattern.entries(), output.values, strict=True)
        ]
    return "\n".join(lines) + "\n"


def _instruction(instruction: Instruction) -> str:
    if instruction.op is Op.INPUT and instruction.source is not None:
        return f"{instruction.source[0]}[{instruction.source[1]}]"
    if instruction.op is Op.CONSTANT:
        return f"constant {instruction.constant}"
    operands = " ".join(f"%{operand}" for operand in instruction.operands)
    label = f"  ; {instruction.label[0]}[{instruction.label[1]}]" if instruction.label else ""
    return f"{instruction.op.value} {operands}{label}"
