"""What is printed in S3 and is not so, in numbers."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from .geometries import SEMI_REGULAR
from .test_identities import ALPHA, BETA, GAMMA, SIGMA, one
from .truth import jacobian

WHERE = (np.array([0.1, 0.2, 0.9]), Rotation.from_euler("ZYX", [0.3, 0.1, -0.1]).as_matrix())
J = np.array(jacobian(SEMI_REGULAR.base, SEMI_REGULAR.joints, *WHERE).tolist(), dtype=float)
J1, J2 = J[:, :3], J[:, 3:]
N_W = J2.T @ (np.eye(6) - J1 @ np.linalg.pinv(J1)) @ J2


def test_block_2_2_of_equation_13_has_the_other_sign() -> None:
    block = np.linalg.inv(J.T @ J)[3:, 3:]
    assert block == pytest.approx(np.linalg.inv(N_W), rel=1e-9)
    assert not np.allclose(block, -np.linalg.inv(N_W))


def test_with_the_joint_in_the_place_of_its_arm_half_of_the_indices_are_wrong_and_the_others_do_not_notice() -> None:
    """P_i = R p'_i + o as the arm: the same as a platform whose reference point is the origin of the base."""
    o, R = WHERE
    right = one(SEMI_REGULAR, ("D",), WHERE)["D"]
    about_base = replace(SEMI_REGULAR, joints=SEMI_REGULAR.joints + (R.T @ o)[:, None])
    wrong = one(about_base, ("D",), (np.zeros(3), R))["D"]
    assert wrong[[ALPHA, BETA]] == pytest.approx(right[[ALPHA, BETA]], rel=1e-12)
    assert max(wrong[[SIGMA, GAMMA]] / right[[SIGMA, GAMMA]]) > 2


def test_speeds_without_rotation_lie_in_the_range_of_j1_and_not_in_the_null_space_of_j2() -> None:
    speeds = J1 @ np.array([0.3, -0.2, 0.5])
    assert np.linalg.solve(J, speeds)[3:] == pytest.approx(np.zeros(3), abs=1e-12)
    assert np.abs(J2.T @ speeds).max() > 1e-2


def test_axes_are_reciprocals_of_roots_of_eigenvalues_in_the_reverse_order() -> None:
    values = one(SEMI_REGULAR, ("values",), WHERE)["values"][:3]
    inverse = np.linalg.inv(J)[:3]
    assert np.linalg.svd(inverse, compute_uv=False) == pytest.approx(1 / values[::-1], rel=1e-12)


def test_a_platform_with_greater_d_is_slower() -> None:
    fast, slow = (one(SEMI_REGULAR, ("D", "Q1"), (np.array([0, 0, h]), np.eye(3))) for h in (0.5, 2.0))
    volumes = [np.prod(np.linalg.svd(out["Q1"], compute_uv=False)) for out in (fast, slow)]
    assert [out["D"][SIGMA] for out in (fast, slow)] == pytest.approx([1 / v for v in volumes], rel=1e-12)
