"""Differentiate a program: forward, instruction by instruction, over structural nonzeros.

The result is a program of its own. Its outputs are the blocks ``jac_<output>_<direction>``: rows are the entries of the
output, columns the entries of the direction, both column-major and counted dense, as CasADi has them. Directions are
the arguments, or whatever a seed says that the entries of the arguments depend on.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Instruction, Output, Program, Sparsity

_Source = tuple[str, int]
Gradient = dict[_Source, int]
"""Entry of a direction -> position of the partial derivative; what is missing is zero."""

Seed = Callable[[Builder, str, int], Gradient]
"""Gradient of an entry of an argument, appended to the program that is built."""


def itself(builder: Builder, argument: str, index: int) -> Gradient:
    """The seed of derivatives by the arguments themselves."""
    return {(argument, index): builder.constant(1)}


def differentiate(program: Program, directions: Sequence[Argument] | None = None, seed: Seed = itself) -> Program:
    """Give the program of all partial derivatives of all outputs; not simplified.

    Args:
        program: what to differentiate.
        directions: what by, under names and shapes; the arguments that are used, if left out.
        seed: how the entries of arguments depend on the directions.
    """
    differentiation = _Differentiation(seed)
    gradients = [differentiation.advance(instruction) for instruction in program.instructions]
    by = program.used_arguments() if directions is None else directions
    outputs = tuple(_block(output, direction, gradients) for output in program.outputs for direction in by)
    return differentiation.builder.freeze(program.arguments, outputs, dict(program.legend))


def _block(output: Output, direction: Argument, gradients: Sequence[Gradient]) -> Output:
    nrow = output.sparsity.nrow
    found: dict[tuple[int, int], int] = {}
    for (row, column), value in zip(output.sparsity.entries(), output.values, strict=True):
        for (name, index), position in gradients[value].items():
            if name == direction.name:
                found[column * nrow + row, index] = position
    sparsity = Sparsity.of_entries(nrow * output.sparsity.ncol, direction.length, found)
    values = tuple(found[entry] for entry in sparsity.entries())
    return Output(f"jac_{output.name}_{direction.name}", sparsity, values)


class _Differentiation:
    """Repeats the program's own instructions (its values are needed) and appends the derivatives."""

    def __init__(self, seed: Seed) -> None:
        self.builder = Builder()
        self._seed = seed
        self._places: list[int] = []
        self._gradients: list[Gradient] = []

    def advance(self, instruction: Instruction) -> Gradient:
        """Repeat one instruction and give its gradient."""
        operands = tuple(self._places[operand] for operand in instruction.operands)
        place = self.builder.append(instruction.with_operands(operands))
        inner = [self._gradients[operand] for operand in instruction.operands]
        if instruction.op is Op.INPUT and instruction.source is not None:
            gradient = self._seed(self.builder, *instruction.source)
        elif instruction.op is Op.SELECT:
            gradient = self._chosen(inner, operands)
        else:
            gradient = self._combined(inner, self._partials(instruction.op, operands, place))
        self._places.append(place)
        self._gradients.append(gradient)
        return gradient

    def _combined(self, inner: list[Gradient], partials: list[int | None]) -> Gradient:
        """Chain rule: the sum of partial times inner derivative, for each input entry."""
        emit = self.builder.emit
        combined: Gradient = {}
        for gradient, partial in zip(inner, partials, strict=True):
            for source, derivative in gradient.items():
                term = derivative if partial is None else emit(Op.MULTIPLY, partial, derivative)
                combined[source] = emit(Op.ADD, combined[source], term) if source in combined else term
        return combined

    def _chosen(self, inner: list[Gradient], operands: tuple[int, ...]) -> Gradient:
        """The derivative is chosen as the value is; what is not chosen may be no number."""
        zero = self.builder.constant(0)
        _, _, chosen, other = inner
        return {
            source: self.builder.emit(Op.SELECT, *operands[:2], chosen.get(source, zero), other.get(source, zero))
            for source in (chosen | other)
        }

    def _partials(self, op: Op, operands: tuple[int, ...], place: int) -> list[int | None]:
        """Partial derivative by each operand; None stands for one."""
        builder, emit = self.builder, self.builder.emit
        match op:
            case Op.CONSTANT:
                return []
            case Op.NEGATE:
                return [builder.constant(-1)]
            case Op.ADD:
                return [None, None]
            case Op.SUBTRACT:
                return [None, builder.constant(-1)]
            case Op.MULTIPLY:
                return [operands[1], operands[0]]
            case Op.DIVIDE:
                inverse = emit(Op.DIVIDE, builder.constant(1), operands[1])
                return [inverse, emit(Op.NEGATE, emit(Op.MULTIPLY, place, inverse))]
            case Op.FMA:
                return [operands[1], operands[0], None]
            case Op.ABS:
                zero, one = builder.constant(0), builder.constant(1)
                return [emit(Op.SELECT, operands[0], zero, builder.constant(-1), one)]
            case Op.SQRT:
                return [emit(Op.DIVIDE, builder.constant(1), emit(Op.MULTIPLY, builder.constant(2), place))]
            case Op.SIN:
                return [emit(Op.COS, operands[0])]
            case Op.COS:
                return [emit(Op.NEGATE, emit(Op.SIN, operands[0]))]
            case Op.SINCOS:
                return [None]
            case Op.SINE_OF:
                return [emit(Op.COSINE_OF, operands[0])]
            case Op.COSINE_OF:
                return [emit(Op.NEGATE, emit(Op.SINE_OF, operands[0]))]
            case Op.ATAN2:
                y, x = operands
                square = emit(Op.ADD, emit(Op.MULTIPLY, x, x), emit(Op.MULTIPLY, y, y))
                return [emit(Op.DIVIDE, x, square), emit(Op.NEGATE, emit(Op.DIVIDE, y, square))]
        raise InternalError(f"no derivative of {op}")
