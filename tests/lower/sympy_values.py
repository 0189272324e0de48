"""Values of the symbolic model's expressions by the rules of matrices: components are numbers, there are no frames."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import numpy as np
import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.ir.lower import Dot, Tilde

from .numbers import PI, arc_tangent, cosine, sine, skew


class Values:
    """Evaluates expressions at given values of the input symbols.

    Args:
        inputs: name of an input symbol -> its value.
        stages: symbol -> definition; these go before inputs.
    """

    def __init__(self, inputs: Mapping[str, Any], stages: Mapping[Any, Any]) -> None:
        self._inputs, self._stages = inputs, stages
        self._known: dict[Any, Any] = {}

    def of(self, expression: Any) -> Any:
        """A number, an array [3] of a vector, [1, 3] of its transpose, or [3, 3]."""
        if expression not in self._known:
            self._known[expression] = self._value(expression)
        return self._known[expression]

    def _value(self, expression: Any) -> Any:
        if expression in self._stages:
            return self.of(self._stages[expression])
        if isinstance(expression, MatrixBase):
            entries = [[self.of(expression[i, k]) for k in range(expression.cols)] for i in range(expression.rows)]
            return np.array(entries, dtype=object).reshape(_shape(expression))
        match expression:
            case sympy.Symbol() | sympy.MatrixSymbol():
                return self._inputs[expression.name]
            case sympy.Rational():
                return Fraction(int(expression.p), int(expression.q))
            case Tilde():
                return skew(self.of(expression.vector))
            case Dot():
                return self.of(expression.args[0]) @ self.of(expression.args[1])
            case sympy.Transpose():
                return self._matrix(expression.arg).T
            case sympy.Identity():
                return np.eye(3, dtype=object)
            case sympy.ZeroMatrix():
                return np.zeros(_shape(expression), dtype=object)
            case sympy.Add() | sympy.MatAdd():
                return sum((self.of(term) for term in expression.args[1:]), self.of(expression.args[0]))
            case sympy.MatMul():
                return self._matmul(expression)
            case sympy.Mul():
                return self._product([self.of(factor) for factor in expression.args])
            case sympy.Pow():
                return self.of(expression.base) ** int(expression.exp)
        return self._function(expression)

    def _matrix(self, expression: Any) -> Any:
        """Value with two indices."""
        return np.asarray(self.of(expression), dtype=object).reshape(expression.shape)

    def _product(self, factors: list[Any]) -> Any:
        result = factors[0]
        for factor in factors[1:]:
            result = result * factor
        return result

    def _matmul(self, expression: Any) -> Any:
        coefficient, factors = expression.as_coeff_matrices()
        result = self._matrix(factors[0])
        for factor in factors[1:]:
            result = result @ self._matrix(factor)
        return (result * self.of(coefficient)).reshape(_shape(expression))

    def _function(self, expression: Any) -> Any:
        if expression is sympy.pi:
            return PI
        functions = {"sin": sine, "cos": cosine, "atan2": arc_tangent}
        return functions[type(expression).__name__](*(self.of(argument) for argument in expression.args))


def _shape(expression: Any) -> tuple[int, ...]:
    rows, columns = (int(n) for n in expression.shape)
    return (rows,) if columns == 1 else (rows, columns)
