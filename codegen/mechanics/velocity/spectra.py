"""Singular values of the blocks: robust, balanced, and Frobenius norms in their place (smooth)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.eigenvalues import all_three, largest
from codegen.mechanics.velocity.triangular import TINY, Triangle


@dataclass(frozen=True)
class Spectrum:
    """Values of a block, in the length unit.

    Attributes:
        D: product of the three.
        values: in descending order; none where only their product is known.
        C: the condition number, or before singular poses are judged D times it, which is not 0.
        lost: 1 where the least value cannot be told from 0, and 0 elsewhere.
    """

    D: sympy.Expr
    values: tuple[sympy.Expr, ...] = ()
    C: sympy.Expr | None = None
    lost: sympy.Expr = 0


def robust(stages: Stages, triangle: Triangle, limit: sympy.Rational) -> Spectrum:
    """The greatest value from ``T'T``, the product of the two greatest from the cofactors of T, the least from D.

    Each is the greatest of its matrix, so that it has an error of a few eps of it; nothing is divided by a value that
    may be small but for the least value and C.

    Args:
        stages: gets the steps.
        triangle: the block.
        limit: size of a value that is rounding.
    """
    stage = _stager(stages, triangle.name)
    product = _product(stages, triangle)
    first = largest(stages, triangle.name, gram(stages, triangle))
    pair = largest(stages, f"pair_{triangle.name}", _gram_of_cofactors(stages, triangle))
    bound = stage("bound", limit**2 * pair + limit**6, "D^2 where the least value is rounding, or all are")
    lost = stage("lost", Select(product * product, bound, 1, 0), "1 if the least value is rounding")
    C = stage("C_D", sympy.sqrt(first * pair + TINY), "greatest value over least, times D")
    greatest = stage("greatest", sympy.sqrt(first), "greatest value")
    both = stage("both", sympy.sqrt(pair), "product of the two greatest")
    quotient = stage("quotient", both / (greatest + TINY), "middle value")
    middle = stage("middle", Select(quotient, limit, 0, quotient), "0 if it is rounding")
    return Spectrum(product, (greatest, middle, stage("least", product / both, "least value")), C, lost)


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
    C = stage("C_D", first * middle + TINY, "greatest value over least, times D")
    return Spectrum(product, (greatest, middle, least), C, lost)


def frobenius(stages: Stages, triangle: Triangle) -> Spectrum:
    """The condition number ``|T| |T^-1| / 3`` in Frobenius norms: smooth everywhere, 1 for equal values only."""
    stage = _stager(stages, triangle.name)
    product = _product(stages, triangle)
    squares = [
        stage(f"norm_{k}", sum(x * x for x in M), "square of a norm")
        for k, M in enumerate((triangle.T, _cofactors(stages, triangle)))
    ]
    norms = stage("norms", sympy.sqrt(squares[0] * squares[1] + TINY), "norms of the block and of its cofactors")
    return Spectrum(product, (), stage("C", norms / (3 * product), "condition number of Frobenius, or infinite"))


Stager = Callable[[str, sympy.Expr, str], sympy.Expr]


def _stager(stages: Stages, name: str) -> Stager:
    def stage(what: str, value: sympy.Expr, words: str) -> sympy.Expr:
        return stages.stage(f"{what}_{name}", sympy.Matrix([value]), f"{words} ({name})")[0]

    return stage


def _product(stages: Stages, triangle: Triangle) -> sympy.Expr:
    T = triangle.T
    product = sympy.Abs(stages.stage(f"product_{triangle.name}", sympy.Matrix([T[0, 0] * T[1, 1] * T[2, 2]]), "det")[0])
    return stages.stage(f"D_{triangle.name}", sympy.Matrix([product]), "product of the diagonal of R")[0]


def _cofactors(stages: Stages, triangle: Triangle) -> sympy.Matrix:
    """The adjugate of T but for signs that change neither norms nor eigenvalues of ``K K'``."""
    (a, b, c), (_, d, e), (_, _, f) = triangle.T.tolist()
    K = sympy.Matrix([[d * f, b * f, b * e - c * d], [0, a * f, a * e], [0, 0, a * d]])
    return stages.stage(f"K_{triangle.name}", K, "cofactors of the block, without signs")


def _gram_of_cofactors(stages: Stages, triangle: Triangle) -> sympy.Matrix:
    """``K K'``, upper triangle."""
    K = _cofactors(stages, triangle)
    return stages.stage(f"KK_{triangle.name}", _upper(K * K.T), "K K^T")


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
