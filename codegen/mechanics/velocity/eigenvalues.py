"""Eigenvalues of a symmetric 3 x 3 matrix in closed form, without functions of a library.

With the deviator ``B = A - (tr A / 3) I`` and ``p = |B| / sqrt 6`` they are ``tr A / 3 + 2 p cos(phi + 2 pi k / 3)``.
The textbook takes phi from an arc cosine, which loses half of the digits where two values are equal. Here

- the diagonal of B comes from differences of the diagonal of A,
- ``cos 3 phi`` and ``sin 3 phi`` both are computed, the latter from the discriminant as a sum of squares: the Gram
  determinant of I, B and B^2 by its minors,
- a third of the angle is a polynomial in both that is right to 1e-3, and one step from the exact remainder ``sin(3 phi
  - 3 phi_0)``, which is right to 1e-19.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.mechanics.velocity.triangular import TINY

_TANGENT = ("0.28867514", "-0.28791147", "-0.02763162", "0.17398898", "0.00936073", "-0.06836798", "-0.00247091")
"""tan(phi / 2) for phi in [0, pi / 3], by 1, c, s, c s, s^2, c s^2, s^3 of c = cos 3 phi, s = sin 3 phi: a fit of
least greatest error, 8e-4. Any other would do: what is missing comes in the step after it."""

_TERMS = 3
"""Terms of the series in the remainder d, |d| < 5e-3: what is left out is below 1e-18."""


@dataclass(frozen=True)
class Angle:
    """Mean, radius and angle of the eigenvalues of a symmetric matrix, by name of a stage.

    Attributes:
        mean: a third of the trace.
        p: radius, half of the greatest distance of an eigenvalue from the mean.
        cosine: of phi in [0, pi / 3].
        sine: of phi.
        triple: cosine of 3 phi: its sign says which end of the spectrum is well apart.
        deviator: [3, 3] over p.
    """

    mean: sympy.Expr
    p: sympy.Expr
    cosine: sympy.Expr
    sine: sympy.Expr
    triple: sympy.Expr
    deviator: sympy.Matrix


def angle(stages: Stages, name: str, A: sympy.Matrix) -> Angle:
    """Derive mean, radius and angle of a symmetric matrix.

    Args:
        stages: gets the steps.
        name: of the matrix, for names of stages.
        A: [3, 3] symbols; the upper triangle is read.
    """

    def stage(what: str, *values: sympy.Expr, words: str) -> list[sympy.Expr]:
        return list(stages.stage(f"{what}_{name}", sympy.Matrix(list(values)), words))

    d, *g = stage("g", A[0, 0] - A[1, 1], A[1, 1] - A[2, 2], A[0, 0] - A[2, 2], words="differences of the diagonal")
    trace, third = stage("trace", A[0, 0] + A[1, 1] + A[2, 2], g[0] + g[1], words="trace; minus three times b_33")
    mean, last = stage("mean", trace / 3, -third / 3, words="mean of the eigenvalues; b_33")
    off = [A[0, 1], A[0, 2], A[1, 2]]
    squares = stage(
        "squares",
        d * d,
        last * last,
        sum(entry * entry for entry in off),
        words="squares of differences, b_33, entries",
    )
    (square,) = stage("square", squares[0] / 12 + squares[1] / 4 + squares[2] / 3, words="p^2")
    (p,) = stage("p", sympy.sqrt(square), words="|B| / sqrt 6")
    (scale,) = stage("scale", Select(p, TINY, 0, 1 / p), words="1 / p, 0 for a multiple of the identity")
    d, z, u, v, w = stage(
        "B", *(value * scale for value in (d, last, *off)), words="over p: b_11 - b_22, b_33, entries 12, 13, 23"
    )
    x, minus_y = stage("xy", (d - z) / 2, (d + z) / 2, words="b_11, -b_22")
    c, s, ss = _threefold(stage, (x, minus_y, z, u, v, w), d)
    cosine, sine = _third(stage, c, s, ss)
    return Angle(mean, p, cosine, sine, c, sympy.Matrix([[x, u, v], [u, -minus_y, w], [v, w, z]]))


Stage = Callable[..., list[sympy.Expr]]


def largest(stages: Stages, name: str, A: sympy.Matrix) -> sympy.Expr:
    """The largest eigenvalue, with an error of a few eps of it."""
    found = angle(stages, name, A)
    (product,) = stages.stage(f"pc_{name}", sympy.Matrix([found.p * found.cosine]), "p cos phi")
    return stages.stage(f"lambda_{name}", sympy.Matrix([found.mean + 2 * product]), "largest eigenvalue")[0]


def all_three(stages: Stages, name: str, A: sympy.Matrix) -> tuple[sympy.Expr, ...]:
    """The eigenvalues in descending order, each with an error of a few eps of the largest."""
    found = angle(stages, name, A)
    return three_of(stages, name, found)


def three_of(stages: Stages, name: str, found: Angle) -> tuple[sympy.Expr, ...]:
    """The eigenvalues of mean, radius and angle, in descending order."""
    root = stages.stage(f"root_{name}", sympy.Matrix([_decimal("1.7320508075688772935") * found.sine]), "sqrt3 sin phi")
    parts = stages.stage(
        f"parts_{name}", sympy.Matrix([found.cosine - root[0], found.cosine + root[0]]), "cos phi -+ sqrt3 sin phi"
    )
    terms = stages.stage(
        f"terms_{name}",
        sympy.Matrix([found.p * found.cosine, found.p * parts[0], found.p * parts[1]]),
        "p times cos phi and cos phi -+ sqrt3 sin phi",
    )
    values = sympy.Matrix([found.mean + 2 * terms[0], found.mean - terms[1], found.mean - terms[2]])
    return tuple(stages.stage(f"lambda_{name}", values, "eigenvalues"))


def _threefold(stage: Stage, B: tuple[sympy.Expr, ...], d: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr, sympy.Expr]:
    """Cosine, sine and its square, of 3 phi, of the deviator with p = 1; ``B^2 = adj B + 3 I``."""
    x, minus_y, z, u, v, w = B
    C = stage("BB", v * w - u * z, u * w + v * minus_y, u * v - w * x, words="entries 12, 13, 23 of B^2")
    (minus,) = stage("cofactor", x * minus_y + u * u, words="minus the cofactor of B_33")
    e, f = stage("e", (v * v - w * w) - d * z, 1 - minus, words="C_11 - C_22; deviator of C_33")
    (square,) = stage("sine_2", _discriminant(stage, (d, z, u, v, w), (e, f, *C)), words="sin^2(3 phi)")
    (determinant,) = stage("det", v * C[1] + w * C[2] - z * minus, words="det B")
    c, s = stage("cs", determinant / 2, sympy.sqrt(square), words="cos 3 phi, sin 3 phi")
    return c, s, square


def _discriminant(stage: Stage, b: tuple[sympy.Expr, ...], c: tuple[sympy.Expr, ...]) -> sympy.Expr:
    """The Gram determinant of I, B and C = B^2 over 108, by the 2 x 2 minors of both vectors (d, z, u, v, w).

    With the minors ``[ik]`` it is ``[dz]^2 / 48 + ([du]^2 + [dv]^2 + [dw]^2) / 36 + ([zu]^2 + [zv]^2 + [zw]^2) / 12 +
    ([uv]^2 + [uw]^2 + [vw]^2) / 9``. As B and B^2 commute, ``[vw] = -[du]``, ``3 [zv] = [dv] + 2 [uw]`` and ``3 [zw] =
    2 [uv] - [dw]``: three minors less. What is left is positive for any values of the others.
    """
    pairs = ((0, 1), (0, 2), (1, 2), (0, 3), (2, 4), (0, 4), (2, 3))
    minors = stage("minors", *(b[i] * c[k] - b[k] * c[i] for i, k in pairs), words="minors of B and B^2")
    dz, du, zu, dv, uw, dw, uv = minors
    sums = stage("tangled", dv + uw, dw - uv, words="[dv] + [uw], [dw] - [uv]")
    parts = stage("forms", dv * sums[0] + dw * sums[1], uv * uv + uw * uw, words="parts of two positive forms")
    return (
        dz * dz / 48 + du * du * sympy.Rational(5, 36) + zu * zu / 12 + parts[0] / 27 + parts[1] * sympy.Rational(4, 27)
    )


def _third(stage: Stage, c: sympy.Expr, s: sympy.Expr, ss: sympy.Expr) -> tuple[sympy.Expr, sympy.Expr]:
    """Cosine and sine of a third of an angle in [0, pi]."""
    (cs,) = stage("powers", c * s, words="cos 3 phi sin 3 phi")
    k = [_decimal(text) for text in _TANGENT]
    inner = stage("fit", k[4] + k[5] * c + k[6] * s, k[0] + k[1] * c + k[2] * s + k[3] * cs, words="parts of t")
    (t,) = stage("t", inner[1] + ss * inner[0], words="tan(phi_0 / 2), right to 8e-4")
    (tt,) = stage("tt", t * t, words="t^2")
    (share,) = stage("share", 2 / (1 + tt), words="2 / (1 + t^2)")
    c_0, s_0 = stage("first", share - 1, share * t, words="cos phi_0, sin phi_0")
    double = stage("double", 2 * s_0 * s_0, 2 * c_0 * s_0, words="1 - cos 2 phi_0, sin 2 phi_0")
    triple = stage(
        "triple", c_0 * (1 - double[0]) - s_0 * double[1], s_0 * (1 - double[0]) + c_0 * double[1], words="3 phi_0"
    )
    (d,) = stage("delta", s * triple[0] - c * triple[1], words="sin(3 phi - 3 phi_0)")
    (dd,) = stage("delta_2", d * d, words="its square")
    cosine, sine = (_horner(_series(_TERMS, first), dd) for first in (0, 1))
    step = stage("series", cosine, sine, words="1 - cos(phi - phi_0) over d^2; sin(phi - phi_0) over d")
    turn = stage("turn", dd * step[0], d * step[1], words="1 - cos, sin of phi - phi_0")
    correction = stage(
        "correction", c_0 * turn[0] + s_0 * turn[1], s_0 * turn[0] - c_0 * turn[1], words="what the step takes off"
    )
    cos_phi, sin_phi = stage("phi", c_0 - correction[0], s_0 - correction[1], words="cos phi, sin phi")
    return cos_phi, sin_phi


def _series(terms: int, parity: int) -> list[sympy.Rational]:
    """Coefficients in d^2 of (1 - cos(asin(d) / 3)) / d^2, or of sin(asin(d) / 3) / d.

    Both solve ``(1 - d^2) y'' - d y' + y / 9 = 0``, so that ``y_(k+2) = y_k (k^2 - 1/9) / ((k + 1) (k + 2))``.
    """
    coefficient = Fraction(1) if parity == 0 else Fraction(1, 3)
    found = []
    for k in range(parity, parity + 2 * terms, 2):
        found.append(coefficient)
        coefficient *= (Fraction(k * k) - Fraction(1, 9)) / ((k + 1) * (k + 2))
    found = found if parity else [-value for value in (*found[1:], coefficient)]
    return [sympy.Rational(value.numerator, value.denominator) for value in found]


def _horner(coefficients: list[sympy.Rational], x: sympy.Expr) -> sympy.Expr:
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = coefficient + x * total
    return total


def _decimal(text: str) -> sympy.Rational:
    return sympy.Rational(text)
