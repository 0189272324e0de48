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


Rule = Callable[[Builder, Instruction], int | None]
"""Position of what stands for an instruction, appended where it is new; None where the rule has nothing to say."""


def rebuild(program: Program, *rules: Rule) -> Program:
    """Rebuild a program: each instruction, its operands mapped already, by the first rule that has something to say."""
    rebuilding = Rebuilding(program)
    moved, builder = rebuilding.moved, rebuilding.builder
    for instruction in program.instructions:
        operands = instruction.operands
        moving = instruction.with_operands(tuple([moved[operand] for operand in operands])) if operands else instruction
        for rule in rules:
            position = rule(builder, moving)
            if position is not None:
                rebuilding.put(instruction, position)
                break
        else:
            rebuilding.put(instruction, builder.append(moving))
    return rebuilding.finish()


def reorder(program: Program, order: Sequence[int]) -> Program:
    """Give the program with only these instructions, in this order; operands must come before their uses."""
    new_place = [0] * len(program.instructions)
    for new, old in enumerate(order):
        new_place[old] = new
    kept = [program.instructions[old] for old in order]
    instructions = tuple(
        [i.with_operands(tuple([new_place[o] for o in i.operands])) if i.operands else i for i in kept]
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
