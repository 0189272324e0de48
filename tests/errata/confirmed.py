"""The equations of S1 that are right as printed, and in which sense they are."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from flopcount import paper
from tests.reference.constraints import pair, phi, relative_position, relative_rotation, split_alpha
from tests.reference.derivatives import tensors
from tests.reference.scalars import Array

from . import sound, truth
from .claims import Sound, Values
from .misprints import dot2_phi_q, variation_of_d, variation_of_f
from .situations import Situation, off_manifold, on_manifold
from .truth import ROT, TRN


def of_all(*joints: str) -> Callable[[], tuple[Situation, ...]]:
    """Situations on the manifold of several joints."""
    return lambda: tuple(s for joint in joints for s in on_manifold(joint))


def zeros(*shape: int) -> Values:
    """A truth that says: nothing."""
    return lambda s: np.zeros(shape)


def eq_5(s: Situation) -> Array:
    """f_i^T delta d_ij + d_ij^T delta f_i."""
    d = truth.d_ij(s)(s.pose)
    return ((s.A_i @ s.f_i) @ variation_of_d(s) + d @ variation_of_f(s))[None]


def conventional_residual(s: Situation) -> Array:
    """Largest conventional residual [1] where Eqs. (10) and (11) put body j; nothing parametric judges them.

    The universal joint has the axes h_i and f_j in the parametric form, h_i and h_j in the conventional one.
    """
    offsets, angles = split_alpha(s.joint, "table4", s.pose.alpha, s.geometry)
    trn, rot = pair(s.joint)
    A_j = sound.eq_11(s, relative_rotation(rot, angles))
    turned = replace(s, pose=replace(s.pose, A_j=A_j))
    r_j = sound.eq_10(turned, relative_position(trn, offsets, s.geometry))
    geometry = replace(s.geometry, C_j=np.roll(s.C_j, -1, axis=1)) if s.joint == "universal" else s.geometry
    values = phi(s.joint, "conventional", None, replace(turned.pose, r_j=r_j), geometry)
    return np.array([np.max(np.abs(values))])


def rows(part: slice) -> Values:
    """Residual [3] of some parametric rows."""
    return lambda s: truth.parametric(s)(s.pose)[part]


def columns(part: slice, where: slice) -> Values:
    """Some columns of the Jacobian of some parametric rows."""
    return lambda s: truth.phi_q(s)[part, where]


def exact_second(part: slice, s: Situation) -> Array:
    """Exact second derivative [14x14] of the translational or of the rotational rows."""
    lam = truth.multipliers(s)[part]
    return truth.second(lambda pose: truth.parametric(s)(pose)[part], lam, s.pose, "parametric")


def substituted_second(part: slice, s: Situation) -> Array:
    """The same after substitution of Eqs. (10) and (11) in the Jacobian."""
    _, second = tensors(s.joint, "parametric", "table4", s.pose, s.geometry, derivative="substituted")
    return np.tensordot(truth.multipliers(s)[part], second[part], axes=(0, 0)).T


def block(second: Callable[[slice, Situation], Array], part: slice, rows: slice, columns: slice) -> Values:
    """A block of a second derivative."""
    return lambda s: second(part, s)[rows, columns]


Z, ALPHA = slice(0, 12), slice(12, None)
EVERY_ROT = of_all("translational", "revolute", "universal", "ball")

EQ_5 = Sound("(5)", "variation of `f_i . d_ij`", dot2_phi_q, eq_5, off_manifold)
EQ_10_11 = Sound(
    "(10), (11)",
    "body j so placed satisfies the conventional rows of Table 1, all seven joints",
    zeros(1),
    conventional_residual,
    of_all(*paper.JOINTS),
)
EQ_17 = Sound("(17)", "translational rows, anywhere", rows(TRN), sound.eq_17, off_manifold)
EQ_18 = Sound("(18)", "rotational rows, anywhere", rows(ROT), sound.eq_18, off_manifold)
EQ_20 = Sound("(20)", "Jacobian of trn1, on the manifold only", columns(TRN, Z), sound.eq_20)
EQ_21 = Sound("(21)", "`phi_alpha` of trn1, anywhere", columns(TRN, ALPHA), sound.eq_21, off_manifold)
EQ_22 = Sound(
    "(22), (34)",
    "`(phi_Z^T lambda)_Z = 0`, after substitution of (11) only",
    lambda s: substituted_second(slice(0, 6), s)[Z, Z],
    zeros(12, 12),
)
EQ_23 = Sound(
    "(23), (35)",
    "`(phi_alpha^T lambda)_Z = 0`, anywhere",
    block(exact_second, slice(0, 6), ALPHA, Z),
    zeros(2, 12),
    off_manifold,
)
EQ_24 = Sound(
    "(24)",
    "`(phi_alpha^T lambda)_alpha = 0` of trn1, anywhere",
    block(exact_second, TRN, ALPHA, ALPHA),
    zeros(2, 2),
    off_manifold,
)
EQ_25 = Sound(
    "(25)",
    "`(phi_Z^T lambda)_alpha` of trn1, after substitution of (11)",
    lambda s: truth.substituted(s, TRN)[Z],
    sound.eq_25,
)
EQ_26 = Sound(
    "(26)", "Jacobian of trn0, on the manifold only", columns(TRN, Z), sound.eq_26, partial(on_manifold, "revolute")
)
EQ_29 = Sound("(29)", "`C_i^T f_i`, `C_i^T g_i`, `C_i^T h_i`", lambda s: s.C_i.T @ s.C_i, sound.eq_29)
EQ_33 = Sound("(33)", "`phi_alpha` of rot1, anywhere", columns(ROT, ALPHA), sound.eq_33, off_manifold)
EQ_37 = Sound(
    "(37)",
    "`(phi_alpha^T lambda)_alpha` of rot1, anywhere",
    block(exact_second, ROT, ALPHA, ALPHA),
    sound.eq_37,
    off_manifold,
)
TABLE_4 = Sound(
    "Table 4",
    "the rows vanish where `C_i^T A_ij C_j = H(alpha)`, rot0 to rot3",
    zeros(3),
    lambda s: sound.table_4(pair(s.joint)[1], s),
    EVERY_ROT,
)
TABLE_6_TRN = Sound(
    "Table 6",
    "column of the translational rows, all seven joints",
    columns(TRN, Z),
    sound.table_6_trn,
    of_all(*paper.JOINTS),
)

CONFIRMED = (
    EQ_5,
    EQ_10_11,
    EQ_17,
    EQ_18,
    EQ_20,
    EQ_21,
    EQ_22,
    EQ_23,
    EQ_24,
    EQ_25,
    EQ_26,
    EQ_29,
    EQ_33,
    EQ_37,
    TABLE_4,
    TABLE_6_TRN,
)
