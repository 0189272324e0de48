"""What the factors of a matrix expression say of the frames that it leads to and from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import sympy
from sympy.matrices.expressions.matexpr import MatrixExpr
from sympy.matrices.matrixbase import MatrixBase

from codegen.ir.lower.operators import Tilde
from codegen.ir.lower.places import SameAxes


@dataclass(frozen=True)
class Symbols:
    """What the symbols of a model are.

    Attributes:
        rotations: rotation matrix -> (a, b), it turns components in frame b to components in frame a.
        frames: vector symbol -> the frame its components are in.
        stages: symbol -> definition.
        axes: frames whose axes have a meaning, so that a vector written in them is a sum of axes.
        whole: stages that are vectors or scalars of their own, not the sums that define them.
        constants: vector symbol -> its components, where these are numbers or scalar symbols.
        same_axes: axis -> sign and axis that stands for it.
    """

    rotations: Mapping[Any, tuple[str, str]]
    frames: Mapping[Any, str]
    stages: Mapping[Any, Any]
    axes: frozenset[str]
    whole: frozenset[Any] = frozenset()
    constants: Mapping[Any, Any] = field(default_factory=dict)
    same_axes: SameAxes = field(default_factory=dict)


class Factors:
    """Frames of factors.

    Args:
        symbols: what the symbols are.
    """

    def __init__(self, symbols: Symbols) -> None:
        self._symbols = symbols

    def turn(self, factor: Any) -> tuple[str, str] | None:
        """Frames that a rotation leads to and from."""
        if isinstance(factor, sympy.Transpose) and factor.arg in self._symbols.rotations:
            a, b = self._symbols.rotations[factor.arg]
            return b, a
        return self._symbols.rotations.get(factor)

    def frame_of(self, expression: Any) -> str | None:
        """The frame that the rows of an expression are in, where a factor says it."""
        turn = self.turn(expression)
        if turn is not None:
            return turn[0]
        if isinstance(expression, sympy.MatrixSymbol):
            if expression in self._symbols.frames:
                return self._symbols.frames[expression]
            return self.frame_of(self._symbols.stages[expression])
        if isinstance(expression, Tilde):
            return self.frame_of(expression.vector)
        if isinstance(expression, sympy.MatAdd | sympy.MatMul):
            factors = expression.args if isinstance(expression, sympy.MatAdd) else expression.as_coeff_matrices()[1]
            return next((frame for frame in map(self.frame_of, factors) if frame is not None), None)
        return None

    def frame_within(self, rest: Sequence[Any], frame: str | None) -> str | None:
        """The frame that a written-out matrix turns from: that of what stands behind it, where known, or its own."""
        if not rest:
            return frame
        turn = self.turn(rest[0])
        return turn[0] if turn is not None else self._symbols.frames.get(rest[0], frame)


def is_power(expression: Any) -> bool:
    """Whether a scalar is a product of equal factors."""
    return isinstance(expression, sympy.Pow) and bool(expression.exp.is_Integer) and expression.exp > 0


def is_matrix(expression: Any) -> bool:
    """Whether an expression is a vector or matrix."""
    return isinstance(expression, MatrixExpr | MatrixBase)


def transposed_factor(factor: Any) -> Any:
    """The transpose of a factor of a product."""
    if isinstance(factor, sympy.Transpose):
        return factor.arg
    if isinstance(factor, Tilde):
        return sympy.MatMul(-1, factor)
    return factor.T if isinstance(factor, MatrixBase) else sympy.Transpose(factor)
