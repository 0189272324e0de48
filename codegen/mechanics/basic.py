"""The basic constraints of the conventional form (S1 section 2, after Haug): dot-1, dot-2, spherical, screw.

Each is stated once, in world vectors. The axes they are evaluated in follow from the algebra in force.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.mechanics.algebra import Algebra
from codegen.mechanics.frames import A_i, A_j, C_i, C_j, d_ij, pitch, revolutions, theta_0, vector
from codegen.mechanics.terms import unit
from codegen.spec.joints import Axis, BasicConstraint, Dot1, Dot2, Spherical

_COLUMN: dict[Axis, int] = {"f": 0, "g": 1, "h": 2}

sine_theta, cosine_theta, theta = sympy.symbols("sine_theta cosine_theta theta")
"""Stages of the screw: ``g_i . f_j``, ``f_i . f_j`` and the angle between them, rad."""

tilt, spread = sympy.symbols("tilt spread")
"""Stages of the derivative of theta: ``h_i . f_j``, and one over the squared length of ``across``."""

across = vector("across")
"""The part of h_i across f_j, ``h_i - (h_i . f_j) f_j``."""

theta_axis = vector("theta_axis")
"""What theta varies with: ``delta theta = theta_axis . (turn of body j less that of body i)``."""


def axis_i(axis: Axis) -> Any:
    """An axis of the joint frame on body i, [3], world."""
    return sympy.MatMul(A_i, C_i, unit(_COLUMN[axis]))


def axis_j(axis: Axis) -> Any:
    """An axis of the joint frame on body j, [3], world."""
    return sympy.MatMul(A_j, C_j, unit(_COLUMN[axis]))


def constraint(kind: BasicConstraint, algebra: Algebra) -> Any:
    """Give phi of a basic constraint: a scalar, or a [3] vector for the spherical one (S1 Eq. (4), Table 1)."""
    if isinstance(kind, Dot1):
        return algebra.dot(axis_i(kind.axis_i), axis_j(kind.axis_j))
    if isinstance(kind, Dot2):
        return algebra.dot(axis_i(kind.axis_i), d_ij)
    if isinstance(kind, Spherical):
        return d_ij
    return algebra.dot(axis_i("h"), d_ij) - pitch * (theta + 2 * sympy.pi * revolutions + theta_0)


def screw_stages(algebra: Algebra, body_axes: Any | None) -> dict[Any, Any]:
    """The angle of the screw from the components of f_j across its axis, H = R_z(theta), and what it varies with.

    ``theta = atan2(g_i . f_j, f_i . f_j)``, and ``theta_axis = (h_i - z f_j) / (1 - z^2)`` with ``z = h_i . f_j``,
    which is ``h_i`` on the manifold.

    Args:
        algebra: normal form in force.
        body_axes: rotation of the body in whose axes ``theta_axis`` is kept; None for world axes.
    """
    axis = sympy.MatAdd(axis_i("h"), sympy.MatMul(-1, tilt, axis_j("f")))
    parts = axis.args if body_axes is None else [sympy.MatMul(sympy.Transpose(body_axes), part) for part in axis.args]
    return {
        sine_theta: algebra.dot(axis_i("g"), axis_j("f")),
        cosine_theta: algebra.dot(axis_i("f"), axis_j("f")),
        theta: sympy.atan2(sine_theta, cosine_theta),
        tilt: algebra.dot(axis_i("h"), axis_j("f")),
        spread: 1 / (1 - tilt**2),
        across: algebra.normal(sympy.MatAdd(*parts)),
        theta_axis: sympy.MatMul(spread, across),
    }


SCREW_PARTIALS: dict[Any, dict[Any, Any]] = {spread: {tilt: 2 * tilt * spread**2}}
"""The derivative of ``spread`` in its own terms."""


def theta_variation(axis: Any, relative_rotation: Any, algebra: Algebra) -> Any:
    """Variation of the angle, ``delta theta = axis . (A_j delta pi_j - A_i delta pi_i)`` (SPEC S1.1).

    Args:
        axis: ``theta_axis``, or ``h_i`` on the manifold; [3], world.
        relative_rotation: virtual rotation of body j less that of body i, [3], world.
        algebra: normal form in force.
    """
    terms = algebra.terms(relative_rotation)
    parts = [c * algebra.dot(axis, sympy.MatMul(*chain) if len(chain) > 1 else chain[0]) for c, chain in terms]
    return sympy.Add(*parts)
