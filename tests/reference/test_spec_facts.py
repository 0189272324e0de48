"""Facts that SPEC S1 prints, found again from the reference: ranks, the screw, the slider-crank."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from .constraints import PARAMETRIC, Pose, alpha_size, pair, relative_rotation, unpack_geometry
from .derivatives import evaluate, pose_of, substitute, tensors
from .poses import consistent_pose, residual, sample
from .rotations import Rz, skew

SEVEN = ("revolute", "translational", "screw", "cylindrical", "universal", "planar", "ball")
ROTATING = tuple(joint for joint in SEVEN if pair(joint)[1] > 0)
UNIT = np.concatenate([np.zeros(3), np.eye(3).ravel(), np.zeros(3), np.eye(3).ravel()])


def unit_pose(joint: str, alpha: Any) -> tuple[Pose, NDArray[np.float64]]:
    """Consistent pose and geometry with s = 0, C = I, A_i = I; screw with unit pitch."""
    rng = np.random.default_rng(0)
    inputs = consistent_pose(joint, "parametric", rng, "regular", alpha)
    geometry = np.concatenate([UNIT, [1.0, 0.0, 0.0]]) if joint == "screw" else UNIT
    pose = Pose(np.zeros(3), np.eye(3), np.zeros(3), np.eye(3), inputs["alpha"])
    return substitute(joint, "regular", pose, unpack_geometry(geometry)), geometry


def sigma(joint: str, rows: str, alpha: Any) -> NDArray[np.float64]:
    """Singular values [6] of phi_q at unit geometry."""
    pose, geometry = unit_pose(joint, alpha)
    first, _ = tensors(joint, "parametric", rows, pose, unpack_geometry(geometry))
    return np.linalg.svd(first, compute_uv=False)


@pytest.mark.parametrize("joint", SEVEN)
def test_regular_rows_have_full_rank_everywhere(joint: str) -> None:
    rng = np.random.default_rng(3)
    n = alpha_size(joint, "parametric")
    samples = [np.zeros(n), *(rng.uniform(-np.pi, np.pi, size=n) for _ in range(50))]
    if joint == "ball":
        samples = [alpha * [1, 1.2 / np.pi, 1] for alpha in samples]
    smallest = [sigma(joint, "regular", alpha)[-1] for alpha in samples]
    print(joint, min(smallest), max(smallest))
    assert min(smallest) > 0.5


@pytest.mark.parametrize("joint", [*SEVEN, "rigid"])
def test_both_forms_are_one_joint(joint: str) -> None:
    """Same poses, same tangent velocities; the universal joint with the cross axis f_j renamed h_j."""
    inputs = sample(joint, "parametric", 2)
    velocity, geometry = inputs["velocity"][:12].copy(), inputs["geometry"].copy()
    velocity[0:3], velocity[6:9] = inputs["A_i"] @ velocity[0:3], inputs["A_j"] @ velocity[6:9]
    if joint == "universal":
        geometry[15:24] = np.roll(geometry[15:24], -3)
    there = {name: value for name, value in inputs.items() if name != "alpha"} | {"geometry": geometry}
    assert np.max(np.abs(residual(joint, "conventional", there))) < 1e-14
    first = evaluate(joint, "conventional", "phi_q", there)
    assert np.max(np.abs(first @ velocity)) < 1e-14
    freedom = 1 if joint == "screw" else sum(pair(joint))
    assert np.linalg.matrix_rank(first, tol=1e-3) == len(first) == 6 - freedom


@pytest.mark.parametrize("joint", ROTATING)
@pytest.mark.parametrize("angle", [0.0, np.pi])
def test_table4_rows_lose_rank_in_the_reference_pose(joint: str, angle: float) -> None:
    alpha = np.zeros(alpha_size(joint, "parametric"))
    rotations = 1 if joint == "screw" else pair(joint)[1]
    alpha[len(alpha) - rotations] = angle
    assert sigma(joint, "table4", alpha)[-1] < 1e-14
    assert sigma(joint, "regular", alpha)[-1] > 0.5


def test_table4_sigma_min_of_the_revolute() -> None:
    for angle in (1e-3, 1e-2):
        ratio = sigma("revolute", "table4", [angle])[-1] / abs(np.sin(angle))
        print(ratio)
        assert 1.0 < ratio < 2.0


def test_ball_loses_a_coordinate_at_gimbal_lock_only() -> None:
    pose, _ = unit_pose("ball", [0.3, np.pi / 2, 0.2])
    first, _ = tensors("ball", "parametric", "regular", pose, unpack_geometry(UNIT))
    assert np.linalg.svd(first[:, 12:], compute_uv=False)[-1] < 1e-14
    pose, _ = unit_pose("universal", [0.3, np.pi / 2])
    first, _ = tensors("universal", "parametric", "regular", pose, unpack_geometry(UNIT))
    assert np.linalg.svd(first[:, 12:], compute_uv=False)[-1] > 0.5


@pytest.mark.parametrize("joint", tuple(PARAMETRIC))
def test_trace_tells_the_wanted_root(joint: str) -> None:
    inputs = sample(joint, "parametric", 1)
    geometry = unpack_geometry(inputs["geometry"])
    angles = inputs["alpha"][len(inputs["alpha"]) - (1 if joint == "screw" else pair(joint)[1]) :]
    X = (inputs["A_i"] @ geometry.C_i).T @ inputs["A_j"] @ geometry.C_j
    assert abs(np.trace(relative_rotation(pair(joint)[1], angles).T @ X) - 3) < 1e-13


def test_screw_variation_on_the_manifold() -> None:
    inputs = sample("screw", "conventional", 4)
    exact = evaluate("screw", "conventional", "phi_q", inputs)
    geometry = unpack_geometry(inputs["geometry"])
    np.testing.assert_allclose(evaluate("screw", "conventional", "phi_q", inputs, screw="manifold"), exact, atol=1e-14)
    h_i, A_ij = geometry.C_i[:, 2], inputs["A_i"].T @ inputs["A_j"]
    d = inputs["A_i"].T @ (inputs["r_j"] - inputs["r_i"]) + A_ij @ geometry.s_j - geometry.s_i
    pi_i = skew(h_i) @ (d + geometry.s_i) + geometry.pitch * h_i
    pi_j = -h_i @ A_ij @ skew(geometry.s_j) - geometry.pitch * h_i @ A_ij
    np.testing.assert_allclose(exact[4, 3:6], pi_i, atol=1e-14)
    np.testing.assert_allclose(exact[4, 9:12], pi_j, atol=1e-14)
    tangent = [evaluate("screw", "conventional", "phi_q_t_lambda_q", inputs, screw=s) for s in ("exact", "manifold")]
    np.testing.assert_allclose(tangent[0] @ inputs["velocity"], tangent[1] @ inputs["velocity"], atol=1e-13)
    gammas = [evaluate("screw", "conventional", "gamma", inputs, screw=s) for s in ("exact", "manifold")]
    np.testing.assert_allclose(gammas[0], gammas[1], atol=1e-13)


def slider_crank(crank_angle: float, form: str, rows: str | None) -> tuple[NDArray[np.float64], int]:
    """phi_q of S1.5's engine (crank 0.1 m, rod 0.3 m, slide along x) without ground columns; column count."""
    crank, rod = 0.1, 0.3
    lean = -np.arcsin(crank * np.sin(crank_angle) / rod)
    along = [Rz(crank_angle) @ [crank, 0, 0], Rz(lean) @ [rod, 0, 0]]
    attitude = [np.eye(3), Rz(crank_angle), Rz(lean), np.eye(3)]
    position = [np.zeros(3), along[0] / 2, along[0] + along[1] / 2, along[0] + along[1]]
    slide = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]]).T  # h along x
    joints = [
        ("revolute", 0, 1, [0, 0, 0], [-crank / 2, 0, 0], np.eye(3), crank_angle),
        ("revolute", 1, 2, [crank / 2, 0, 0], [-rod / 2, 0, 0], np.eye(3), lean - crank_angle),
        ("revolute", 2, 3, [rod / 2, 0, 0], [0, 0, 0], np.eye(3), -lean),
        ("translational", 0, 3, [0, 0, 0], [0, 0, 0], slide.T, position[3][0]),
    ]
    blocks = []
    for index, (joint, i, j, s_i, s_j, C, alpha) in enumerate(joints):
        packed = np.concatenate([s_i, C.ravel(order="F"), s_j, C.ravel(order="F")]).astype(float)
        coordinates = np.array([alpha]) if form == "parametric" else np.zeros(0)
        pose = Pose(position[i], attitude[i], position[j], attitude[j], coordinates)
        first, _ = tensors(joint, form, rows, pose, unpack_geometry(packed))
        block = np.zeros((len(first), 28))
        block[:, 6 * i : 6 * i + 6], block[:, 6 * j : 6 * j + 6] = first[:, :6], first[:, 6:12]
        block[:, 24 + index : 25 + index] = first[:, 12:] if form == "parametric" else 0
        blocks.append(block)
    full = np.vstack(blocks)[:, 6:]
    return full, 22 if form == "parametric" else 18


@pytest.mark.parametrize(
    ("angle", "form", "rows", "shape", "rank"),
    [
        (0.7, "conventional", None, (20, 18), 17),
        (0.7, "parametric", "table4", (24, 22), 21),
        (0.0, "parametric", "table4", (24, 22), 18),
        (0.7, "parametric", "regular", (24, 22), 21),
        (0.0, "parametric", "regular", (24, 22), 21),
    ],
)
def test_ranks_of_the_slider_crank(
    angle: float, form: str, rows: str | None, shape: tuple[int, int], rank: int
) -> None:
    full, columns = slider_crank(angle, form, rows)
    assert full[:, :columns].shape == shape
    assert np.linalg.matrix_rank(full[:, :columns], tol=1e-10) == rank


@pytest.mark.parametrize("joint", [joint for joint in SEVEN if joint != "translational"])
def test_substituted_differs_across_the_manifold(joint: str) -> None:
    inputs = sample(joint, "parametric", 5)
    exact = evaluate(joint, "parametric", "phi_q_t_lambda_q", inputs)
    substituted = evaluate(joint, "parametric", "phi_q_t_lambda_q", inputs, derivative="substituted")
    assert np.max(np.abs(exact - substituted)) > 0.1
    assert pose_of(inputs).alpha.size == alpha_size(joint, "parametric")
