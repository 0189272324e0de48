"""Routines that mend attitudes and say on which branch a joint was closed, compiled, against other ways to know it."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import polar
from scipy.spatial.transform import Rotation

from codegen import build
from codegen.attitudes import attitude_routines
from codegen.errors import SpecificationError
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.routine_builds import NATIVE, O2, Build, built
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import ATTITUDES, Options, Variant
from codegen.trade.extreme_table import poses_of, routine_of
from tests.cli.runs import invoke

Array = NDArray[np.float64]
ORTHONORMALISE, CHECK = attitude_routines(ATTITUDES)
HALF_ULP = {"double": 2.0**-53, "float": 2.0**-24}
BUILDS = {
    "double": Build("double"),
    "float": Build("float", "float"),
    "4 lanes": Build("4 lanes", lanes=4, flags=("-O3", "-march=native", *O2[1:])),
    "contracted": Build("contracted", flags=NATIVE),
}
each_build = pytest.mark.parametrize("choice", BUILDS.values(), ids=BUILDS)


def rotations(count: int) -> Array:
    return Rotation.random(count, rng=np.random.default_rng(1)).as_matrix()


def drifted(count: int, drift: float) -> Array:
    noise = np.random.default_rng(2).uniform(-1.0, 1.0, (count, 3, 3))
    noise /= np.linalg.norm(noise, 2, axis=(1, 2))[:, None, None]
    return np.asarray(rotations(count) + drift * noise)


def columns(matrices: Array, real: str = "double") -> dict[str, Any]:
    kind = np.float32 if real == "float" else np.float64
    return {"A": np.moveaxis(matrices, 0, -1).transpose(1, 0, 2).reshape(9, -1).astype(kind)}


def run(routine: Any, choice: Build, matrices: Array, folder: Path) -> Array:
    found = built(routine, choice, folder).values(columns(matrices, choice.real))[routine.output]
    return np.asarray(found, dtype=np.float64).T


def nearest_rotation(matrix: Array) -> Array:
    """By singular values in 40 digits."""
    with mpmath.workdps(40):
        U, _, V = mpmath.svd_r(mpmath.matrix(matrix.tolist()))
        return np.array((U * V).tolist(), dtype=np.float64)


@each_build
@pytest.mark.parametrize("drift", [1e-12, 1e-6, 0.02])
def test_the_nearest_rotation_to_rounding(choice: Build, drift: float, tmp_path: Path) -> None:
    given = columns(drifted(8, drift), choice.real)["A"].astype(np.float64).T.reshape(-1, 3, 3).transpose(0, 2, 1)
    found = run(ORTHONORMALISE, choice, given, tmp_path).reshape(-1, 3, 3).transpose(0, 2, 1)
    expected = np.array([nearest_rotation(matrix) for matrix in given])
    assert np.max(np.abs(found - expected)) <= 4 * HALF_ULP[choice.real]


def test_what_is_off_by_a_tenth_is_off_by_1e_9_afterwards(tmp_path: Path) -> None:
    given = drifted(64, 0.1)
    found = run(ORTHONORMALISE, BUILDS["double"], given, tmp_path).reshape(-1, 3, 3).transpose(0, 2, 1)
    errors = [np.max(np.abs(mine - polar(matrix)[0])) for mine, matrix in zip(found, given, strict=True)]
    assert 1e-15 < max(errors) < 1e-9


def test_a_mirrored_attitude_stays_mirrored_and_a_singular_one_gives_no_numbers(tmp_path: Path) -> None:
    given = drifted(8, 1e-3) * np.array([1.0, 1.0, -1.0])
    found = run(ORTHONORMALISE, BUILDS["double"], given, tmp_path).reshape(-1, 3, 3).transpose(0, 2, 1)
    np.testing.assert_allclose(np.linalg.det(found), -1.0, rtol=1e-15)
    flat = np.diag([1.0, 1.0, 0.0])[None]
    assert not np.all(np.isfinite(run(ORTHONORMALISE, BUILDS["double"], flat, tmp_path)))


@each_build
def test_the_check_is_the_distance_from_the_cofactors_and_0_for_rotations_only(choice: Build, tmp_path: Path) -> None:
    exact, off = rotations(16), drifted(16, 1e-2)
    mirrored = exact * np.array([-1.0, 1.0, 1.0])
    assert np.max(run(CHECK, choice, exact, tmp_path)) <= 16 * HALF_ULP[choice.real]
    cofactors = [np.linalg.det(A) * np.linalg.inv(A).T for A in off]
    expected = [np.hypot(np.linalg.norm(A - C), np.linalg.det(A) - 1) for A, C in zip(off, cofactors, strict=True)]
    few = 16 * HALF_ULP[choice.real]
    np.testing.assert_allclose(run(CHECK, choice, off, tmp_path)[:, 0], expected, rtol=0, atol=few)
    np.testing.assert_allclose(run(CHECK, choice, mirrored, tmp_path)[:, 0], 4.0, atol=few)
    np.testing.assert_allclose(run(CHECK, choice, 0 * exact, tmp_path)[:, 0], 1.0)


# --- branches

WITHOUT = ("universal", "ball")
"""Joints that have one branch in the conventional form."""

VARIANTS = [Variant(name, "conventional", None) for name in JOINTS if JOINTS[name].conventional]
VARIANTS += [Variant(name, "parametric", "regular") for name in ("translational", "universal")]
VARIANTS += [
    Variant("revolute", "parametric", "regular", "substituted"),
    Variant("ball", "parametric", "quaternion"),
    Variant("translational", "conventional", None, variation="world"),
]
each_variant = pytest.mark.parametrize("variant", VARIANTS, ids=lambda variant: variant.file_stem)


def values(variant: Variant, output: str, given: dict[str, Any]) -> Array:
    routine = routine_of(variant, output)
    return np.asarray(by_program(routine.straight)(given)[output])


@each_variant
def test_a_joint_that_is_closed_as_meant_is_on_branch_1(variant: Variant) -> None:
    given = poses_of(routine_of(variant, "phi"), PoseDomain()).given(np.float64)
    np.testing.assert_allclose(values(variant, "branch", given), 1.0, atol=1e-14)


def turned(given: dict[str, Any], axis: int) -> dict[str, Any]:
    """Body j turned by half a turn about an axis of its joint frame, through its attachment point."""
    found = dict(given)
    A = given["A_j"].reshape(3, 3, -1).transpose(1, 0, 2)
    C = given["geometry"][15:24].reshape(3, 3, -1).transpose(1, 0, 2)
    s = given["geometry"][12:15]
    half = -np.eye(3)
    half[axis, axis] = 1.0
    moved = np.einsum("abp,bcp,cd,edp->aep", A, C, half, C)
    found["A_j"] = moved.transpose(1, 0, 2).reshape(9, -1)
    found["r_j"] = given["r_j"] + np.einsum("abp,bp->ap", A - moved, s)
    return found


@pytest.mark.parametrize("variant", [v for v in VARIANTS if v.joint != "screw"], ids=lambda variant: variant.file_stem)
def test_half_a_turn_off_satisfies_the_constraint_and_is_on_branch_minus_1(variant: Variant) -> None:
    given = turned(poses_of(routine_of(variant, "phi"), PoseDomain()).given(np.float64), axis=0)
    is_free = variant.form == "conventional" and variant.joint in WITHOUT
    np.testing.assert_allclose(values(variant, "phi", given), 0.0, atol=1e-14)
    np.testing.assert_allclose(values(variant, "branch", given), 1.0 if is_free else -1.0, atol=1e-14)


def test_the_other_angle_of_table4_has_a_branch_below_1() -> None:
    variant = Variant("revolute", "parametric", "table4")
    given = poses_of(routine_of(variant, "phi"), PoseDomain()).given(np.float64)
    angle = given["alpha"]
    given["alpha"] = -angle
    np.testing.assert_allclose(values(variant, "phi", given), 0.0, atol=1e-14)
    np.testing.assert_allclose(values(variant, "branch", given)[0], np.cos(2 * angle[0]), atol=1e-14)


# --- packages


def test_a_package_has_these_routines_where_they_are_asked_for() -> None:
    options = Options(("ball",), "conventional", variation="body", outputs=("branch", "orthonormalise"))
    functions = json.loads(build.generate(options)["manifest.json"])["functions"]
    assert [entry["symbol"] for entry in functions] == [
        "jg_ball_conventional_branch",
        "jg_attitude_orthonormalise",
    ]
    assert functions[1]["of"] == "attitude"
    assert functions[1]["operations"]["total"] == ORTHONORMALISE.counts.total


def test_a_package_of_attitudes_needs_no_joint(tmp_path: Path) -> None:
    asked = ("--outputs", "orthonormalise,check_orthonormal", "--real", "float", "--batch", "8")
    assert invoke("generate", *asked, "-o", tmp_path / "out").exit_code == 0
    assert sorted(path.name for path in (tmp_path / "out/c/src").iterdir()) == ["attitude.c", "attitude_batch8.c"]


def test_what_nobody_asked_for_is_not_emitted() -> None:
    options = Options(("ball",), "conventional", variation="body")
    text = build.generate(options)["manifest.json"].decode()
    assert "branch" not in text
    assert "attitude" not in text.replace("attitudes", "")


def test_an_output_that_there_is_not_is_refused() -> None:
    with pytest.raises(SpecificationError, match="orthonormalise"):
        build.generate(Options(("ball",), outputs=("orthonormalize",)))
