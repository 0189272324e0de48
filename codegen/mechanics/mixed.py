"""The parametric form (S1 section 3): translational constraints trn0 to trn3 and rotational constraints rot0 to rot3.

``trn_k``: ``A_i^T d_ij - d'(alpha)``, S1 Eq. (17). ``rot_k``: three rows that say ``C_i^T A_ij C_j = H(alpha)``, S1
Table 3 and Table 4 (rows ``table4``), or the rows that keep full rank at every alpha (``regular``, SPEC S1.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from codegen.mechanics.algebra import Algebra
from codegen.mechanics.frames import A_i, A_j, C_i, C_j, H, dp_ij, pitch, revolutions, theta_0
from codegen.mechanics.terms import skew, unit

_X, _Y, _Z = 0, 1, 2

ROTATION_AXES: tuple[tuple[int, ...], ...] = ((), (_Z,), (_Z, _X), (_Z, _Y, _X))
"""S1 Table 3: rot0 = I, rot1 = R_z, rot2 = R_z R_x, rot3 = R_z R_y R_x."""

TRANSLATION_AXES: tuple[tuple[int, ...], ...] = ((), (_Z,), (_X, _Y), (_X, _Y, _Z))
"""S1 Table 3: trn0 = 0, trn1 along h, trn2 along f and g, trn3 along f, g and h."""

_REGULAR = ((1, 2), (2, 0), (0, 1))
"""Rows ``g* . h_j``, ``h* . f_j``, ``f* . g_j`` with ``[f* g* h*] = C_i H``."""

advance = sympy.Symbol("advance")
"""Translation of a screw, m: a stage of its own."""


@dataclass(frozen=True, slots=True)
class RelativeRotation:
    """H(alpha): the rotation of joint frame j seen from joint frame i.

    Attributes:
        coordinates: the rotational alphas.
        definition: H, explicit [3, 3].
        rates: for each coordinate its variation of H, as a product ``H w~`` for angles (w the axis of the coordinate in
            joint frame j) or as an explicit matrix for Euler parameters.
    """

    coordinates: tuple[Any, ...]
    definition: Any
    rates: tuple[Any, ...]


def about(axis: int, angle: Any) -> Any:
    """Rotation about a coordinate axis, explicit [3, 3]."""
    c, s = sympy.cos(angle), sympy.sin(angle)
    j, k = (axis + 1) % 3, (axis + 2) % 3
    entries = {(axis, axis): sympy.S.One, (j, j): c, (k, k): c, (j, k): -s, (k, j): s}
    return sympy.ImmutableDenseMatrix(3, 3, lambda row, column: entries.get((row, column), sympy.S.Zero))


def euler_rotation(axes: tuple[int, ...], angles: tuple[Any, ...]) -> RelativeRotation:
    """Product of rotations about coordinate axes (S1 Table 3); ``delta H = H (sum w_k delta alpha_k)~``."""
    definition = sympy.ImmutableDenseMatrix(sympy.eye(3))
    for axis, angle in zip(axes, angles, strict=True):
        definition = definition * about(axis, angle)
    rates = []
    for k, axis in enumerate(axes):
        w = unit(axis)
        for later, angle in zip(axes[k + 1 :], angles[k + 1 :], strict=True):
            w = about(later, angle).T * w
        rates.append(sympy.MatMul(H, skew(w)))
    return RelativeRotation(angles, definition, tuple(rates))


def quaternion_rotation(parameters: tuple[Any, ...]) -> RelativeRotation:
    """Euler parameters in the homogeneous form ``(e0^2 - e.e) I + 2 e e^T + 2 e0 e~``; a rotation at norm 1."""
    e0, *vector = parameters
    e = sympy.ImmutableDenseMatrix(vector)
    definition = (e0**2 - e.dot(e)) * sympy.eye(3) + 2 * e * e.T + 2 * e0 * skew(e)
    definition = sympy.ImmutableDenseMatrix(definition.applyfunc(sympy.expand))
    rates = tuple(sympy.ImmutableDenseMatrix(definition.diff(parameter)) for parameter in parameters)
    return RelativeRotation(parameters, definition, rates)


def translation(k: int, coordinates: tuple[Any, ...], is_screw: bool) -> Any:
    """d'(alpha) of ``trn_k`` in the axes of body i, [3] m (S1 Table 3); ZeroMatrix for trn0."""
    if not TRANSLATION_AXES[k]:
        return sympy.ZeroMatrix(3, 1)
    amounts = (advance,) if is_screw else coordinates[:k]
    joint_axes = sympy.zeros(3, 1)
    for axis, amount in zip(TRANSLATION_AXES[k], amounts, strict=True):
        joint_axes += amount * unit(axis)
    return sympy.MatMul(C_i, sympy.ImmutableDenseMatrix(joint_axes))


def screw_advance(angle: Any) -> Any:
    """Advance of a screw ``p (alpha + 2 pi n + alpha_0)``, m (S1 Table 6)."""
    return pitch * (angle + 2 * sympy.pi * revolutions + theta_0)


def translational_rows(d_of_alpha: Any) -> Any:
    """``trn_k``: ``A_i^T d_ij - d'(alpha)``, [3] m, axes of body i (S1 Eq. (17))."""
    return dp_ij if isinstance(d_of_alpha, sympy.ZeroMatrix) else sympy.MatAdd(dp_ij, sympy.MatMul(-1, d_of_alpha))


def rotational_rows(rows: str, k: int, rotation: RelativeRotation, algebra: Algebra) -> tuple[Any, ...]:
    """The rows of ``rot_k``.

    Args:
        rows: ``regular``, ``table4`` (S1 Table 4) or ``quaternion``.
        k: the number of rotational freedoms.
        rotation: H(alpha).
        algebra: normal form in force.
    """
    if rows == "table4":
        return _table4(k, rotation.coordinates, algebra)
    starred = [sympy.MatMul(A_i, C_i, H, unit(axis)) if k else _axis_i(axis) for axis in range(3)]
    regular = tuple(algebra.dot(starred[a], _axis_j(b)) for a, b in _REGULAR)
    if rows == "quaternion":
        norm = sympy.Add(*(parameter**2 for parameter in rotation.coordinates)) - 1
        return (*regular, norm)
    return regular


def _axis_i(axis: int) -> Any:
    return sympy.MatMul(A_i, C_i, unit(axis))


def _axis_j(axis: int) -> Any:
    return sympy.MatMul(A_j, C_j, unit(axis))


def _table4(k: int, angles: tuple[Any, ...], algebra: Algebra) -> tuple[Any, ...]:
    """S1 Table 4."""

    def dot(a: int, b: int) -> Any:
        return algebra.dot(_axis_i(a), _axis_j(b))

    c = [sympy.cos(angle) for angle in angles]
    s = [sympy.sin(angle) for angle in angles]
    if k == 0:
        return tuple(dot(a, b) for a, b in _REGULAR)
    if k == 1:
        return dot(_X, _Z), dot(_Y, _Z), dot(_X, _X) - c[0]
    if k == 2:
        return dot(_Z, _X), dot(_X, _X) - c[0], dot(_Z, _Z) - c[1]
    return dot(_X, _X) - c[0] * c[1], dot(_Z, _X) + s[1], dot(_Z, _Z) - c[1] * c[2]
