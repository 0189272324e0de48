"""The four products alone: the cheapest way to volumes of the ellipsoids.

Of every factor only the diagonal is needed. Three reflections of [J1 J2] give D_beta and leave J2 in the complement of
J1, three by three, of which D_alpha is the determinant; J2 by itself gives D_gamma, and ``D_sigma = D_beta D_alpha /
D_gamma``. The determinant is that of alpha, and not of sigma, because alpha does not depend on the reference point: a
point far away makes two values of sigma small.
"""

from __future__ import annotations

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.geometry import Legs
from codegen.mechanics.velocity.spectra import Spectrum
from codegen.mechanics.velocity.triangular import TINY, Reflections


def volumes(stages: Stages, legs: Legs, limits: tuple[sympy.Rational, sympy.Rational]) -> dict[str, Spectrum]:
    """The products D of sigma, beta, alpha and gamma; 0 where rounding is all that is left.

    Right to eps kappa, but to eps kappa^2 where two values of alpha are small along no two axes of the base.

    Args:
        stages: gets the steps.
        legs: with J1 and J2.
        limits: sizes of a remainder of J1 and of J2 that are rounding.
    """
    J1, J2 = ([J[:, k] for k in range(3)] for J in (legs.J1, legs.J2))
    of_J1, of_J2 = limits
    first = Reflections(stages, "R", J1 + J2, [of_J1] * 3 + [of_J2] * 3, False)
    for k in range(3):
        first.eliminate(k, k, range(k, 6))
    rest = first.block((3, 4, 5), (3, 4, 5))
    second = Reflections(stages, "S", J2, [of_J2] * 3, False)
    second.eliminate(0, 0, range(6))
    area = _area(stages, second.columns[1][1:, 0], second.columns[2][1:, 0])
    D_beta = _size(stages, "beta", sympy.prod([first.columns[k][k] for k in range(3)]), of_J1)
    D_alpha = _size(stages, "alpha", _cofactors(stages, rest), of_J2)
    D_gamma = _size(stages, "gamma", second.columns[0][0] * area, of_J2)
    quotient = Select(D_gamma, TINY, 0, D_beta * D_alpha / D_gamma)
    D_sigma = stages.stage("D_sigma", sympy.Matrix([quotient]), "|det J| / D_gamma")[0]
    return {
        name: Spectrum(D)
        for name, D in zip(("sigma", "beta", "alpha", "gamma"), (D_sigma, D_beta, D_alpha, D_gamma), strict=True)
    }


def _area(stages: Stages, b: sympy.Matrix, c: sympy.Matrix) -> sympy.Expr:
    """Area of the parallelogram of two vectors, by what is left of the second without the first."""
    bb, bc = stages.stage("products", sympy.Matrix([b.dot(b), b.dot(c)]), "b'b, b'c")
    share = stages.stage("share", sympy.Matrix([bc / (bb + TINY)]), "part of c along b")[0]
    across = stages.stage("across", c - share * b, "the rest")
    return stages.stage("area", sympy.Matrix([sympy.sqrt(bb * across.dot(across))]), "area of b and c")[0]


def _cofactors(stages: Stages, A: sympy.Matrix) -> sympy.Expr:
    """The determinant of a 3 x 3 matrix, up to its sign."""
    normal = stages.stage("normal", A[:, 1].cross(A[:, 2]), "cofactors of the first column")
    return A[:, 0].dot(normal)


def _size(stages: Stages, name: str, product: sympy.Expr, limit: sympy.Rational) -> sympy.Expr:
    value = stages.stage(f"product_{name}", sympy.Matrix([product]), f"determinant of the block of {name}")[0]
    size = stages.stage(f"size_{name}", sympy.Matrix([sympy.Abs(value)]), "its size")[0]
    return stages.stage(f"D_{name}", sympy.Matrix([Select(size, limit, 0, size)]), "0 if it is rounding")[0]
