"""The same blocks evaluated with vectors first: the paper's own formulas, programmed with care.

Input: a block. Output: the same block, regrouped by three identities that cost nothing, and a `Method` that
multiplies chains from their vector. The identities: a scalar constraint is linear in its first vector, so
lambda scales that vector once instead of every block; ``A^T v~ A = (A^T v)~`` for a rotation A; ``a~ + b~ =
(a + b)~``.
"""

from __future__ import annotations

from collections.abc import Sequence

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
    product,
    total,
)
from flopcount.rules.identity import factors_of
from flopcount.rules.ledger import Method
from flopcount.rules.patterns import Pattern


def vectors_first(expression: Expr, carrier: str | None) -> Expr:
    """Regroup a block.

    Args:
        expression: the block as the paper writes it.
        carrier: the vector in which the constraint is linear, or None.
    """
    spread = _spread(expression)
    absorbed = spread if carrier is None else _absorb(spread, Vec(carrier))
    return _gather(absorbed)


def from_the_vector(chain: Sequence[Pattern]) -> int:
    """From right to left when the chain ends in a column, else from left to right."""
    return len(chain) - 2 if chain[-1].is_column else 0


VECTORS = Method("vectors", from_the_vector, vectors_first, opens_brackets=False, keeps_scaled_vectors=True)
"""Vectors first."""


def _spread(expression: Expr) -> Expr:
    """Multiply a sum or a multiple of matrices, standing first in a chain, with the rest of the chain."""
    match expression:
        case Negate(operand):
            return Negate(_spread(operand))
        case Product((Negate(operand), *rest)):
            return Negate(_spread(Product((operand, *rest))))
        case Product((Scale(factor, operand), *rest)):
            return Scale(factor, _spread(Product((operand, *rest))))
        case Product((Sum(terms), *rest)):
            return Sum(tuple(_spread(Product((term, *rest))) for term in terms))
        case _:
            return expression


def _absorb(expression: Expr, carrier: Vec) -> Expr:
    """Move a multiplier from a block to the vector."""
    match expression:
        case Negate(operand):
            return Negate(_absorb(operand, carrier))
        case Sum(terms):
            return Sum(tuple(_absorb(term, carrier) for term in terms))
        case Scale(Scalar() as factor, operand):
            return _replace(operand, carrier, Scale(factor, carrier))
        case _:
            return expression


def _replace(expression: Expr, old: Vec, new: Expr) -> Expr:
    match expression:
        case Vec():
            return new if expression == old else expression
        case Skew(vector):
            return Skew(_replace(vector, old, new))
        case Transpose(operand):
            return Transpose(_replace(operand, old, new))
        case Product(factors):
            return Product(tuple(_replace(factor, old, new) for factor in factors))
        case _:
            return expression


def _gather(expression: Expr) -> Expr:
    """Write ``A^T v~ A`` as ``(A^T v)~`` and a sum of skew matrices as one."""
    match expression:
        case Negate(operand):
            return Negate(_gather(operand))
        case Sum(terms):
            return _gather_sum(tuple(_gather(term) for term in terms))
        case Product():
            return product(*_turn([_gather(factor) for factor in factors_of(expression)]))
        case _:
            return expression


def _gather_sum(terms: tuple[Expr, ...]) -> Expr:
    vectors = [term.vector for term in terms if isinstance(term, Skew)]
    return Skew(total(vectors)) if len(vectors) == len(terms) else Sum(terms)


def _turn(factors: list[Expr]) -> list[Expr]:
    for at in range(len(factors) - 2):
        match factors[at : at + 3]:
            case [Transpose(Mat() as before), Skew(vector), Mat() as after] if before == after:
                turned = Skew(Product((Transpose(before), vector)))
                return [*factors[:at], turned, *_turn(factors[at + 3 :])]
    return factors
