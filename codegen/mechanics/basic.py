"""The basic constraints of the conventional form (S1 section 2, after Haug): dot-1, dot-2, spherical, screw.

Each is stated once, in world vectors. The axes they are evaluated in follow from the algebra in force.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.mechanics.algebra import Algebra
from codegen.mechanics.frames import A_i, A_j, C_i, C_j, d_ij, pitch, revolutions, theta_0
from codegen.mechanics.terms import unit
from codegen.spec.joints import Axis, BasicConstraint, Dot1, Dot2, Spherical

_COLUMN: dict[Axis, int] = {"f": 0, "g": 1, "h": 2}

sine_theta, cosine_theta, theta = sympy.symbols("sine_theta cosine_theta theta")
"""Stages of the screw: ``g_i . f_j``, ``f_i . f_j`` and the angle between them, rad."""

theta_sine, theta_cosine = sympy.symbols("theta_sine theta_cosine")
"""Partial derivatives of theta by its sine and cosine."""


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


def screw_stages(algebra: Algebra) -> dict[Any, Any]:
    """The angle of the screw from the components of f_j across the axis: H = R_z(theta)."""
    return {
        sine_theta: algebra.dot(axis_i("g"), axis_j("f")),
        cosine_theta: algebra.dot(axis_i("f"), axis_j("f")),
        theta: sympy.atan2(sine_theta, cosine_theta),
        theta_sine: cosine_theta / (sine_theta**2 + cosine_theta**2),
        theta_cosine: -sine_theta / (sine_theta**2 + cosine_theta**2),
    }


SCREW_PARTIALS: dict[Any, dict[Any, Any]] = {
    theta: {sine_theta: theta_sine, cosine_theta: theta_cosine},
    theta_sine: {
        sine_theta: 2 * theta_sine * theta_cosine,
        cosine_theta: theta_cosine**2 - theta_sine**2,
    },
    theta_cosine: {
        sine_theta: theta_cosine**2 - theta_sine**2,
        cosine_theta: -2 * theta_sine * theta_cosine,
    },
}
"""Partial derivatives of the angle and of its own partial derivatives, in their own terms: theta is harmonic."""


def on_manifold_theta(relative_rotation: Any, algebra: Algebra) -> Any:
    """Variation of the angle on the manifold, ``delta theta = h_i . (A_j delta pi_j - A_i delta pi_i)`` (SPEC S1.1).

    Args:
        relative_rotation: virtual rotation of body j less that of body i, [3], world.
        algebra: normal form in force.
    """
    terms = algebra.terms(relative_rotation)
    parts = [c * algebra.dot(axis_i("h"), sympy.MatMul(*chain) if len(chain) > 1 else chain[0]) for c, chain in terms]
    return sympy.Add(*parts)
