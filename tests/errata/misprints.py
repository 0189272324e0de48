"""The misprints of the equations of S1, one by one."""

from __future__ import annotations

from functools import partial

import numpy as np

from tests.reference.derivatives import PI_I, PI_J
from tests.reference.rotations import skew
from tests.reference.scalars import Array

from . import corrected, printed, sound, truth
from .claims import Misprint
from .situations import Situation, on_manifold, without_lever, without_offset
from .truth import ROT, TRN


def variation_of_d(s: Situation) -> Array:
    """delta d_ij [3x12]."""
    return truth.jacobian(truth.d_ij(s), s.pose, "conventional")


def variation_of_f(s: Situation) -> Array:
    """delta f_i [3x12]."""
    return truth.jacobian(lambda pose: pose.A_i @ s.f_i, s.pose, "conventional")


def dot2_phi_q(s: Situation) -> Array:
    """Jacobian [1x12] of f_i . d_ij."""
    return truth.jacobian(truth.dot2(s), s.pose, "conventional")


def dot2_second(s: Situation) -> Array:
    """Second derivative [12x12] of lambda f_i . d_ij."""
    return truth.second(truth.dot2(s), np.array([s.lam_dot2]), s.pose, "conventional")


def translational(s: Situation) -> Array:
    """Jacobian [3x14] of the translational rows."""
    return truth.phi_q(s)[TRN]


def rotational(s: Situation) -> Array:
    """Jacobian [3x14] of the rotational rows."""
    return truth.phi_q(s)[ROT]


def rotational_z(s: Situation) -> Array:
    """Jacobian [3x12] of the rotational rows without the columns of alpha."""
    return truth.phi_q(s)[ROT, :12]


def rotational_z_alpha(s: Situation) -> Array:
    """d(phi_Z^T lambda)/d alpha [12x2] of the rotational rows after substitution of Eq. (11)."""
    return truth.substituted(s, ROT)[:12]


def products_of_tildes(s: Situation) -> Array:
    """C_i^T f_i~, C_i^T g_i~, C_i^T h_i~ by multiplication."""
    return np.array([s.C_i.T @ skew(a) for a in (s.f_i, s.g_i, s.h_i)])


EQ_6 = Misprint("(6)", "sign of `A_j s_j~`", np.s_[:, PI_J], variation_of_d, printed.eq_6, corrected.eq_6)
EQ_7 = Misprint("(7)", "`A_j` for `A_i`", np.s_[:, PI_I], variation_of_f, printed.eq_7, corrected.eq_7)
EQ_8 = Misprint("(8)", "fourth block", np.s_[:, PI_J], dot2_phi_q, printed.eq_8, corrected.eq_8)
EQ_9 = tuple(
    Misprint("(9)", f"block {name}", block, dot2_second, printed.eq_9, corrected.eq_9)
    for name, block in (
        ("(2,4)", np.s_[PI_I, PI_J]),
        ("(4,2)", np.s_[PI_J, PI_I]),
        ("(4,4)", np.s_[PI_J, PI_J]),
    )
)
EQ_9_BLOCK_2_4, EQ_9_BLOCK_4_2, EQ_9_BLOCK_4_4 = EQ_9

EQ_19 = tuple(
    Misprint("(19)", part, np.s_[:, where], translational, printed.eq_19, corrected.eq_19, *situations)
    for part, where, situations in (
        ("sign of `A_j s_j~`", PI_J, ()),
        ("sign of `A_i s_i~`, seen alone at alpha_1 = 0", PI_I, (without_offset,)),
        ("sign of `A_i h_i~ alpha_1`, seen alone at s_i = 0", PI_I, (without_lever,)),
    )
)
EQ_19_S_J, EQ_19_S_I, EQ_19_H_I = EQ_19

EQ_27 = Misprint("(27)", "row 2, `delta g_j` for `delta g_i`", 1, rotational, printed.eq_27, corrected.eq_27)
EQ_28 = Misprint(
    "(28)",
    "row 3, `H` for `H^T` in the column of delta pi_i",
    np.s_[2, PI_I],
    rotational,
    printed.eq_28_with_primes,
    corrected.eq_28,
)
EQ_28_PRIMES = Misprint(
    "(28)", "no primes on the leading vectors", np.s_[:, 3:12], rotational, printed.eq_28, corrected.eq_28
)
EQ_30 = Misprint("(30)", "third product", 2, products_of_tildes, printed.eq_30, corrected.eq_30)
EQ_31_ROW_2 = Misprint("(31)", "row 2, delta pi_j", np.s_[1, PI_J], rotational, printed.eq_31, corrected.eq_31)
EQ_31_ROW_3 = Misprint("(31)", "row 3, delta pi_i", np.s_[2, PI_I], rotational, printed.eq_31, corrected.eq_31)
EQ_32_ROW_2 = Misprint("(32)", "row 2, delta pi_j", np.s_[1, PI_J], rotational_z, printed.eq_32, corrected.eq_32)
EQ_32_ROW_3 = Misprint("(32)", "row 3, delta pi_i", np.s_[2, PI_I], rotational_z, printed.eq_32, corrected.eq_32)
EQ_36 = Misprint("(36)", "block of pi_i", np.s_[PI_I, 1], rotational_z_alpha, printed.eq_36, corrected.eq_36)

EQ_38 = Misprint(
    "(38)",
    "`C_i` for `C_i^T`",
    np.s_[:, PI_I],
    rotational_z,
    printed.eq_38,
    corrected.eq_38,
    partial(on_manifold, "translational"),
)


def table_6_as_printed(s: Situation) -> Array:
    """Table 6 with Eqs. (32) and (38) as printed."""
    return sound.table_6(s, printed.eq_32, printed.eq_38)


def table_6_corrected(s: Situation) -> Array:
    """Table 6 with Eqs. (32) and (38) corrected."""
    return sound.table_6(s, corrected.eq_32, corrected.eq_38)


def phi_z(s: Situation) -> Array:
    """Jacobian [6x12] of all rows of a joint without the columns of alpha."""
    return truth.phi_q(s)[:, :12]


TABLE_6 = {
    joint: Misprint(
        "Table 6",
        f"{joint}, by Eq. {equation}",
        ROT,
        phi_z,
        table_6_as_printed,
        table_6_corrected,
        partial(on_manifold, joint),
    )
    for joint, equation in (
        ("revolute", "(32)"),
        ("translational", "(38)"),
        ("screw", "(32)"),
        ("cylindrical", "(32)"),
        ("planar", "(32)"),
    )
}

CONVENTIONAL = (EQ_6, EQ_7, EQ_8, *EQ_9)
TRANSLATIONAL = EQ_19
ROTATIONAL = (
    EQ_27,
    EQ_28,
    EQ_28_PRIMES,
    EQ_30,
    EQ_31_ROW_2,
    EQ_31_ROW_3,
    EQ_32_ROW_2,
    EQ_32_ROW_3,
    EQ_36,
    EQ_38,
)
EQUATIONS = (*CONVENTIONAL, *TRANSLATIONAL, *ROTATIONAL)
