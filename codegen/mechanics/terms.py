"""Matrix expressions as sums of terms: a scalar coefficient times a chain of factors.

Nothing is multiplied out: ``A_ij``, ``h_j`` and ``d_ij`` stay what they are.
"""

from __future__ import annotations

from typing import Any

import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.ir.lower import Dot, Tilde

Factors = tuple[Any, ...]
Terms = list[tuple[Any, Factors]]


def unit(index: int) -> Any:
    """Unit vector e_index, [3]."""
    return sympy.ImmutableDenseMatrix(3, 1, [int(k == index) for k in range(3)])


def skew(vector: Any) -> Any:
    """Skew matrix of an explicit vector: S1's tilde."""
    x, y, z = vector
    return sympy.ImmutableDenseMatrix([[0, -z, y], [z, 0, -x], [-y, x, 0]])


def scalar_products(expression: Any) -> list[Dot]:
    """The scalar products in an expression, each once, in order of appearance."""
    if isinstance(expression, Dot):
        return [expression]
    found = (dot for part in expression.args for dot in scalar_products(part))
    return list(dict.fromkeys(found))


def expand(expression: Any) -> Any:
    """Expand a scalar; scalar products of vectors count as symbols, their arguments stay as they are."""
    stand_ins = {dot: sympy.Symbol(f"__dot_{k}") for k, dot in enumerate(scalar_products(expression))}
    if not stand_ins:
        return sympy.expand(expression)
    back = {stand_in: dot for dot, stand_in in stand_ins.items()}
    return sympy.expand(expression.xreplace(stand_ins)).xreplace(back)


def assemble(terms: Terms, shape: tuple[int, int]) -> Any:
    """Write terms as one matrix expression of the given shape."""
    parts = []
    for coefficient, factors in terms:
        chain = factors or (sympy.Identity(3),)
        plain = chain[0] if len(chain) == 1 else sympy.MatMul(*chain)
        parts.append(plain if coefficient == 1 else sympy.MatMul(coefficient, *chain))
    if not parts:
        return sympy.ZeroMatrix(*shape)
    return parts[0] if len(parts) == 1 else sympy.MatAdd(*parts)


def transposed(factor: Any) -> tuple[int, Any]:
    """Transpose one factor; gives the sign that comes with it."""
    if isinstance(factor, Tilde):
        return -1, factor
    if isinstance(factor, sympy.Transpose):
        return 1, factor.arg
    if isinstance(factor, MatrixBase):
        return 1, factor.T
    return 1, sympy.Transpose(factor)


def transposed_chain(factors: Factors) -> tuple[int, Factors]:
    """Transpose a chain of factors; gives the sign that comes with it."""
    sign, chain = 1, []
    for factor in reversed(factors):
        factor_sign, turned = transposed(factor)
        sign *= factor_sign
        chain.append(turned)
    return sign, tuple(chain)
