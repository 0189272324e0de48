"""Derivatives on SO(3) by differences of the constraints themselves; no formula of the paper is used.

First derivatives by complex step, exact to rounding; second ones by a fourth-order difference of the first along
finite rotations.  Columns as in the paper: (delta r_i, delta pi_i, delta r_j, delta pi_j, delta alpha).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tests.reference.constraints import Pose, phi_parametric
from tests.reference.derivatives import ALPHA, PI_I, PI_J, R_I, R_J, step, substitute
from tests.reference.rotations import exp_map
from tests.reference.scalars import Array

from .situations import Situation

Function = Callable[[Pose], Array]

TINY = 1e-30
STEP = 1e-3
STENCIL = ((-2, 1 / 12), (-1, -8 / 12), (1, 8 / 12), (2, -1 / 12))
TRN, ROT = slice(0, 3), slice(3, 6)


def jacobian(function: Function, pose: Pose, form: str) -> Array:
    """Derivative [m x n] of a function [m] of the pose; delta r in world axes in the conventional form."""
    if form == "conventional":
        pose = replace(pose, alpha=np.zeros(0))
    n = 12 + len(pose.alpha)
    columns = [function(step(pose, TINY * 1j * unit, form, "body")).imag / TINY for unit in np.eye(n)]
    return np.array(columns).T


def difference(function: Callable[[float], Array]) -> Array:
    """Derivative at 0 of a function of one number."""
    return sum(weight * function(k * STEP) for k, weight in STENCIL) / STEP


def turned(pose: Pose, q: Array, form: str) -> Pose:
    """Pose moved by a finite step q [n] of the variation vector."""
    dr_i, dr_j = q[R_I], q[R_J]
    if form == "parametric":
        dr_i, dr_j = pose.A_i @ dr_i, pose.A_j @ dr_j
    A_i, A_j = pose.A_i @ exp_map(q[PI_I]), pose.A_j @ exp_map(q[PI_J])
    return Pose(pose.r_i + dr_i, A_i, pose.r_j + dr_j, A_j, pose.alpha + q[ALPHA])


def second(function: Function, lam: Array, pose: Pose, form: str) -> Array:
    """d(J^T lam)/dq [n x n] of a function [m] with Jacobian J."""
    if form == "conventional":
        pose = replace(pose, alpha=np.zeros(0))

    def along(unit: Array) -> Array:
        return difference(lambda h: jacobian(function, turned(pose, h * unit, form), form).T @ lam)

    return np.array([along(unit) for unit in np.eye(12 + len(pose.alpha))]).T


def d_ij(s: Situation) -> Function:
    """World vector d_ij [3] of a pose."""
    return lambda pose: pose.r_j + pose.A_j @ s.s_j - pose.r_i - pose.A_i @ s.s_i


def dot2(s: Situation) -> Function:
    """f_i . d_ij as [1]."""
    return lambda pose: np.array([(pose.A_i @ s.f_i) @ d_ij(s)(pose)])


def parametric(s: Situation, rows: str = "table4") -> Function:
    """The six rows of the joint: A_i^T d_ij - d'(alpha), then Table 4 or our regular rows."""
    return lambda pose: phi_parametric(s.joint, rows, pose, s.geometry)


def phi_q(s: Situation, rows: str = "table4") -> Array:
    """Derivative [6 x n] of the parametric rows."""
    return jacobian(parametric(s, rows), s.pose, "parametric")


def phi_q_t_lambda_q(s: Situation) -> Array:
    """Exact second derivative [n x n] of the parametric rows, multipliers (lam_trn, lam_rot)."""
    return second(parametric(s), multipliers(s), s.pose, "parametric")


def multipliers(s: Situation) -> Array:
    """(lam_trn, lam_rot) [6]."""
    return np.concatenate([s.lam_trn, s.lam_rot])


def substituted(s: Situation, rows: slice) -> Array:
    """d(phi_q^T lam)/d alpha [12 + n x n] of some rows, phi_q being a function of alpha alone by Eqs. (10), (11)."""

    def along(unit: Array) -> Array:
        def product(h: float) -> Array:
            moved = replace(s.pose, alpha=s.pose.alpha + h * unit)
            there = replace(s, pose=substitute(s.joint, "table4", moved, s.geometry))
            return phi_q(there)[rows].T @ multipliers(s)[rows]

        return difference(product)

    return np.array([along(unit) for unit in np.eye(len(s.pose.alpha))]).T
