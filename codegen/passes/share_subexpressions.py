"""Value numbering over the whole set of outputs: equal values are computed once, up to sign.

Each value is known as plus or minus a base, so that ``a b``, ``(-a) b`` and ``-(a b)`` are one product, and ``a -
b`` and ``b - a`` one difference. Rounding is symmetric in IEEE arithmetic: the results are the same bits, but
for the sign of a zero.
"""

from __future__ import annotations

from dataclasses import replace

from codegen.ir.builder import Builder
from codegen.ir.ops import COMMUTATIVE, Op
from codegen.ir.program import Instruction, Program
from codegen.passes.rewrite import negated

_Signed = tuple[int, int]
"""Sign and base position of a value."""

_ODD = frozenset({Op.SIN, Op.SINE_OF})
_EVEN = frozenset({Op.COS, Op.COSINE_OF, Op.ABS})


def share_subexpressions(program: Program) -> Program:
    """Compute each value once; signs move to where values are used, the rest of them to the outputs."""
    numbering = _Numbering()
    values: list[_Signed] = []
    for instruction in program.instructions:
        value = numbering.number(instruction, [values[operand] for operand in instruction.operands])
        if instruction.label is not None and value[0] > 0:
            numbering.builder.label(value[1], instruction.label)
        values.append(value)
    outputs = tuple(
        replace(output, values=tuple(numbering.materialise(values[value]) for value in output.values))
        for output in program.outputs
    )
    return Program(program.arguments, tuple(numbering.builder.instructions), outputs, program.legend)


class _Numbering:
    """The values numbered so far."""

    def __init__(self) -> None:
        self.builder = Builder()
        self._differences: dict[tuple[int, int], int] = {}

    def number(self, instruction: Instruction, operands: list[_Signed]) -> _Signed:
        """Give sign and base of an instruction on signed operands."""
        match instruction.op:
            case Op.CONSTANT if instruction.constant is not None and instruction.constant.rational < 0:
                return -1, self.builder.constant(-instruction.constant)
            case Op.NEGATE:
                return -operands[0][0], operands[0][1]
            case Op.MULTIPLY | Op.DIVIDE:
                (sign_a, a), (sign_b, b) = operands
                return sign_a * sign_b, self._emit(instruction.op, a, b)
            case Op.FMA:
                return self._fused(*operands)
            case Op.ADD:
                return self._sum(operands[0], operands[1])
            case Op.SUBTRACT:
                sign, base = operands[1]
                return self._sum(operands[0], (-sign, base))
        if instruction.op in _ODD:
            return operands[0][0], self.builder.emit(instruction.op, operands[0][1])
        if instruction.op in _EVEN:
            return 1, self.builder.emit(instruction.op, operands[0][1])
        if not operands:
            return 1, self.builder.append(instruction)
        return 1, self.builder.emit(instruction.op, *(self.materialise(operand) for operand in operands))

    def _emit(self, op: Op, a: int, b: int) -> int:
        if op in COMMUTATIVE and a > b:
            a, b = b, a
        return self.builder.emit(op, a, b)

    def _sum(self, first: _Signed, second: _Signed) -> _Signed:
        (sign_a, a), (sign_b, b) = first, second
        if sign_a == sign_b:
            return sign_a, self._emit(Op.ADD, a, b)
        if sign_a < 0:
            a, b = b, a
        if (b, a) in self._differences:
            return -1, self._differences[b, a]
        position = self._differences[a, b] = self.builder.emit(Op.SUBTRACT, a, b)
        return 1, position

    def _fused(self, first: _Signed, second: _Signed, addend: _Signed) -> _Signed:
        """The product is given a plus, the addend keeps the sign that is left."""
        sign = first[0] * second[0]
        third = self.materialise((sign * addend[0], addend[1]))
        factors = sorted((first[1], second[1]))
        return sign, self.builder.emit(Op.FMA, *factors, third)

    def materialise(self, value: _Signed) -> int:
        """Give a position that holds the value itself."""
        sign, base = value
        return base if sign > 0 else negated(self.builder, base)
