"""What rounding the inputs of a program does to its outputs, to first order: ``sum |df/dx| |x|`` over all inputs.

Forward derivatives, instruction by instruction, for many poses at once. Times the unit roundoff it is the error that
the best possible routine has for inputs that are rounded; the error of a routine in these units is called eta.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from codegen.errors import InternalError
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Op
from codegen.ir.program import Program

Array = NDArray[np.float64]

_CHUNK = 256
"""Poses at a time: what they need fits into the cache."""


def condition(program: Program, inputs: Mapping[str, Array]) -> dict[str, Array]:
    """Give ``sum |df/dx| |x|`` of every output entry.

    Args:
        program: what is evaluated.
        inputs: argument -> [length, poses].

    Returns:
        Output -> [nonzeros, poses].
    """
    if not inputs:
        return {output.name: np.zeros((len(output.values), 1)) for output in program.outputs}
    count = next(iter(inputs.values())).shape[1]
    pieces = [
        _Sweep(program, {name: rows[:, first : first + _CHUNK] for name, rows in inputs.items()}).outputs()
        for first in range(0, count, _CHUNK)
    ]
    return {output.name: np.concatenate([piece[output.name] for piece in pieces], axis=1) for output in program.outputs}


@dataclass(slots=True)
class _Sweep:
    """One pass over a program: values [poses] and their derivatives [inputs, poses] times the size of the inputs."""

    program: Program
    inputs: Mapping[str, Array]
    values: list[Array] = field(default_factory=list)
    gradients: list[Array | None] = field(default_factory=list)

    def outputs(self) -> dict[str, Array]:
        """Sum the magnitudes."""
        places = self._places()
        count = next(iter(self.inputs.values())).shape[1]
        last = _last_uses(self.program)
        for position, instruction in enumerate(self.program.instructions):
            operands = instruction.operands
            if instruction.op is Op.INPUT and instruction.source is not None:
                value = self.inputs[instruction.source[0]][instruction.source[1]]
                gradient = np.zeros((len(places), count))
                gradient[places[instruction.source]] = np.abs(value)
                self._put(value, gradient)
            elif instruction.op is Op.CONSTANT and instruction.constant is not None:
                self._put(np.full(count, nearest_double(instruction.constant)), None)
            else:
                value, partials = _step(instruction.op, [self.values[operand] for operand in operands])
                self._put(value, self._combined(operands, partials))
            for operand in set(operands):
                if last[operand] == position:
                    self.gradients[operand] = None
        zeros = np.zeros((len(places), count))
        return {
            output.name: np.array([_sum(self.gradients[value], zeros) for value in output.values]).reshape(-1, count)
            for output in self.program.outputs
        }

    def _places(self) -> dict[tuple[str, int], int]:
        sources = [i.source for i in self.program.instructions if i.source is not None]
        return {source: place for place, source in enumerate(dict.fromkeys(sources))}

    def _put(self, value: Array, gradient: Array | None) -> None:
        self.values.append(value)
        self.gradients.append(gradient)

    def _combined(self, operands: tuple[int, ...], partials: list[Array | float]) -> Array | None:
        total: Array | None = None
        for operand, partial in zip(operands, partials, strict=True):
            gradient = self.gradients[operand]
            if gradient is not None:
                total = partial * gradient if total is None else total + partial * gradient
        return total


def _sum(gradient: Array | None, zeros: Array) -> Array:
    return np.asarray(np.sum(np.abs(zeros if gradient is None else gradient), axis=0))


def _last_uses(program: Program) -> list[int]:
    """Position of the last use of each value; outputs are used at the end."""
    last = [len(program.instructions)] * len(program.instructions)
    kept = {value for output in program.outputs for value in output.values}
    for position, instruction in enumerate(program.instructions):
        for operand in instruction.operands:
            if operand not in kept:
                last[operand] = position
    return last


def _step(op: Op, x: list[Array]) -> tuple[Array, list[Array | float]]:
    """Value and partial derivatives of an operation; a pair of sine and cosine is its angle."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return _STEPS[op](*x) if op in _STEPS else _unknown(op)


def _unknown(op: Op) -> tuple[Array, list[Array | float]]:
    raise InternalError(f"no derivative of {op}")


def _divided(a: Array, b: Array) -> tuple[Array, list[Array | float]]:
    return a / b, [1 / b, -a / b**2]


def _angle(y: Array, x: Array) -> tuple[Array, list[Array | float]]:
    square = x * x + y * y
    return np.arctan2(y, x), [x / square, -y / square]


def _root(x: Array) -> tuple[Array, list[Array | float]]:
    root = np.sqrt(x)
    return root, [0.5 / root]


_STEPS: dict[Op, Callable[..., tuple[Array, list[Array | float]]]] = {
    Op.NEGATE: lambda a: (-a, [-1.0]),
    Op.ADD: lambda a, b: (a + b, [1.0, 1.0]),
    Op.SUBTRACT: lambda a, b: (a - b, [1.0, -1.0]),
    Op.MULTIPLY: lambda a, b: (a * b, [b, a]),
    Op.DIVIDE: _divided,
    Op.FMA: lambda a, b, c: (a * b + c, [b, a, 1.0]),
    Op.SQRT: _root,
    Op.SIN: lambda a: (np.sin(a), [np.cos(a)]),
    Op.COS: lambda a: (np.cos(a), [-np.sin(a)]),
    Op.SINCOS: lambda a: (a, [1.0]),
    Op.SINE_OF: lambda a: (np.sin(a), [np.cos(a)]),
    Op.COSINE_OF: lambda a: (np.cos(a), [-np.sin(a)]),
    Op.ATAN2: _angle,
}
