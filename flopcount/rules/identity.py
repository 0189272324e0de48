"""When two expressions are equal up to sign and transposition, which is free (R0, R3).

Input: expressions. Output: hashable keys. Transposition is pushed to the leaves and signs are pulled out;
products are flattened, so that the key of a chain does not depend on its grouping. No other identity of
algebra is used.
"""

from __future__ import annotations

from typing import TypeAlias

from flopcount.rules.expressions import (
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

Key: TypeAlias = str
"""Equal for two expressions that are equal up to sign."""


def key(expression: Expr, *, transposed: bool = False) -> Key:
    """Name an expression, or its transpose, up to sign."""
    return _normal(expression, transposed)[1]


def factors_of(expression: Expr) -> tuple[Expr, ...]:
    """Flatten a chain, pulling transposition inwards and dropping signs of the chain as a whole."""
    match expression:
        case Negate(operand):
            return factors_of(operand)
        case Product(factors):
            return tuple(inner for factor in factors for inner in _nested(factor))
        case Transpose(Product(factors)):
            return tuple(inner for factor in reversed(factors) for inner in _nested(Transpose(factor)))
        case _:
            return (expression,)


def _nested(factor: Expr) -> tuple[Expr, ...]:
    inner = factors_of(factor)
    return inner if len(inner) > 1 else (_unsigned(factor),)


def _unsigned(expression: Expr) -> Expr:
    return _unsigned(expression.operand) if isinstance(expression, Negate) else expression


def _normal(expression: Expr, transposed: bool) -> tuple[int, Key]:
    match expression:
        case Scalar(name):
            return 1, name
        case Vec(name) | Mat(name):
            return 1, f"{name}'" if transposed else name
        case Skew(vector):
            sign, inner = _normal(vector, False)
            return (-sign if transposed else sign), f"skew[{inner}]"
        case Transpose(operand):
            return _normal(operand, not transposed)
        case Negate(operand):
            sign, inner = _normal(operand, transposed)
            return -sign, inner
        case Scale(factor, operand):
            sign_of_factor, scalar = _normal(factor, False)
            sign, inner = _normal(operand, transposed)
            return sign * sign_of_factor, f"{{{scalar}}}[{inner}]"
        case Product():
            return _normal_product(expression, transposed)
        case Sum(terms):
            return _normal_sum(terms, transposed)


def _normal_product(expression: Product, transposed: bool) -> tuple[int, Key]:
    sign, keys = 1, []
    for factor in expression.factors:
        sign_of_factor, inner = _normal(factor, transposed)
        sign *= sign_of_factor
        keys.append(inner)
    return sign, "*".join(reversed(keys) if transposed else keys)


def _normal_sum(terms: tuple[Expr, ...], transposed: bool) -> tuple[int, Key]:
    normals = [_normal(term, transposed) for term in terms]
    first = normals[0][0]
    inner = "".join(f"{'+' if sign == first else '-'}{term}" for sign, term in normals)
    return first, f"({inner})"
