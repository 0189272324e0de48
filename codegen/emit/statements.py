"""Turn a program into C statements.

A value that is used once and has no name is written inside the expression that uses it; every other value is a
``const`` of its stage's name (``A_ij_4``) or ``t12``. Results are stored near where they are ready, some at a
time: behind a store a compiler reads the inputs again, where it does not know that arrays do not overlap.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass

from codegen.emit.literals import literal
from codegen.errors import InternalError
from codegen.ir.ops import COMMUTATIVE, LEAVES, PROJECTIONS, Op
from codegen.ir.program import Instruction, Program

TOGETHER = 8
"""How many results are stored at a time in a routine for one of a kind."""

_INFIX: dict[Op, str] = {Op.ADD: "+", Op.SUBTRACT: "-", Op.MULTIPLY: "*", Op.DIVIDE: "/"}
_CALL: dict[Op, str] = {
    Op.FMA: "jg_fma",
    Op.SQRT: "jg_sqrt",
    Op.SIN: "jg_sin",
    Op.COS: "jg_cos",
    Op.ATAN2: "jg_atan2",
    Op.ABS: "jg_abs",
    Op.SELECT: "jg_select",
}
_PRECEDENCE: dict[Op, int] = {Op.ADD: 1, Op.SUBTRACT: 1, Op.MULTIPLY: 2, Op.DIVIDE: 2, Op.NEGATE: 3}
_ATOM = 4

_Expression = tuple[str, int]
"""Text and precedence."""


@dataclass(frozen=True, slots=True)
class Notation:
    """How values are declared, read and stored: one number here, many of them in a batch.

    Attributes:
        number: type of a value.
        read: entry ``index`` of the input ``array``.
        store: entry ``index`` of the output ``array``.
        constant: a literal that stands alone, not beside a value in an operation.
        suffix: of the functions.
        together: how many results are stored at a time.
    """

    number: str = "jg_real"
    read: str = "{array}[{index}]"
    store: str = "{array}[{index}]"
    constant: str = "{literal}"
    suffix: str = ""
    together: int = TOGETHER


SCALAR = Notation()


class Statements:
    """The C statements of a program.

    Args:
        program: scheduled.
        views: argument -> (name, offset, length) of its named parts, for readable indices.
        notation: how values are declared, read and stored.

    Attributes:
        lines: the statements, without indentation.
        temporaries: number of local values.
        used_views: names of the parts that the statements mention.
    """

    def __init__(
        self, program: Program, views: Mapping[str, tuple[tuple[str, int, int], ...]], notation: Notation = SCALAR
    ) -> None:
        self.lines: list[str] = []
        self.temporaries = 0
        self.used_views: set[str] = set()
        self._program = program
        self._views = views
        self._notation = notation
        self._legend = dict(program.legend)
        self._uses = program.uses()
        self._names: dict[int, str] = {}
        self._taken = {name for parts in views.values() for name, _, _ in parts}
        self._indices = Counter(label[0] for label in {i.label for i in program.instructions if i.label is not None})
        self._inline: dict[int, _Expression] = {}
        self._write()

    def _write(self) -> None:
        stores, ready = self._stores(), list[str]()
        for position, instruction in enumerate(self._program.instructions):
            if instruction.op is Op.SINCOS:
                self._write_sincos(position, instruction)
            elif instruction.op not in PROJECTIONS:
                self._write_value(position, instruction)
            ready += [f"{store} = {self._alone(position)};" for store in stores.get(position, ())]
            if len(ready) >= self._notation.together:
                self.lines += ready
                ready = []
        self.lines += ready
        self.lines += [f"(void){output.name};" for output in self._program.outputs if not output.values]

    def _stores(self) -> dict[int, list[str]]:
        stores: dict[int, list[str]] = {}
        for output in self._program.outputs:
            for k, value in enumerate(output.values):
                stores.setdefault(value, []).append(self._notation.store.format(array=output.name, index=k))
        return stores

    def _write_value(self, position: int, instruction: Instruction) -> None:
        expression = self._expression(instruction)
        needs_name = self._uses[position] > 1 or instruction.label is not None
        if instruction.op in LEAVES or not needs_name:
            self._inline[position] = expression
            return
        name = self._new_name(instruction)
        self._comment(instruction)
        self.lines.append(f"const {self._notation.number} {name} = {expression[0]};")
        self._inline[position] = (name, _ATOM)
        self.temporaries += 1

    def _comment(self, instruction: Instruction) -> None:
        """Say what a stage is where its first value appears."""
        if instruction.label is not None:
            definition = self._legend.pop(instruction.label[0], None)
            if definition is not None:
                self.lines.append(f"/* {instruction.label[0]} = {definition.replace('*/', '* /')} */")

    def _write_sincos(self, position: int, instruction: Instruction) -> None:
        angle = self._alone(instruction.operands[0])
        place = len([name for name in self._names.values() if name.startswith("sine_")])
        sine, cosine = f"sine_{place}", f"cosine_{place}"
        self._names[position] = sine
        number, suffix = self._notation.number, self._notation.suffix
        self.lines += [f"{number} {sine};", f"{number} {cosine};"]
        self.lines += [f"jg_sincos{suffix}({angle}, &{sine}, &{cosine});"]
        self.temporaries += 2
        for other, projection in enumerate(self._program.instructions):
            if projection.op in PROJECTIONS and projection.operands[0] == position:
                self._inline[other] = (sine if projection.op is Op.SINE_OF else cosine, _ATOM)

    def _new_name(self, instruction: Instruction) -> str:
        name = f"t{self.temporaries}"
        if instruction.label is not None:
            stage, index = instruction.label
            name = f"{stage}_{index}" if self._indices[stage] > 1 or index else stage
        while name in self._taken:
            name += "_"
        self._taken.add(name)
        return name

    def _value(self, position: int) -> _Expression:
        return self._inline[position]

    def _alone(self, position: int) -> str:
        """A value where it is not the operand of an operator."""
        text = self._value(position)[0]
        is_constant = self._program.instructions[position].op is Op.CONSTANT
        return self._notation.constant.format(literal=text) if is_constant else text

    def _expression(self, instruction: Instruction) -> _Expression:
        if instruction.op is Op.INPUT and instruction.source is not None:
            return self._input(*instruction.source), _ATOM
        if instruction.op is Op.CONSTANT and instruction.constant is not None:
            return literal(instruction.constant), _ATOM
        operands = [self._value(operand) for operand in instruction.operands]
        if instruction.op in _INFIX:
            rank = _PRECEDENCE[instruction.op]
            if instruction.op in COMMUTATIVE and operands[0][1] > rank == operands[1][1]:
                operands.reverse()
            left, right = _enclosed(operands[0], rank), _enclosed(operands[1], rank + 1)
            return f"{left} {_INFIX[instruction.op]} {right}", rank
        if instruction.op is Op.NEGATE:
            return f"-{_enclosed(operands[0], _PRECEDENCE[Op.NEGATE] + 1)}", _PRECEDENCE[Op.NEGATE]
        if instruction.op in _CALL:
            function = f"{_CALL[instruction.op]}{self._notation.suffix}"
            return f"{function}({', '.join(self._alone(operand) for operand in instruction.operands)})", _ATOM
        raise InternalError(f"no C for {instruction.op}")

    def _input(self, argument: str, index: int) -> str:
        for name, offset, length in self._views.get(argument, ()):
            if offset <= index < offset + length:
                self.used_views.add(name)
                return name if length == 1 else self._notation.read.format(array=name, index=index - offset)
        return self._notation.read.format(array=argument, index=index)


def _enclosed(expression: _Expression, rank: int) -> str:
    text, own = expression
    return text if own >= rank else f"({text})"
