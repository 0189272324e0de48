"""What the passes share: rebuild a program instruction by instruction."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Instruction, Program


class Rebuilding:
    """A program under reconstruction, instruction by instruction.

    Attributes:
        builder: what has been rebuilt.
        moved: new position of each instruction that has been put.
    """

    def __init__(self, program: Program) -> None:
        self.builder = Builder()
        self.moved: list[int] = []
        self._program = program

    def copy(self, instruction: Instruction) -> None:
        """Repeat the next instruction on its moved operands."""
        operands = tuple(self.moved[operand] for operand in instruction.operands)
        self.put(instruction, self.builder.append(instruction.with_operands(operands)))

    def put(self, instruction: Instruction, position: int) -> None:
        """Let a rebuilt value stand for the next instruction, under its name."""
        if instruction.label is not None:
            self.builder.label(position, instruction.label)
        self.moved.append(position)

    def finish(self) -> Program:
        """Give the rebuilt program."""
        return _with(self._program, self.builder, self.moved)


def rebuild(program: Program, place: Callable[[Builder, Instruction], int]) -> Program:
    """Rebuild a program; ``place`` appends each instruction, operands mapped already, and gives its new position."""
    rebuilding = Rebuilding(program)
    moved = rebuilding.moved
    for instruction in program.instructions:
        operands = tuple([moved[operand] for operand in instruction.operands])
        moving = instruction.with_operands(operands) if operands else instruction
        rebuilding.put(instruction, place(rebuilding.builder, moving))
    return rebuilding.finish()


def reorder(program: Program, order: Sequence[int]) -> Program:
    """Give the program with only these instructions, in this order; operands must come before their uses."""
    new_place = {old: new for new, old in enumerate(order)}
    instructions = tuple(
        program.instructions[old].with_operands(
            tuple(new_place[operand] for operand in program.instructions[old].operands)
        )
        for old in order
    )
    outputs = tuple(
        replace(output, values=tuple(new_place[value] for value in output.values)) for output in program.outputs
    )
    return replace(program, instructions=instructions, outputs=outputs)


def _with(program: Program, builder: Builder, moved: list[int]) -> Program:
    outputs = tuple(
        replace(output, values=tuple(moved[value] for value in output.values)) for output in program.outputs
    )
    return Program(program.arguments, tuple(builder.instructions), outputs, program.legend)


def is_constant(builder: Builder, position: int, value: int) -> bool:
    """Whether a value under construction is exactly that integer."""
    constant = builder.value_of(position)
    return constant is not None and constant.equals(value)


def negated(builder: Builder, position: int) -> int:
    """Append the negative of a value; of a constant, the negative constant."""
    constant = builder.value_of(position)
    return builder.constant(-constant) if constant is not None else builder.emit(Op.NEGATE, position)
