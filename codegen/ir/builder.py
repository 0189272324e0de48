"""`Builder`: appends instructions one by one and freezes them into a `Program`.

The builder interns what it appends (the same operation on the same operands is one value), so that lowering and
passes may ask for a value as often as they like; it makes no other simplification.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from codegen.ir.ops import COMMUTATIVE, Constant, Op
from codegen.ir.program import Argument, Instruction, Output, Program

_Key = tuple[Op, tuple[int, ...], Constant | None, tuple[str, int] | None]


class Builder:
    """Mutable list of instructions under construction."""

    def __init__(self) -> None:
        self.instructions: list[Instruction] = []
        self._known: dict[_Key, int] = {}
        self._integers: dict[int, int] = {}

    def append(self, instruction: Instruction) -> int:
        """Append an instruction, or find the equal one that is there; give its position."""
        operands = instruction.operands
        if instruction.op in COMMUTATIVE and operands[0] > operands[1]:
            operands = (operands[1], operands[0], *operands[2:])
        key = (instruction.op, operands, instruction.constant, instruction.source)
        position = self._known.get(key)
        if position is None:
            position = self._known[key] = len(self.instructions)
            self.instructions.append(instruction)
        elif instruction.label is not None and self.instructions[position].label is None:
            self.label(position, instruction.label)
        return position

    def emit(self, op: Op, *operands: int) -> int:
        """Append an operation on values."""
        return self.append(Instruction(op, operands))

    def constant(self, value: Constant | Fraction | int) -> int:
        """Append an exact constant."""
        if isinstance(value, int):
            if value not in self._integers:
                self._integers[value] = self._constant(Constant(Fraction(value)))
            return self._integers[value]
        return self._constant(value if isinstance(value, Constant) else Constant(value))

    def _constant(self, constant: Constant) -> int:
        return self.append(Instruction(Op.CONSTANT, constant=constant))

    def input(self, argument: str, index: int) -> int:
        """Append entry ``index`` of an argument."""
        return self.append(Instruction(Op.INPUT, source=(argument, index)))

    def value_of(self, position: int) -> Constant | None:
        """Give the value of a constant, or None for anything else."""
        return self.instructions[position].constant

    def label(self, position: int, label: tuple[str, int]) -> None:
        """Name a value for readers, unless it is a leaf or has a name."""
        instruction = self.instructions[position]
        if instruction.label is None and instruction.operands:
            self.instructions[position] = Instruction(instruction.op, instruction.operands, label=label)

    def freeze(
        self,
        arguments: tuple[Argument, ...],
        outputs: tuple[Output, ...],
        legend: Mapping[str, str] | None = None,
    ) -> Program:
        """Give the program of everything appended so far."""
        return Program(arguments, tuple(self.instructions), outputs, tuple((legend or {}).items()))
