"""The four products alone: the cheapest way to volumes of the ellipsoids, and right to eps kappa.

Of every triangular factor only the diagonal is needed: the last two steps of the factor of [J2 J1] are one 2 x 2
determinant, the factor of J1 goes on from there, and ``D_alpha = D_sigma D_gamma / D_beta``.
"""

from __future__ import annotations

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.blocks import FIRST, SECOND
from codegen.mechanics.velocity.geometry import Legs
from codegen.mechanics.velocity.spectra import Spectrum
from codegen.mechanics.velocity.triangular import TINY, Reflections


def volumes(stages: Stages, legs: Legs, limits: tuple[sympy.Rational, sympy.Rational]) -> dict[str, Spectrum]:
    """The products D of sigma, beta, alpha and gamma; 0 where rounding is all that is left.

    Args:
        stages: gets the steps.
        legs: with J1 and J2.
        limits: sizes of a remainder of J1 and of J2 that are rounding.
    """
    columns = [legs.J2[:, k] for k in range(3)] + [legs.J1[:, k] for k in range(3)]
    first = Reflections(stages, "R", columns, [limits[1]] * 3 + [limits[0]] * 3, False)
    for k in range(4):
        first.eliminate(k, k, range(k, 6))
    corner = first.block((4, 5), (4, 5))
    again = Reflections(stages, "S", [first.columns[k] for k in SECOND], [limits[0]] * 3, False)
    for k in range(2):
        again.eliminate(k, k, range(k, 6))
    last = sum(x**2 for x in again.columns[2][2:, 0])
    D_beta = _size(stages, "beta", _diagonal(again, range(2)) * sympy.sqrt(last), limits[0])
    D_gamma = _size(stages, "gamma", _diagonal(first, FIRST), limits[1])
    rest = stages.stage("corner", sympy.Matrix([corner.det()]), "determinant of the last two rows and columns")[0]
    D_sigma = _size(stages, "sigma", first.columns[3][3] * rest, limits[0])
    quotient = Select(D_beta, TINY, 0, D_sigma * D_gamma / D_beta)
    D_alpha = stages.stage("D_alpha", sympy.Matrix([quotient]), "|det J| / D_beta")[0]
    return {
        name: Spectrum(D)
        for name, D in zip(("sigma", "beta", "alpha", "gamma"), (D_sigma, D_beta, D_alpha, D_gamma), strict=True)
    }


def _diagonal(factor: Reflections, places: range | tuple[int, ...]) -> sympy.Expr:
    return sympy.prod([factor.columns[k][k] for k in places])


def _size(stages: Stages, name: str, product: sympy.Expr, limit: sympy.Rational) -> sympy.Expr:
    value = stages.stage(f"product_{name}", sympy.Matrix([product]), f"determinant of the block of {name}")[0]
    size = stages.stage(f"size_{name}", sympy.Matrix([sympy.Abs(value)]), "its size")[0]
    return stages.stage(f"D_{name}", sympy.Matrix([Select(size, limit, 0, size)]), "0 if it is rounding")[0]
