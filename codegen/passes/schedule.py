"""Order the instructions depth-first, output by output, so that few values are alive at a time.

The heavier operand of each operation comes first (Sethi and Ullman). The C emitter stores each result where it is
ready.
"""

from __future__ import annotations

from codegen.ir.ops import LEAVES
from codegen.ir.program import Program
from codegen.passes.rewrite import reorder


def schedule(program: Program) -> Program:
    """Give the program in depth-first order; unused instructions are dropped."""
    registers = _registers(program)
    order: list[int] = []
    placed = [False] * len(program.instructions)
    for output in program.outputs:
        for value in output.values:
            _place(program, value, registers, placed, order)
    return reorder(program, order)


def _registers(program: Program) -> list[int]:
    """Values alive at once that each instruction needs, were it a tree."""
    needs: list[int] = []
    for instruction in program.instructions:
        below = sorted((needs[operand] for operand in instruction.operands), reverse=True)
        needs.append(max([need + k for k, need in enumerate(below)], default=int(instruction.op not in LEAVES)) or 1)
    return needs


def _place(program: Program, root: int, registers: list[int], placed: list[bool], order: list[int]) -> None:
    stack = [root]
    while stack:
        position = stack[-1]
        if placed[position]:
            stack.pop()
            continue
        waiting = [operand for operand in program.instructions[position].operands if not placed[operand]]
        if waiting:
            stack.append(max(waiting, key=lambda operand: registers[operand]))
            continue
        placed[position] = True
        order.append(position)
        stack.pop()
