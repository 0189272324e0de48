"""The blocks as Gram matrices (S3 Eqs. 13, 48 to 50): fast, and the paper's literal form.

Both lose eps kappa^2, since N_v is a difference. `fast` takes the robust closed form of the eigenvalues; the literal
form takes the textbook's arc cosine, and is there to be compared with.
"""

from __future__ import annotations

from collections.abc import Callable

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.eigenvalues import all_three
from codegen.mechanics.velocity.geometry import Legs
from codegen.mechanics.velocity.spectra import Spectrum

Eigenvalues = Callable[[Stages, str, sympy.Matrix], tuple[sympy.Expr, ...]]


def gram_blocks(stages: Stages, legs: Legs) -> dict[str, sympy.Matrix]:
    """The matrices N_v (sigma), J1'J1 (beta), N_w (alpha) and J2'J2 (gamma), [3, 3] each."""
    J1, J2 = legs.J1, legs.J2
    beta = _symmetric(stages, "J11", J1.T * J1, "J1' J1")
    gamma = _symmetric(stages, "J22", J2.T * J2, "J2' J2")
    mixed = stages.stage("J12", J1.T * J2, "J1' J2")
    sigma = _schur(stages, "v", beta, mixed, gamma)
    alpha = _schur(stages, "w", gamma, mixed.T, beta)
    return {"sigma": sigma, "beta": beta, "alpha": alpha, "gamma": gamma}


def gram_spectra(stages: Stages, legs: Legs, eigenvalues: Eigenvalues) -> dict[str, Spectrum]:
    """The values of the four blocks as roots of eigenvalues.

    Args:
        stages: gets the steps.
        legs: with J1 and J2.
        eigenvalues: `all_three` or `textbook`.
    """
    spectra = {}
    for name, block in gram_blocks(stages, legs).items():
        found = sympy.Matrix([sympy.sqrt(value) for value in eigenvalues(stages, name, block)])
        values = tuple(stages.stage(f"values_{name}", found, f"values {name}"))
        D = stages.stage(f"D_{name}", sympy.Matrix([values[0] * values[1] * values[2]]), f"product of {name}")[0]
        C = stages.stage(f"C_{name}", sympy.Matrix([values[0] / values[2]]), f"greatest over least {name}")[0]
        spectra[name] = Spectrum(D, values, C)
    return spectra


def not_negative(stages: Stages, name: str, A: sympy.Matrix) -> tuple[sympy.Expr, ...]:
    """The eigenvalues by the robust closed form, those that rounding has brought below 0 taken for 0."""
    values = sympy.Matrix([Select(value, 0, 0, value) for value in all_three(stages, name, A)])
    return tuple(stages.stage(f"clipped_{name}", values, "not below 0"))


def textbook(stages: Stages, name: str, A: sympy.Matrix) -> tuple[sympy.Expr, ...]:
    """The eigenvalues by the arc cosine of half the determinant of the scaled deviator."""

    def stage(what: str, *values: sympy.Expr, words: str) -> list[sympy.Expr]:
        return list(stages.stage(f"{what}_{name}", sympy.Matrix(list(values)), words))

    (trace,) = stage("trace", A[0, 0] + A[1, 1] + A[2, 2], words="trace")
    (q,) = stage("q", trace / 3, words="mean")
    b = stage("b", *(A[k, k] - q for k in range(3)), words="diagonal of the deviator")
    diagonal, off = stage(
        "squares", sum(x**2 for x in b), A[0, 1] ** 2 + A[0, 2] ** 2 + A[1, 2] ** 2, words="squares of its entries"
    )
    (square,) = stage("p2", diagonal + 2 * off, words="square of its norm")
    (p,) = stage("p", sympy.sqrt(square / 6), words="radius")
    x, y, z, u, v, w = stage("B", *(t / p for t in (*b, A[0, 1], A[0, 2], A[1, 2])), words="deviator over p")
    cofactors = stage("cofactors", y * z - w * w, u * z - w * v, u * w - y * v, words="for the determinant")
    (half,) = stage("half", x * cofactors[0] - u * cofactors[1] + v * cofactors[2], words="det B")
    (r,) = stage("r", half / 2, words="cos 3 phi")
    (r,) = stage("above", Select(r, -1, -1, r), words="not below -1")
    (r,) = stage("within", Select(1, r, 1, r), words="nor above 1")
    (phi,) = stage("phi", sympy.atan2(sympy.sqrt(1 - r * r), r) / 3, words="acos(r) / 3")
    first, last = stage(
        "ends", 2 * p * sympy.cos(phi), 2 * p * sympy.cos(phi + 2 * sympy.pi / 3), words="less the mean"
    )
    first, last = stage("outer", q + first, q + last, words="greatest and least eigenvalue")
    (middle,) = stage("middle_eig", trace - first - last, words="middle eigenvalue")
    return first, middle, last


def _schur(stages: Stages, name: str, first: sympy.Matrix, mixed: sympy.Matrix, second: sympy.Matrix) -> sympy.Matrix:
    """``first - mixed second^-1 mixed'``."""
    cofactors = _symmetric(stages, f"cofactors_{name}", second.adjugate(), "cofactors of the other block")
    determinant = sum(second[0, k] * cofactors[0, k] for k in range(3))
    scale = stages.stage(f"over_det_{name}", sympy.Matrix([1 / determinant]), "1 / its determinant")[0]
    inverse = _symmetric(stages, f"inverse_{name}", cofactors * scale, "its inverse")
    half = stages.stage(f"K_{name}", mixed * inverse, "mixed block times the inverse")
    taken = _symmetric(stages, f"taken_{name}", half * mixed.T, "what the projection takes off")
    return _symmetric(stages, f"N_{name}", first - taken, f"N_{name}")


def _symmetric(stages: Stages, name: str, value: sympy.Matrix, words: str) -> sympy.Matrix:
    """Name the upper triangle; the lower one is the same values."""
    places = [(i, k) for k in range(3) for i in range(k + 1)]
    found = dict(zip(places, stages.stage(name, sympy.Matrix([value[place] for place in places]), words), strict=True))
    return sympy.Matrix(3, 3, lambda i, k: found[min(i, k), max(i, k)])
