"""The same equations as they must be, written anew and not by patching the printed ones.

Columns: (delta r_i, delta pi_i, delta r_j, delta pi_j), then delta alpha where the equation has it.
"""

from __future__ import annotations

import numpy as np

from tests.reference.constraints import relative_rotation
from tests.reference.rotations import skew
from tests.reference.scalars import Array

from .situations import Situation
from .truth import d_ij

I, O = np.eye(3), np.zeros((3, 3))
o = np.zeros(3)


def A_ij(s: Situation) -> Array:
    """A_i^T A_j [3x3]."""
    return s.A_i.T @ s.A_j


def d_body(s: Situation) -> Array:
    """d'_ij [3]: d_ij in the axes of body i."""
    return s.A_i.T @ d_ij(s)(s.pose)


def eq_6(s: Situation) -> Array:
    """delta(A s) = A (delta pi)~ s = -A s~ delta pi for both bodies, d_ij = ... + A_j s_j - ... - A_i s_i."""
    return np.hstack([-I, s.A_i @ skew(s.s_i), I, -s.A_j @ skew(s.s_j)])


def eq_7(s: Situation) -> Array:
    """delta f_i = -A_i f'_i~ delta pi_i."""
    return np.hstack([O, -s.A_i @ skew(s.f_i), O, O])


def eq_8(s: Situation) -> Array:
    """f_i^T delta d_ij + d_ij^T delta f_i, Eq. (5), in terms of A_ij."""
    f_world = s.A_i @ s.f_i
    pi_i = s.f_i @ skew(d_body(s) + s.s_i)
    return np.concatenate([-f_world, pi_i, f_world, -s.f_i @ A_ij(s) @ skew(s.s_j)])[None]


def eq_9(s: Situation) -> Array:
    """Variation of the transpose of Eq. (8)."""
    A, f, s_j = A_ij(s), skew(s.f_i), skew(s.s_j)
    second = np.zeros((4, 3, 4, 3))
    second[0, :, 1] = s.A_i @ f
    second[1, :, 0] = -f @ s.A_i.T
    second[1, :, 1] = f @ skew(d_body(s) + s.s_i)
    second[1, :, 2] = f @ s.A_i.T
    second[1, :, 3] = -f @ A @ s_j
    second[2, :, 1] = -s.A_i @ f
    second[3, :, 1] = -s_j @ A.T @ f
    second[3, :, 3] = s_j @ A.T @ f @ A
    return s.lam_dot2 * second.reshape(12, 12)


def eq_19(s: Situation) -> Array:
    """Variation [3x14] of Eq. (17) where it holds; the bracket's own rotation, phi~ delta pi_i, is then zero."""
    lever = skew(s.s_i + s.h_i * s.offset)
    alpha = np.column_stack([-s.h_i, o])
    return np.hstack([-I, lever, A_ij(s), -A_ij(s) @ skew(s.s_j), alpha])


def eq_27(s: Situation) -> Array:
    """delta(a_i . b_j) = b_j . delta a_i + a_i . delta b_j for (f, h), (g, h), (f, f)."""
    rows = []
    for a, b in ((s.f_i, s.h_j), (s.g_i, s.h_j), (s.f_i, s.f_j)):
        d_a, d_b = -s.A_i @ skew(a), -s.A_j @ skew(b)
        rows.append(np.concatenate([o, (s.A_j @ b) @ d_a, o, (s.A_i @ a) @ d_b, [0, 0]]))
    rows[2][13] = np.sin(s.angle)
    return np.array(rows)


def eq_28(s: Situation) -> Array:
    """b_j . delta a_i = -b'_j^T A_ij^T a'_i~ delta pi_i, and A_ij^T = C_j H^T C_i^T."""
    H = relative_rotation(1, [s.angle])
    rows = []
    for a, b in ((s.f_i, s.h_j), (s.g_i, s.h_j), (s.f_i, s.f_j)):
        pi_i = -b @ s.C_j @ H.T @ s.C_i.T @ skew(a)
        pi_j = -a @ s.C_i @ H @ s.C_j.T @ skew(b)
        rows.append(np.concatenate([o, pi_i, o, pi_j, [0, 0]]))
    rows[2][13] = np.sin(s.angle)
    return np.array(rows)


def eq_30(s: Situation) -> Array:
    """Row a of C_i^T b~ is (a x b)^T: h x h = 0 stands last."""
    f, g, h = s.f_i, s.g_i, s.h_i
    return np.array([[o, -h, g], [h, o, -f], [-g, f, o]])


def eq_31(s: Situation) -> Array:
    """Eq. (28) with Eqs. (29) and (30)."""
    return np.column_stack([eq_32(s), [0, 0, 0], [0, 0, np.sin(s.angle)]])


def eq_32(s: Situation) -> Array:
    """-g_i, f_i, s h_i for body i; s f_j + c g_j, -c f_j + s g_j, -s h_j for body j."""
    sin, cos = np.sin(s.angle), np.cos(s.angle)
    pi_i = np.array([-s.g_i, s.f_i, sin * s.h_i])
    pi_j = np.array([sin * s.f_j + cos * s.g_j, -cos * s.f_j + sin * s.g_j, -sin * s.h_j])
    return np.hstack([O, pi_i, O, pi_j])


def eq_36(s: Situation) -> Array:
    """Derivative of Eq. (32)^T lambda by alpha_2."""
    sin, cos = np.sin(s.angle), np.cos(s.angle)
    d_pi_i = np.array([o, o, cos * s.h_i])
    d_pi_j = np.array([cos * s.f_j - sin * s.g_j, sin * s.f_j + cos * s.g_j, -cos * s.h_j])
    return np.column_stack([np.zeros(12), np.hstack([O, d_pi_i, O, d_pi_j]).T @ s.lam_rot])


def eq_38(s: Situation) -> Array:
    """h_j . delta g_i = f_i . delta pi_i and so on: the rows are f_i, g_i, h_i, that is C_i^T."""
    return np.hstack([O, s.C_i.T, O, -s.C_j.T])
