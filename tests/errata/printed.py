"""The misprinted equations of S1, letter by letter as they stand in our copy.  Wrong on purpose.

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
NONE = np.zeros(3)


def row(*blocks: Array) -> Array:
    """Blocks side by side as one row of the Jacobian."""
    return np.concatenate(blocks)


def tilde_d(s: Situation) -> Array:
    """A_i^T d~_ij A_i [3x3]."""
    return s.A_i.T @ skew(d_ij(s)(s.pose)) @ s.A_i


def H_ij(s: Situation) -> Array:
    """R_z(alpha_2), Eq. (15)."""
    return relative_rotation(1, [s.angle])


def eq_6(s: Situation) -> Array:
    """delta d_ij = delta r_j + A_j s_j~ delta pi_j - delta r_i + A_i s_i~ delta pi_i."""
    return np.hstack([-I, s.A_i @ skew(s.s_i), I, s.A_j @ skew(s.s_j)])


def eq_7(s: Situation) -> Array:
    """delta f_i = -A_j f'_i~ delta pi_i."""
    return np.hstack([O, -s.A_j @ skew(s.f_i), O, O])


def eq_8(s: Situation) -> Array:
    """Jacobian [1x12] of f_i . d_ij."""
    f, A_i, A_j = s.f_i, s.A_i, s.A_j
    return row(-f @ A_i.T, f @ (tilde_d(s) + skew(s.s_i)), f @ A_i.T, f @ A_j @ skew(s.s_j))[None]


def eq_9(s: Situation) -> Array:
    """Second derivative [12x12] of f_i . d_ij."""
    f, s_i, s_j, A_i, A_j = skew(s.f_i), skew(s.s_i), skew(s.s_j), s.A_i, s.A_j
    return s.lam_dot2 * np.block(
        [
            [O, A_i @ f, O, O],
            [-f @ A_i.T, f @ (tilde_d(s) + s_i), f @ A_i.T, -f @ A_j @ s_j],
            [O, -A_i @ f, O, O],
            [O, -s_j @ A_j @ f, O, s_j @ A_j @ f @ A_j],
        ]
    )


def eq_19(s: Situation) -> Array:
    """Variation [3x14] of the translational rows of the cylindrical joint."""
    A_i, A_j, a1 = s.A_i, s.A_j, s.offset
    pi_i = -A_i @ skew(s.s_i) - A_i @ skew(s.h_i) * a1
    pi_j = A_j @ skew(s.s_j)
    alpha = np.column_stack([-A_i @ s.h_i, NONE])
    return A_i.T @ np.hstack([-A_i, pi_i, A_j, pi_j, alpha])


def eq_27(s: Situation) -> Array:
    """Variation [3x14] of the rotational rows, with delta f_i = -A_i f'_i~ delta pi_i and so on."""
    f_i, g_i = s.A_i @ s.f_i, s.A_i @ s.g_i
    f_j, h_j = s.A_j @ s.f_j, s.A_j @ s.h_j
    d_f_i = np.hstack([O, -s.A_i @ skew(s.f_i), O, O])
    d_f_j = np.hstack([O, O, O, -s.A_j @ skew(s.f_j)])
    d_g_j = np.hstack([O, O, O, -s.A_j @ skew(s.g_j)])
    d_h_j = np.hstack([O, O, O, -s.A_j @ skew(s.h_j)])
    rows = [h_j @ d_f_i + f_i @ d_h_j, h_j @ d_g_j + g_i @ d_h_j, f_j @ d_f_i + f_i @ d_f_j]
    return np.column_stack([np.array(rows), [0, 0, 0], [0, 0, np.sin(s.angle)]])


def eq_28(s: Situation) -> Array:
    """Variation [3x14] of the rotational rows: the leading vectors have no primes, they are world vectors."""
    f_i, g_i = s.A_i @ s.f_i, s.A_i @ s.g_i
    f_j, h_j = s.A_j @ s.f_j, s.A_j @ s.h_j
    return _eq_28(s, f_i, g_i, f_j, h_j)


def eq_28_with_primes(s: Situation) -> Array:
    """The same with the leading vectors in body axes, as Eq. (29) needs them."""
    return _eq_28(s, s.f_i, s.g_i, s.f_j, s.h_j)


def _eq_28(s: Situation, f_i: Array, g_i: Array, f_j: Array, h_j: Array) -> Array:
    C_i, C_j, H = s.C_i, s.C_j, H_ij(s)
    back, forth = C_j @ H @ C_i.T, C_i @ H @ C_j.T
    return np.array(
        [
            row(NONE, -h_j @ back @ skew(s.f_i), NONE, -f_i @ forth @ skew(s.h_j), [0, 0]),
            row(NONE, -h_j @ back @ skew(s.g_i), NONE, -g_i @ forth @ skew(s.h_j), [0, 0]),
            row(NONE, -f_j @ back @ skew(s.f_i), NONE, -f_i @ forth @ skew(s.f_j), [0, np.sin(s.angle)]),
        ]
    )


def eq_30(s: Situation) -> Array:
    """C_i^T f_i~, C_i^T g_i~, C_i^T h_i~ [3x3x3]."""
    f, g, h = s.f_i, s.g_i, s.h_i
    return np.array([[NONE, -h, g], [h, NONE, -f], [-g, NONE, f]])


def eq_31(s: Situation) -> Array:
    """Variation [3x14] of the rotational rows, simplified."""
    sin, cos = np.sin(s.angle), np.cos(s.angle)
    return np.array(
        [
            row(NONE, -s.g_i, NONE, sin * s.f_j + cos * s.g_j, [0, 0]),
            row(NONE, s.f_i, NONE, cos * s.f_j + sin * s.g_j, [0, 0]),
            row(NONE, -sin * s.h_i, NONE, -sin * s.h_j, [0, sin]),
        ]
    )


def eq_32(s: Situation) -> Array:
    """Jacobian [3x12] of the rotational rows."""
    sin, cos = np.sin(s.angle), np.cos(s.angle)
    return np.array(
        [
            row(NONE, -s.g_i, NONE, sin * s.f_j + cos * s.g_j),
            row(NONE, s.f_i, NONE, cos * s.f_j + sin * s.g_j),
            row(NONE, -sin * s.h_i, NONE, -sin * s.h_j),
        ]
    )


def eq_36(s: Situation) -> Array:
    """d(phi_Z^T lambda)/d alpha [12x2] of the rotational rows."""
    sin, cos = np.sin(s.angle), np.cos(s.angle)
    l1, l2, l3 = s.lam_rot
    pi_j = (l1 * cos + l2 * sin) * s.f_j - (l1 * sin - l2 * cos) * s.g_j - l3 * cos * s.h_j
    return np.column_stack([np.zeros(12), row(NONE, -l3 * cos * s.h_i, NONE, pi_j)])


def eq_38(s: Situation) -> Array:
    """Jacobian [3x12] of rot0."""
    return np.hstack([O, s.C_i, O, -s.C_j.T])
