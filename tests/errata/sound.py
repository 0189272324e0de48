"""The equations of S1 that are right as printed, coded as printed, and Table 6, which says which of them go where."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tests.reference.constraints import relative_rotation
from tests.reference.rotations import skew
from tests.reference.scalars import Array

from .situations import Situation
from .truth import difference

I, O = np.eye(3), np.zeros((3, 3))
NONE = np.zeros(3)


def A_ij(s: Situation) -> Array:
    """A_i^T A_j [3x3]."""
    return s.A_i.T @ s.A_j


def eq_10(s: Situation, d: Array) -> Array:
    """r_j of d'_ij = d."""
    return s.pose.r_i + s.A_i @ s.s_i - s.A_j @ s.s_j + s.A_i @ d


def eq_11(s: Situation, H: Array) -> Array:
    """A_j of H_ij = H."""
    return s.A_i @ s.C_i @ H @ s.C_j.T


def eq_17(s: Situation) -> Array:
    """Translational rows [3] of the cylindrical joint."""
    p = s.pose
    return s.A_i.T @ (p.r_j + s.A_j @ s.s_j - p.r_i - s.A_i @ s.s_i - s.A_i @ s.h_i * s.offset)


def eq_18(s: Situation) -> Array:
    """Rotational rows [3] of the cylindrical joint."""
    f_i, g_i, f_j, h_j = s.A_i @ s.f_i, s.A_i @ s.g_i, s.A_j @ s.f_j, s.A_j @ s.h_j
    return np.array([f_i @ h_j, g_i @ h_j, f_i @ f_j - np.cos(s.angle)])


def eq_20(s: Situation, offset: Array | None = None) -> Array:
    """Jacobian [3x12] of trn1; offset [3x3] stands for h_i~ alpha_1, as Table 6 has it."""
    if offset is None:
        offset = skew(s.h_i) * s.offset
    return np.hstack([-I, skew(s.s_i) + offset, A_ij(s), -A_ij(s) @ skew(s.s_j)])


def eq_21(s: Situation) -> Array:
    """d phi / d alpha [3x2] of trn1."""
    return np.column_stack([-s.h_i, NONE])


def eq_25(s: Situation) -> Array:
    """d(phi_Z^T lambda)/d alpha [12x2] of trn1, D = d A_ij / d alpha_2 with A_ij of Eq. (11)."""
    D = difference(lambda h: s.C_i @ relative_rotation(1, [s.angle + h]) @ s.C_j.T)
    lam = s.lam_trn
    first = np.concatenate([NONE, -skew(s.h_i) @ lam, NONE, NONE])
    return np.column_stack([first, np.concatenate([NONE, NONE, D.T @ lam, skew(s.s_j) @ D.T @ lam])])


def eq_26(s: Situation) -> Array:
    """Jacobian [3x12] of trn0."""
    return np.hstack([-I, skew(s.s_i), A_ij(s), -A_ij(s) @ skew(s.s_j)])


def eq_29(s: Situation) -> Array:
    """C_i^T f_i, C_i^T g_i, C_i^T h_i."""
    return np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1]])


def eq_33(s: Situation) -> Array:
    """d phi / d alpha [3x2] of rot1."""
    return np.array([[0, 0], [0, 0], [0, np.sin(s.angle)]])


def eq_37(s: Situation) -> Array:
    """d(phi_alpha^T lambda)/d alpha [2x2] of rot1."""
    return np.array([[0, 0], [0, s.lam_rot[2] * np.cos(s.angle)]])


def table_4(rot: int, s: Situation) -> Array:
    """Rotational rows [3] of rot_l."""
    f_i, g_i, h_i = (s.A_i @ s.C_i).T
    f_j, g_j, h_j = (s.A_j @ s.C_j).T
    alpha = s.pose.alpha[len(s.pose.alpha) - rot :]
    c, sin = np.cos(alpha), np.sin(alpha)
    if rot == 0:
        return np.array([g_i @ h_j, h_i @ f_j, f_i @ g_j])
    if rot == 1:
        return np.array([f_i @ h_j, g_i @ h_j, f_i @ f_j - c[0]])
    if rot == 2:
        return np.array([h_i @ f_j, f_i @ f_j - c[0], h_i @ h_j - c[1]])
    return np.array([f_i @ f_j - c[0] * c[1], h_i @ f_j + sin[1], h_i @ h_j - c[1] * c[2]])


def table_6_trn(s: Situation) -> Array:
    """The column trn phi_Z [3x12] of Table 6."""
    if s.joint in ("revolute", "universal", "ball"):
        return eq_26(s)
    if s.joint == "translational":
        A = s.C_i @ s.C_j.T  # "A_ij = const."
        return np.hstack([-I, skew(s.s_i) + skew(s.h_i) * s.offset, A, -A @ skew(s.s_j)])
    if s.joint == "screw":
        geometry = s.geometry
        p, n, alpha_0 = geometry.pitch, geometry.turns, geometry.theta_0
        return eq_20(s, skew(s.h_i) * p * (s.angle + 2 * n * np.pi + alpha_0))
    if s.joint == "planar":
        a1, a2, _ = s.pose.alpha
        return eq_20(s, skew(s.f_i) * a1 + skew(s.g_i) * a2)
    return eq_20(s)


def table_6(s: Situation, eq_32: Callable[[Situation], Array], eq_38: Callable[[Situation], Array]) -> Array:
    """phi_Z [6x12] of Table 6, with Eqs. (32) and (38) either as printed or corrected; rot2, rot3 are not printed."""
    rot = eq_38(s) if s.joint == "translational" else eq_32(s)
    return np.vstack([table_6_trn(s), rot])
