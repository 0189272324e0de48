"""Other ways to evaluate the same outputs: which is cheapest depends on what else is asked for.

Each alternative rewrites blocks by an identity. The pipeline lowers all of them for exactly the requested outputs and
keeps the one with the fewest operations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import sympy

from codegen.ir.lower import Dot, SymbolicOutput, Tilde
from codegen.mechanics.algebra import Algebra
from codegen.mechanics.frames import A_i, A_ij, A_j
from codegen.mechanics.terms import Factors, Terms, assemble, scalar_products

Outputs = tuple[SymbolicOutput, ...]


def alternatives(outputs: Outputs, algebra: Algebra) -> list[Outputs]:
    """Give the outputs as they stand and in every other form, each form once."""
    forms = [outputs]
    if any(output.name == "phi_q" for output in outputs):
        forms.append(tuple(turned(output, algebra) if output.name == "phi_q" else output for output in outputs))
    if all(output.name != "phi_q_t_lambda_q" for output in outputs):
        forms += [tuple(from_world(output, algebra) for output in form) for form in forms]
    return list(dict.fromkeys(forms))


def turned(output: SymbolicOutput, algebra: Algebra) -> SymbolicOutput:
    """Write ``b~ R^T a`` as ``-R^T a~ R b``: the gradient on body j is that on body i, seen from body j."""
    return _mapped(output, lambda terms: [_turned(c, chain, algebra) for c, chain in terms], algebra)


def _turned(coefficient: Any, chain: Factors, algebra: Algebra) -> tuple[Any, Factors]:
    if len(chain) < 3 or not isinstance(chain[0], Tilde) or not isinstance(chain[1], sympy.Transpose):
        return coefficient, chain
    rotation = chain[1].arg
    if rotation not in algebra.rotations:
        return coefficient, chain
    moved = assemble([(sympy.S.One, chain[2:])], (3, 1))
    vector = algebra.terms(chain[0].vector)
    if len(vector) != 1:
        return coefficient, chain
    return -coefficient * vector[0][0], (chain[1], Tilde(moved), rotation, *vector[0][1])


def from_world(output: SymbolicOutput, algebra: Algebra) -> SymbolicOutput:
    """Write ``A_ij`` as the product ``A_i^T A_j``: vectors go through world axes and the matrix is not formed."""
    relative = {A_ij: sympy.MatMul(sympy.Transpose(A_i), A_j)}
    plain = replace(algebra, names={})
    blocks = tuple(replace(b, expression=_unfolded(b.expression, relative, plain)) for b in output.blocks)
    return replace(output, blocks=blocks)


def _unfolded(expression: Any, relative: dict[Any, Any], plain: Algebra) -> Any:
    replaced = expression.xreplace(relative)
    if isinstance(replaced, sympy.Transpose):
        return sympy.Transpose(plain.normal(replaced.arg))
    if isinstance(replaced, sympy.matrices.expressions.matexpr.MatrixExpr):
        return plain.normal(replaced)
    dots = {dot: Dot(*(plain.normal(side) for side in dot.args)) for dot in scalar_products(replaced)}
    return replaced.xreplace(dots)


def _mapped(output: SymbolicOutput, rewrite: Callable[[Terms], Terms], algebra: Algebra) -> SymbolicOutput:
    def mapped(expression: Any) -> Any:
        if isinstance(expression, sympy.Transpose):
            return sympy.Transpose(mapped(expression.arg))
        if expression.shape[1] > 1:
            return expression
        return assemble(rewrite(algebra.terms(expression)), expression.shape)

    blocks = tuple(
        replace(block, expression=mapped(block.expression))
        if isinstance(block.expression, sympy.matrices.expressions.matexpr.MatrixExpr)
        else block
        for block in output.blocks
    )
    return replace(output, blocks=blocks)
