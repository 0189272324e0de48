"""The reference judged by itself: consistent poses, 256-bit differences, identities of SPEC S1.0."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import flint
import numpy as np
import pytest
from scipy.linalg import expm

from .constraints import ALL_PAIRS, CONVENTIONAL, PARAMETRIC, Pose, pair, phi, unpack_geometry
from .derivatives import evaluate, gamma_along_motion, pose_of, tensors
from .poses import convert, residual, sample
from .rotations import exp_map, from_euler_parameters, random_rotation, skew
from .scalars import cast, to_float

Case = tuple[str, str, str | None]


def _cases() -> Iterator[Case]:
    for joint in CONVENTIONAL:
        yield joint, "conventional", None
    for joint in [*PARAMETRIC, *(name for name in ALL_PAIRS if pair(name) not in PARAMETRIC.values())]:
        yield joint, "parametric", "regular"
        yield joint, "parametric", "table4"
        if pair(joint)[1] == 3:
            yield joint, "parametric", "quaternion"


CASES = tuple(_cases())
every_case = pytest.mark.parametrize(("joint", "form", "rows"), CASES)
both_variations = pytest.mark.parametrize("variation", ["body", "world"])


@pytest.fixture(autouse=True)
def _precision() -> Iterator[None]:
    """256-bit flint numbers inside each test."""
    before, flint.ctx.prec = flint.ctx.prec, 256
    yield
    flint.ctx.prec = before


def turned(A: Any, w: Any, variation: str) -> Any:
    """A moved by a finite rotation vector w [3]."""
    return exp_map(w) @ A if variation == "world" else A @ exp_map(w)


def moved(pose: Pose, q: Any, form: str, variation: str) -> Pose:
    """Pose moved by a finite step q [n] of the variation vector; moved(moved(., u), w): outer u, inner w."""
    dr_i, dr_j = q[0:3], q[6:9]
    if form == "parametric" and variation == "body":
        dr_i, dr_j = pose.A_i @ dr_i, pose.A_j @ dr_j
    A_i, A_j = turned(pose.A_i, q[3:6], variation), turned(pose.A_j, q[9:12], variation)
    return Pose(pose.r_i + dr_i, A_i, pose.r_j + dr_j, A_j, pose.alpha + q[12:])


def close(actual: Any, expected: Any, tolerance: float) -> None:
    """Largest difference below tolerance times the largest expected entry (at least 1)."""
    actual, expected = to_float(actual), to_float(expected)
    assert actual.shape == expected.shape
    scale = max(1.0, float(np.max(np.abs(expected), initial=0.0)))
    assert float(np.max(np.abs(actual - expected), initial=0.0)) <= tolerance * scale


def test_exp_map_in_every_number_type() -> None:
    w = np.array([0.4, -1.1, 2.0])
    close(exp_map(w), expm(skew(w)), 1e-14)
    close(exp_map(np.zeros(3)), np.eye(3), 0.0)
    close(np.imag(exp_map(1e-30j * w)) * 1e30, skew(w), 1e-15)
    tiny = cast(w, flint.arb(0)) * flint.arb("1e-60")
    close((exp_map(tiny) - np.eye(3, dtype=int)) * flint.arb("1e60"), skew(w), 1e-15)
    R = exp_map(cast(w, flint.arb(0)))
    close((R.T @ R - np.eye(3, dtype=int)) * flint.arb("1e60"), np.zeros((3, 3)), 1.0)


def test_random_rotations_are_proper_and_euler_parameters_homogeneous() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        R, e = random_rotation(rng), rng.normal(size=4)
        close(R.T @ R, np.eye(3), 1e-14)
        assert abs(np.linalg.det(R) - 1) < 1e-14
        X = from_euler_parameters(e)
        close(X.T @ X, np.eye(3) * (e @ e) ** 2, 1e-13)


@every_case
def test_consistent_poses_have_zero_phi_and_others_not(joint: str, form: str, rows: str | None) -> None:
    for seed in range(5):
        assert np.max(np.abs(residual(joint, form, sample(joint, form, seed, rows=rows), rows))) < 1e-13
        off = sample(joint, form, seed, rows=rows, consistent=False)
        assert np.max(np.abs(residual(joint, form, off, rows))) > 1e-2


@every_case
@both_variations
def test_phi_q_equals_complex_step(joint: str, form: str, rows: str | None, variation: str) -> None:
    for consistent in (True, False):
        inputs = sample(joint, form, 11, rows=rows, variation=variation, consistent=consistent)
        pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
        n = 12 + len(pose.alpha)
        stepped = [moved(pose, 1e-30j * q, form, variation) for q in np.eye(n)]
        columns = [np.imag(phi(joint, form, rows, there, geometry)) * 1e30 for there in stepped]
        close(evaluate(joint, form, "phi_q", inputs, rows=rows, variation=variation), np.array(columns).T, 1e-14)


@every_case
@both_variations
def test_second_derivative_equals_high_precision_differences(
    joint: str, form: str, rows: str | None, variation: str
) -> None:
    rng, h = np.random.default_rng(5), flint.arb("1e-20")
    inputs = convert(sample(joint, form, 7, rows=rows, variation=variation, consistent=False), flint.arb(0))
    pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
    n = 12 + len(pose.alpha)
    u, w = (cast(rng.normal(size=n), flint.arb(0)) for _ in range(2))
    total = flint.arb(0)
    for a in (1, -1):
        for b in (1, -1):
            there = moved(moved(pose, u * (h * a), form, variation), w * (h * b), form, variation)
            total = total + inputs["lambda"] @ phi(joint, form, rows, there, geometry) * (a * b)
    M = evaluate(joint, form, "phi_q_t_lambda_q", convert(inputs, 0.0), rows=rows, variation=variation)
    close(to_float(w) @ M @ to_float(u), to_float(np.array(total / (4 * h * h))), 1e-13)


@every_case
@both_variations
def test_gamma_three_ways(joint: str, form: str, rows: str | None, variation: str) -> None:
    inputs = sample(joint, form, 3, rows=rows, variation=variation, consistent=False)
    velocity = inputs["velocity"] = np.random.default_rng(4).normal(size=len(inputs["velocity"]))
    gamma = evaluate(joint, form, "gamma", inputs, rows=rows, variation=variation)
    pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
    close(gamma_along_motion(joint, form, rows, pose, geometry, velocity, variation), gamma, 1e-14)
    exact, h = convert(inputs, flint.arb(0)), flint.arb("1e-20")
    pose, geometry, v = pose_of(exact), unpack_geometry(exact["geometry"]), exact["velocity"]
    values = [phi(joint, form, rows, moved(pose, v * (h * t), form, variation), geometry) for t in (-1, 0, 1)]
    close(gamma, -(values[0] - values[1] * 2 + values[2]) * (1 / (h * h)), 1e-13)


@every_case
def test_float_truth_against_256_bits(joint: str, form: str, rows: str | None) -> None:
    inputs = sample(joint, form, 9, rows=rows, consistent=False)
    exact = convert(inputs, flint.arb(0))
    for output in ("phi", "phi_q", "phi_q_t_lambda_q", "gamma", "phi_q_v", "phi_q_t_lambda"):
        truth = evaluate(joint, form, output, exact, rows=rows)
        close(evaluate(joint, form, output, inputs, rows=rows), truth, 1e-14)


@every_case
@both_variations
def test_skew_part_of_rotational_blocks(joint: str, form: str, rows: str | None, variation: str) -> None:
    inputs = sample(joint, form, 2, rows=rows, consistent=False)
    M = evaluate(joint, form, "phi_q_t_lambda_q", inputs, rows=rows, variation=variation)
    force = evaluate(joint, form, "phi_q_t_lambda", inputs, rows=rows, variation=variation)
    sign = 1 if variation == "body" else -1
    for part in (slice(3, 6), slice(9, 12)):
        block = M[part, part]
        close((block - block.T) / 2, sign * skew(force[part]) / 2, 1e-14)


@every_case
def test_world_and_body_variations_are_one_map(joint: str, form: str, rows: str | None) -> None:
    inputs = sample(joint, form, 6, rows=rows, consistent=False)
    body, world = (evaluate(joint, form, "phi_q", inputs, rows=rows, variation=v) for v in ("body", "world"))
    T = np.eye(body.shape[1])
    T[3:6, 3:6], T[9:12, 9:12] = inputs["A_i"], inputs["A_j"]
    if form == "parametric":
        T[0:3, 0:3], T[6:9, 6:9] = inputs["A_i"], inputs["A_j"]
    close(world @ T, body, 1e-14)


@pytest.mark.parametrize(("joint", "form", "rows"), [case for case in CASES if case[1] == "parametric"])
@both_variations
def test_substituted_is_exact_along_the_manifold(joint: str, form: str, rows: str, variation: str) -> None:
    inputs = sample(joint, form, 8, rows=rows, variation=variation)
    pose, geometry = pose_of(inputs), unpack_geometry(inputs["geometry"])
    options: dict[str, Any] = {"rows": rows, "variation": variation}
    exact, second = tensors(joint, form, rows, pose, geometry, variation=variation)
    first, substituted = tensors(joint, form, rows, pose, geometry, variation=variation, derivative="substituted")
    close(first, exact, 1e-14)
    v = inputs["velocity"]
    close(np.tensordot(substituted, v, axes=(1, 0)), np.tensordot(second, v, axes=(1, 0)), 1e-13)
    exact_gamma = evaluate(joint, form, "gamma", inputs, **options)
    close(evaluate(joint, form, "gamma", inputs, derivative="substituted", **options), exact_gamma, 1e-13)
    if variation == "body":  # a function of alpha alone
        assert np.max(np.abs(substituted[:, :12, :])) < 1e-14
        assert np.max(np.abs(substituted[:, 12:, 12:][:3]), initial=0.0) < 1e-14
