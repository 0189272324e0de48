"""Extreme eigenvalues of a symmetric 3 x 3 matrix in closed form, without functions of a library.

With the deviator ``B = A - (tr A / 3) I`` and ``p = |B| / sqrt 6`` they are ``tr A / 3 + 2 p cos(phi + 2 pi k / 3)``.
The textbook takes phi from an arc cosine, which loses half of the digits where two values are equal. Here the angle
comes from a norm, in which nothing cancels: with ``p = 1``,

    |B^2 + B - 2 I| = sqrt 24 cos(3 phi / 2),    |B^2 - B - 2 I| = sqrt 24 sin(3 phi / 2).

The first is the distance of the two greatest eigenvalues, so to speak, and decides the greatest; the second is that of
the two least, and decides the least in the same way. Of either cosine k, ``2 cos phi = 1 + k / cos(acos(k) / 3)`` is
smooth in [0, 1], ends included: a polynomial is right to all digits.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import sympy

from codegen.ir.lower.staged import Stages
from codegen.mechanics.velocity.triangular import TINY

_SECANT = (
    *("1.1547005383791055823", "-0.22222222220298787862", "0.10691671561972490468", "-0.065843599976282267716"),
    *("0.045736286617510647643", "-0.034138189970774990783", "0.026720417297601244632", "-0.021579961745855357429"),
    *("0.017674808883483477294", "-0.014287768236676574206", "0.010929052945317071538", "-0.0074877916572057324849"),
    *("0.004318569822271537913", "-0.0019589022768900039219", "0.00064292423362856036698"),
    *("-0.00013412961195293481936", "0.000013251879982900766163"),
)
"""1 / cos(acos(k) / 3) by powers of k: k times it is right to 4e-16 in [0, 1], of least greatest error."""

_ROOT_3 = sympy.Rational("1.7320508075688772935274463")

_P = 1 / _ROOT_3
"""p over q."""

Stage = Callable[..., list[sympy.Expr]]


@dataclass(frozen=True)
class Deviator:
    """A symmetric matrix without its trace, over ``q = sqrt 3 p``.

    Attributes:
        name: of the matrix, for names of stages.
        mean: a third of the trace.
        q: the norm over sqrt 2.
        half: half of the difference b_11 - b_22.
        last: b_33.
        off: entries 12, 13, 23.
    """

    name: str
    mean: sympy.Expr
    q: sympy.Expr
    half: sympy.Expr
    last: sympy.Expr
    off: tuple[sympy.Expr, sympy.Expr, sympy.Expr]


def deviator(stages: Stages, name: str, A: sympy.Matrix) -> Deviator:
    """Derive mean and deviator of a symmetric matrix.

    Args:
        stages: gets the steps.
        name: of the matrix, for names of stages.
        A: [3, 3] symbols; the upper triangle is read.
    """
    stage = _stager(stages, name)
    difference, trace = stage("diagonal", A[0, 0] - A[1, 1], A[0, 0] + A[1, 1] + A[2, 2], words="a_11 - a_22; trace")
    half, mean = stage("parts", difference / 2, trace / 3, words="half of a_11 - a_22; mean of the eigenvalues")
    (last,) = stage("last", A[2, 2] - mean, words="deviator, entry 33")
    entries = (half, A[0, 1], A[0, 2], A[1, 2])
    squares = stage("squares", sum(x * x for x in entries), last * last, words="squares of entries")
    (q,) = stage("q", sympy.sqrt(squares[0] + squares[1] * sympy.Rational(3, 4)), words="|B| / sqrt 2")
    (scale,) = stage("scale", 1 / (q + TINY), words="1 / q, harmless for a multiple of the identity")
    half, u, v, w, last = stage("B", *(x * scale for x in (*entries, last)), words="deviator over q")
    return Deviator(name, mean, q, half, last, (u, v, w))


def closeness(stages: Stages, found: Deviator, side: int) -> sympy.Expr:
    """``2 / sqrt 3`` times cosine (side 1) or sine (side -1) of 3 phi / 2: 0 where two greatest (least) are equal.

    The entries of ``B^2 + side p B - 2 p^2 I``, ``p = q / sqrt 3``, over q^2.
    """
    stage = _stager(stages, f"{found.name}_{'up' if side > 0 else 'down'}")
    p = side * _P
    h, z, (u, v, w) = found.half, found.last, found.off
    (t,) = stage("middle", z / 2 + p, words="b_33 / 2 and p")
    factors = stage("factors", p - z, t + h, t - h, words="p - b_33, p - b_22, p - b_11")
    sums = stage("sums", v * v - w * w, v * v + w * w, words="squares of entries 13 and 23")
    E = stage(
        "E",
        *(h * factors[0] + sums[0] / 2, u * factors[0] + v * w, v * factors[1] + u * w, w * factors[2] + u * v),
        z * (z + p) + sums[1] - sympy.Rational(2, 3),
        words="half of e_11 - e_22; entries 12, 13, 23, 33",
    )
    (square,) = stage("norm_2", sum(e * e for e in E[:4]) + sympy.Rational(3, 4) * (E[4] * E[4]), words="|E|^2 / 2")
    return stage("closeness", sympy.sqrt(square), words="|E| / sqrt 2")[0]


def reach(stages: Stages, found: Deviator, side: int) -> sympy.Expr:
    """How far the greatest (side 1) or the least (side -1) eigenvalue is from the mean, over q; positive."""
    k = closeness(stages, found, side)
    parts = [sympy.Rational(c) * (_ROOT_3 / 2) ** (i + 1) * _P for i, c in enumerate(_SECANT)]
    place = f"{found.name}_{'up' if side > 0 else 'down'}"
    (kk,) = stages.stage(f"square_{place}", sympy.Matrix([k * k]), "its square")
    coefficients = [_P, *parts]
    halves = sympy.Matrix([_horner(coefficients[parity::2], kk) for parity in (0, 1)])
    even, odd = stages.stage(f"powers_{place}", halves, "even powers, odd powers over the first")
    return stages.stage(f"reach_{place}", sympy.Matrix([even + k * odd]), "2 cos phi over sqrt 3")[0]


def largest(stages: Stages, name: str, A: sympy.Matrix) -> sympy.Expr:
    """The largest eigenvalue, with an error of a few eps of it."""
    found = deviator(stages, name, A)
    value = found.mean + found.q * reach(stages, found, 1)
    return stages.stage(f"lambda_{name}", sympy.Matrix([value]), "largest eigenvalue")[0]


def all_three(stages: Stages, name: str, A: sympy.Matrix) -> tuple[sympy.Expr, ...]:
    """The eigenvalues in descending order, each with an error of a few eps of the largest."""
    found = deviator(stages, name, A)
    up, down = (reach(stages, found, side) for side in (1, -1))
    values = sympy.Matrix([found.mean + found.q * x for x in (up, down - up, -down)])
    return tuple(stages.stage(f"lambda_{name}", values, "eigenvalues"))


def _stager(stages: Stages, name: str) -> Stage:
    def stage(what: str, *values: sympy.Expr, words: str) -> list[sympy.Expr]:
        return list(stages.stage(f"{what}_{name}", sympy.Matrix(list(values)), words))

    return stage


def _horner(coefficients: list[sympy.Rational], x: sympy.Expr) -> sympy.Expr:
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = coefficient + x * total
    return total
