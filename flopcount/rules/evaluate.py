"""The value of an expression: the proof that what is counted is the right formula.

Input: an expression and the values of its names. Output: a numpy array. It shares nothing with the counting
    but the data.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from flopcount.rules.expressions import (
    IDENTITY,
    Expr,
    Mat,
    Negate,
    Product,
    Scalar,
    Scale,
    Skew,
    Sum,
    Transpose,
    Vec,
)

Array: TypeAlias = NDArray[np.float64]


def evaluate(expression: Expr, values: Mapping[str, Array]) -> Array:
    """Evaluate an expression.

    Args:
        expression: any expression of this package.
        values: name -> value; scalars have shape (1, 1), vectors (3, 1), matrices (3, 3).

    Returns:
        An array of two dimensions: (1, 1), (3, 1), (1, 3) or (3, 3).

    Raises:
        KeyError: a name has no value.
    """
    match expression:
        case Mat(name) if expression == IDENTITY:
            return np.eye(3)
        case Scalar(name) | Vec(name) | Mat(name):
            return values[name]
        case Skew(vector):
            return skew(evaluate(vector, values))
        case Transpose(operand):
            return evaluate(operand, values).T
        case Negate(operand):
            return -evaluate(operand, values)
        case Scale(factor, operand):
            scale = float(evaluate(factor, values)[0, 0])
            return scale * evaluate(operand, values)
        case Product(factors):
            result = evaluate(factors[0], values)
            for factor in factors[1:]:
                result = result @ evaluate(factor, values)
            return result
        case Sum(terms):
            result = evaluate(terms[0], values)
            for term in terms[1:]:
                result = result + evaluate(term, values)
            return result


def skew(vector: Array) -> Array:
    """The skew matrix of a column: ``skew(a) @ b = a x b``."""
    x, y, z = vector[:, 0]
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
