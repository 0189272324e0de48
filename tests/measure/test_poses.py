"""Poses of the standard domain are what they claim, as the reference sees it, which follows the specification alone."""

from __future__ import annotations

import numpy as np
import pytest

from codegen import models
from codegen.ir.program import Argument
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import Poses, sample_poses
from codegen.spec.request import Variant
from tests.reference.constraints import phi, unpack_geometry
from tests.reference.derivatives import pose_of

COUNT = 16
VARIANTS = [
    *(Variant(joint, "conventional", None) for joint in ("revolute", "screw", "universal", "planar", "rigid")),
    *(Variant(joint, "parametric", "regular") for joint in ("translational", "cylindrical", "universal", "ball")),
    Variant("screw", "parametric", "table4"),
    Variant("ball", "parametric", "quaternion"),
]
SHAPES = {"A_i": (3, 3), "A_j": (3, 3)}

each = pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.file_stem)


def drawn(variant: Variant, is_converged: bool, domain: PoseDomain | None = None) -> Poses:
    arguments = [Argument("velocity", (12, 1)), Argument("lambda", (6, 1))]
    joint = models.joint_type(variant.joint)
    return sample_poses(joint, variant, arguments, domain or PoseDomain(), COUNT, is_converged)


def residuals(variant: Variant, poses: Poses) -> list[float]:
    given = poses.given(np.float64)
    found = []
    for k in range(COUNT):
        inputs = {name: rows[:, k].reshape(SHAPES.get(name, (-1,)), order="F") for name, rows in given.items()}
        inputs = {name: value for name, value in inputs.items() if name != "alpha" or variant.form == "parametric"}
        value = phi(variant.joint, variant.form, variant.rows, pose_of(inputs), unpack_geometry(inputs["geometry"]))
        found.append(float(np.max(np.abs(np.asarray(value, dtype=float)))))
    return found


@each
def test_converged_poses_meet_the_constraint(variant: Variant) -> None:
    assert max(residuals(variant, drawn(variant, is_converged=True))) < 3e-15


@each
def test_poses_in_mid_iteration_do_not(variant: Variant) -> None:
    found = residuals(variant, drawn(variant, is_converged=False))
    assert min(found) > 1e-3
    assert max(found) < 1.0


@each
def test_ideal_attitudes_are_rotations_to_30_digits(variant: Variant) -> None:
    ideal = drawn(variant, is_converged=False).ideal
    for name, start in (("A_i", 0), ("A_j", 0), ("geometry", 3), ("geometry", 15)):
        A = ideal[name][start : start + 9]
        for column in range(3):
            for other in range(column, 3):
                product = A[3 * column] * A[3 * other]
                for k in (1, 2):
                    product = product + A[3 * column + k] * A[3 * other + k]
                assert np.max(np.abs(product.high - (column == other) + product.low)) < 1e-30


def test_every_run_draws_the_same_poses() -> None:
    first, second = (drawn(VARIANTS[0], is_converged=True).given(np.float64) for _ in range(2))
    for name, rows in first.items():
        np.testing.assert_array_equal(rows, second[name])


def test_far_away_only_positions_change() -> None:
    near, far = (drawn(VARIANTS[0], True, PoseDomain(distance=distance)) for distance in (0.0, 1e6))
    for name, entries in near.ideal.items():
        for one, other in zip(entries, far.ideal[name], strict=True):
            moved = np.max(np.abs(one.high - other.high))
            assert (moved > 3e5) == name.startswith("r_")
