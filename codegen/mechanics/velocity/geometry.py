"""Legs of a platform in a pose: attitude, leg vectors and the Jacobian (S3 Eqs. 39 to 47)."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import sympy

from codegen.ir.lower.staged import Stages
from codegen.spec.platform import LEGS, Platform

_COMFORTABLE = (Fraction(1, 1024), Fraction(1024))
"""Sizes in m for which the intermediate results keep clear of the ends of a float."""


@dataclass(frozen=True)
class Legs:
    """The legs in a pose, lengths in the length unit ``2**exponent`` m.

    Attributes:
        lengths: [6, 1] |l_i|.
        J1: [6, 3] rows e_i, base axes.
        J2: [6, 3] rows p_i x e_i, base axes.
        exponent: of the length unit.
        inverses: [6] 1 / |l_i|.
        arms: six times [3] p_i, base axes.
        R: [3, 3] platform to base.
    """

    lengths: sympy.Matrix
    J1: sympy.Matrix
    J2: sympy.Matrix
    exponent: int
    inverses: list[sympy.Expr]
    arms: list[sympy.Matrix]
    R: sympy.Matrix


def length_exponent(platform: Platform) -> int:
    """The length unit of the intermediate results, as a power of two of a metre: exact, and free where it is 1."""
    size = max(abs(x) for joint in platform.joints for x in joint)
    if _COMFORTABLE[0] <= size <= _COMFORTABLE[1]:
        return 0
    return round(sympy.log(sympy.Rational(size.numerator, size.denominator), 2).evalf())


def legs(stages: Stages, platform: Platform, is_symbolic: bool = False) -> Legs:
    """Derive the legs from the pose.

    ``l_i = p_i + (o - B_i)`` in this order, which keeps its digits where the base frame is far away.

    Args:
        stages: gets the arguments ``o`` and, after ``platform.wanted.attitude``, ``R``, ``q`` or ``angles``.
        platform: with the joints of its legs.
        is_symbolic: whether the joints are arguments ``base`` and ``platform`` [3, 6] too, in m.
    """
    exponent = 0 if is_symbolic else length_exponent(platform)
    unit = sympy.Integer(2) ** exponent
    o = stages.argument("o", 3)
    R = rotation(stages, platform.wanted.attitude)
    B, joints = (_joints(points, unit) for points in (platform.base, platform.joints))
    if is_symbolic:
        B, joints = stages.argument("base", 3, LEGS), stages.argument("platform", 3, LEGS)
    o = stages.stage("o_unit", o / unit, "o in the length unit") if exponent else o
    lengths, inverses, arms, rows_1, rows_2 = [], [], [], [], []
    for i in range(LEGS):
        p = stages.stage(f"p_{i + 1}", R * joints[:, i], f"R p'_{i + 1}")
        d = stages.stage(f"d_{i + 1}", o - B[:, i], f"o - B_{i + 1}")
        l = stages.stage(f"l_{i + 1}", p + d, f"p_{i + 1} + d_{i + 1}")
        length = stages.stage(f"length_{i + 1}", sympy.Matrix([sympy.sqrt(l.dot(l))]), f"|l_{i + 1}|")[0]
        inverse = stages.stage(f"inverse_{i + 1}", sympy.Matrix([1 / length]), f"1 / |l_{i + 1}|")[0]
        e = stages.stage(f"e_{i + 1}", l * inverse, f"l_{i + 1} / |l_{i + 1}|")
        m = stages.stage(f"m_{i + 1}", p.cross(e), f"p_{i + 1} x e_{i + 1}")
        lengths.append(length)
        inverses.append(inverse)
        arms.append(p)
        rows_1.append(e.T)
        rows_2.append(m.T)
    J1, J2 = sympy.Matrix.vstack(*rows_1), sympy.Matrix.vstack(*rows_2)
    return Legs(sympy.Matrix(lengths), J1, J2, exponent, inverses, arms, R)


def rotation(stages: Stages, attitude: str) -> sympy.Matrix:
    """The rotation matrix [3, 3], platform to base, of an attitude argument.

    Args:
        stages: gets the argument.
        attitude: ``matrix`` (``R``, taken as it is), ``quaternion`` (``q``: w x y z of any length but 0) or an Euler
            order (``angles``, rad).
    """
    if attitude == "matrix":
        return stages.argument("R", 3, 3)
    if attitude == "quaternion":
        return _of_quaternion(stages)
    angles = stages.argument("angles", 3)
    turns = [_turn(axis.upper(), angle) for axis, angle in zip(attitude, angles, strict=True)]
    first, second, third = turns if attitude.isupper() else reversed(turns)
    half = stages.stage("R_12", first * second, "the last two turns" if attitude.islower() else "the first two turns")
    return stages.stage("R", half * third, f"platform to base, Euler order {attitude}")


def _of_quaternion(stages: Stages) -> sympy.Matrix:
    q = stages.argument("q", 4)
    scale = stages.stage("scale", sympy.Matrix([2 / q.dot(q)]), "2 / |q|^2")[0]
    w, x, y, z = q
    s = stages.stage("s_q", sympy.Matrix([scale * x, scale * y, scale * z]), "scale (x, y, z)")
    sums = stages.stage(
        "sums",
        sympy.Matrix([s[1] * y + s[2] * z, s[0] * x + s[2] * z, s[0] * x + s[1] * y]),
        "scale (y^2 + z^2), scale (x^2 + z^2), scale (x^2 + y^2)",
    )
    rows = [
        [1 - sums[0], s[0] * y - s[2] * w, s[0] * z + s[1] * w],
        [s[0] * y + s[2] * w, 1 - sums[1], s[1] * z - s[0] * w],
        [s[0] * z - s[1] * w, s[1] * z + s[0] * w, 1 - sums[2]],
    ]
    return stages.stage("R", sympy.Matrix(rows), "platform to base, of the quaternion")


def _turn(axis: str, angle: sympy.Symbol) -> sympy.Matrix:
    c, s = sympy.cos(angle), sympy.sin(angle)
    k = "XYZ".index(axis)
    turn = sympy.eye(3)
    a, b = (k + 1) % 3, (k + 2) % 3
    turn[a, a], turn[a, b], turn[b, a], turn[b, b] = c, -s, s, c
    return turn


def _joints(points: tuple[tuple[Fraction, ...], ...], unit: sympy.Expr) -> sympy.Matrix:
    columns = [[sympy.Rational(x.numerator, x.denominator) / unit for x in point] for point in points]
    return sympy.Matrix(columns).T
