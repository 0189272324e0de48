"""The operations of programs and their derivatives over Arb balls."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from codegen.errors import InternalError
from codegen.ir.ops import Op

Ball = Any
"""An Arb ball."""

_HALF_TURN = 3.15


class Enclosures:
    """Encloses values and partial derivatives of operations."""

    def __init__(self, reach: float) -> None:
        """Take the least distance from the origin of what arc tangents are taken of; 0 where it is not known."""
        import flint

        self._arb = flint.arb
        self._reach = reach
        self._zero, self.one = flint.arb(0), flint.arb(1)

    def value(self, op: Op, x: Sequence[Ball]) -> Ball:
        """Enclose the result of an operation."""
        match op:
            case Op.NEGATE:
                return -x[0]
            case Op.ADD:
                return x[0] + x[1]
            case Op.SUBTRACT:
                return x[0] - x[1]
            case Op.MULTIPLY:
                return x[0] * x[1]
            case Op.DIVIDE:
                return x[0] / x[1]
            case Op.FMA:
                return x[0] * x[1] + x[2]
            case Op.SQRT:
                return x[0].sqrt()
            case Op.SIN | Op.SINE_OF:
                return x[0].sin()
            case Op.COS | Op.COSINE_OF:
                return x[0].cos()
            case Op.SINCOS:
                return x[0]
            case Op.ATAN2:
                return self._arb(0, _HALF_TURN)
            case Op.ABS:
                return abs(x[0])
            case Op.SELECT:
                return x[2] if x[0] < x[1] else x[3] if x[0] >= x[1] else x[2].union(x[3])
        raise InternalError(f"no enclosure of {op}")

    def _angle_slopes(self, y: Ball, x: Ball) -> list[Ball]:
        """Derivatives of the angle of (y, x); where the box holds the origin, what the reach says of them."""
        square = x * x + y * y
        if square > 0:
            return [x / square, -y / square]
        steep = self._arb(0, 1 / self._reach if self._reach else float("inf"))
        return [steep, steep]

    def _choice_slopes(self, a: Ball, b: Ball) -> list[Ball]:
        """Derivatives of a choice; where the box does not decide it, an error of what is compared is not bounded."""
        if a < b or a >= b:
            taken = bool(a < b)
            return [self._zero, self._zero, *((self.one, self._zero) if taken else (self._zero, self.one))]
        part = self._arb(0.5, 0.5)
        return [self._arb(0, float("inf")), self._arb(0, float("inf")), part, part]

    def slopes(self, op: Op, x: Sequence[Ball]) -> list[Ball]:
        """Enclose the partial derivatives of an operation."""
        match op:
            case Op.CONSTANT | Op.INPUT:
                return []
            case Op.NEGATE:
                return [-self.one]
            case Op.ADD:
                return [self.one, self.one]
            case Op.SUBTRACT:
                return [self.one, -self.one]
            case Op.MULTIPLY:
                return [x[1], x[0]]
            case Op.DIVIDE:
                return [1 / x[1], -x[0] / x[1] ** 2]
            case Op.FMA:
                return [x[1], x[0], self.one]
            case Op.SQRT:
                return [1 / (2 * x[0].sqrt())]
            case Op.SIN | Op.SINE_OF:
                return [x[0].cos()]
            case Op.COS | Op.COSINE_OF:
                return [-x[0].sin()]
            case Op.SINCOS:
                return [self.one]
            case Op.ATAN2:
                return self._angle_slopes(x[0], x[1])
            case Op.ABS:
                return [self.one if x[0] > 0 else -self.one if x[0] < 0 else self._arb(0, 1)]
            case Op.SELECT:
                return self._choice_slopes(x[0], x[1])
        raise InternalError(f"no derivative of {op}")
