"""Singular values of the blocks: robust, balanced, and Frobenius norms in their place (smooth)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.eigenvalues import all_three, largest
from codegen.mechanics.velocity.triangular import TINY, Triangle

_HALF = sympy.Rational(1, 2)


@dataclass(frozen=True)
class Spectrum:
    """Values of a block, in the length unit.

    Attributes:
        D: product of the three.
        values: in descending order; none where only their product is known.
        C: the condition number; wrong where the least value is lost.
        lost: 1 where the least value cannot be told from 0, and 0 elsewhere.
    """

    D: sympy.Expr
    values: tuple[sympy.Expr, ...] = ()
    C: sympy.Expr | None = None
    lost: sympy.Expr = 0


def robust(stages: Stages, triangle: Triangle, limit: sympy.Rational) -> Spectrum:
    """The greatest value from ``T'T``, the least from its inverse, each where it is the greatest.

    Args:
        stages: gets the steps.
        triangle: the block.
        limit: size of a value that is rounding.
    """
    stage = _stager(stages, triangle.name)
    product = _product(stages, triangle)
    first = largest(stages, triangle.name, gram(stages, triangle))
    last = largest(stages, f"inv_{triangle.name}", gram_of_inverse(stages, triangle))
    is_rounding = stage("below", Select(1 / limit**2, last, 1, 0), "1 if the least value is rounding")
    lost = stage("lost", Select(product, TINY, 1, is_rounding), "1 also for a dependent column")
    C = stage("ratio", sympy.sqrt(first * last), "greatest value over least")
    greatest = stage("greatest", sympy.sqrt(first), "greatest value")
    least = stage("least", Select(lost, _HALF, 1 / sympy.sqrt(last), 0), "least value, or 0")
    return Spectrum(product, (greatest, _middle(stages, triangle, product, greatest, least), least), C, lost)


def balanced(stages: Stages, triangle: Triangle, limit: sympy.Rational) -> Spectrum:
    """The two greatest values from ``T'T``, the least from the product of all.

    One closed form instead of two. The middle value, and with it the least, has an error of eps times the square of the
    greatest over the middle one: as good as `robust` where only one value is small.
    """
    stage = _stager(stages, triangle.name)
    product = _product(stages, triangle)
    first, second, _ = all_three(stages, triangle.name, gram(stages, triangle))
    greatest = stage("greatest", sympy.sqrt(first), "greatest value")
    rest = stage("others", product / greatest, "product of the others, not above the square of the middle value")
    square = stage("square_2", Select(second, rest, rest, second), "square of the middle value")
    middle = stage("middle", sympy.sqrt(square), "middle value")
    least = stage("least", Select(middle, TINY, 0, rest / middle), "least value")
    lost = stage("lost", Select(least, limit, 1, 0), "1 if the least value is rounding")
    return Spectrum(product, (greatest, middle, least), stage("ratio", greatest / least, "greatest over least"), lost)


def frobenius(stages: Stages, triangle: Triangle) -> Spectrum:
    """The condition number ``|T| |T^-1| / 3`` in Frobenius norms: smooth everywhere, 1 for equal values only."""
    stage = _stager(stages, triangle.name)
    product = _product(stages, triangle)
    squares = [
        stage(f"norm_{k}", sum(x * x for x in M), "square of a norm")
        for k, M in enumerate((triangle.T, triangle.inverse))
    ]
    norms = [stage(f"root_{k}", sympy.sqrt(square), "Frobenius norm") for k, square in enumerate(squares)]
    C = stage("C", norms[0] * norms[1] / 3, "condition number of Frobenius")
    return Spectrum(product, (), stage("C_or_inf", Select(product, TINY, 1 / product, C), "infinite if singular"))


Stager = Callable[[str, sympy.Expr, str], sympy.Expr]


def _stager(stages: Stages, name: str) -> Stager:
    def stage(what: str, value: sympy.Expr, words: str) -> sympy.Expr:
        return stages.stage(f"{what}_{name}", sympy.Matrix([value]), f"{words} ({name})")[0]

    return stage


def _product(stages: Stages, triangle: Triangle) -> sympy.Expr:
    T = triangle.T
    product = sympy.Abs(stages.stage(f"product_{triangle.name}", sympy.Matrix([T[0, 0] * T[1, 1] * T[2, 2]]), "det")[0])
    return stages.stage(f"D_{triangle.name}", sympy.Matrix([product]), "product of the diagonal of R")[0]


def _middle(
    stages: Stages, triangle: Triangle, product: sympy.Expr, greatest: sympy.Expr, least: sympy.Expr
) -> sympy.Expr:
    """What is left of the product; where the least value is 0, of the second compound: ``sum of minors^2``."""
    stage = _stager(stages, triangle.name)
    T = triangle.T
    pairs = ((0, 1), (0, 2), (1, 2))
    values = [T[a, c] * T[b, d] - T[a, d] * T[b, c] for a, b in pairs for c, d in pairs]
    minors = stages.stage(f"minors_of_{triangle.name}", sympy.Matrix(values), "2 x 2 minors of the block")
    squares = stage("compound", sympy.sqrt(sum(m * m for m in minors)), "product of the two greatest, least 0")
    ends = stage("ends", greatest * least, "greatest times least")
    of_rest = stage("of_rest", squares / greatest, "middle value, if the least is 0")
    return stage("middle", Select(ends, TINY, of_rest, product / ends), "middle value")


def gram(stages: Stages, triangle: Triangle, name: str = "") -> sympy.Matrix:
    """``T' T``, upper triangle."""
    T = triangle.T
    return stages.stage(f"A_{name or triangle.name}", _upper(T.T * T), "R^T R")


def gram_of_inverse(stages: Stages, triangle: Triangle, name: str = "") -> sympy.Matrix:
    """``T^-1 T^-T``, upper triangle."""
    V = triangle.inverse
    return stages.stage(f"W_{name or triangle.name}", _upper(V * V.T), "R^-1 R^-T")


def _upper(A: sympy.Matrix) -> sympy.Matrix:
    return sympy.Matrix(3, 3, lambda i, k: A[i, k] if i <= k else 0)
