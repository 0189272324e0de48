"""What is claimed of the tables of S1: Table 4 loses rank, Table 5 misses the rotation of the planar joint."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tests.reference.constraints import phi
from tests.reference.derivatives import tensors
from tests.reference.rotations import skew
from tests.reference.scalars import Array

from . import corrected, sound, truth
from .situations import Situation, off_manifold, on_manifold, with_alpha
from .truth import ROT, TRN

PLANAR_AS_PRINTED, PLANAR_CORRECTED = "trn2_rot0", "trn2_rot1"
RANK_POSES: tuple[tuple[str, tuple[float, ...]], ...] = (
    ("revolute", (0.0,)),
    ("revolute", (np.pi,)),
    ("revolute", (0.7,)),
    ("universal", (0.0, 0.7)),
    ("universal", (0.7, 0.0)),
    ("universal", (0.7, 0.7)),
    ("ball", (0.0, 0.5, 0.6)),
    ("ball", (0.5, 0.0, 0.6)),
    ("ball", (0.5, 0.6, 0.0)),
    ("ball", (0.5, 0.6, 0.7)),
)


def smallest_singular_values(joint: str, rows: str, angles: tuple[float, ...]) -> Array:
    """Smallest singular value of phi_q at every situation, the angles of the joint being these."""
    found = []
    for s in on_manifold(joint):
        alpha = s.pose.alpha.copy()
        alpha[len(alpha) - len(angles) :] = angles
        found.append(np.linalg.svd(truth.phi_q(with_alpha(s, alpha), rows), compute_uv=False)[-1])
    return np.array(found)


def planar_residual(composition: str) -> float:
    """Violation, in poses of a planar joint turned about its normal, of the rows of Table 5: least or largest."""
    worst = []
    for s in on_manifold("planar"):
        alpha = s.pose.alpha if composition == PLANAR_CORRECTED else s.pose.alpha[:2]
        pose = replace(s.pose, alpha=alpha)
        worst.append(float(np.max(np.abs(phi(composition, "parametric", "table4", pose, s.geometry)))))
    return min(worst) if composition == PLANAR_AS_PRINTED else max(worst)


def planar_residual_conventional() -> float:
    """Largest violation of the conventional rows of the planar joint at the same poses."""
    residuals = (phi("planar", "conventional", None, s.pose, s.geometry) for s in on_manifold("planar"))
    return max(float(np.max(np.abs(values))) for values in residuals)


def freedom(joint: str) -> int:
    """Degrees of freedom of body j against body i: coordinates less the rank of phi_q and the 6 of body i."""
    ranks = set()
    for s in on_manifold(joint):
        rows = truth.phi_q(s)
        ranks.add(rows.shape[1] - int(np.linalg.matrix_rank(rows, tol=1e-9)) - 6)
    (found,) = ranks
    return found


def eq_20_off_the_manifold() -> tuple[float, float]:
    """Deviation of Eq. (20) off the manifold, and with phi~ added in the column of delta pi_i."""
    bare, mended = [], []
    for s in off_manifold():
        off = truth.phi_q(s)[TRN, :12] - sound.eq_20(s)
        bare.append(np.max(np.abs(off)))
        off[:, 3:6] -= skew(sound.eq_17(s))
        mended.append(np.max(np.abs(off)))
    return float(max(bare)), float(max(mended))


def eq_32_off_the_manifold() -> float:
    """Deviation of the corrected Eq. (32) off the manifold."""
    return max(float(np.max(np.abs(truth.phi_q(s)[ROT, :12] - corrected.eq_32(s)))) for s in off_manifold())


def substitution() -> tuple[float, float]:
    """Exact less substituted second derivative of the cylindrical joint: any direction, and allowed directions."""
    anywhere, along = [], []
    for s in on_manifold():
        _, second = tensors(s.joint, "parametric", "table4", s.pose, s.geometry, derivative="substituted")
        off = truth.phi_q_t_lambda_q(s) - np.tensordot(truth.multipliers(s), second, axes=(0, 0)).T
        anywhere.append(np.max(np.abs(off)))
        along.append(np.max(np.abs(off @ allowed(s))))
    return float(max(anywhere)), float(max(along))


def allowed(s: Situation) -> Array:
    """Directions [n x n - 6] that the rows allow, orthonormal."""
    _, _, right = np.linalg.svd(truth.phi_q(s))
    return np.asarray(right[6:].T)
