"""Floors of digits at the extremes, and what is lost where it must be lost."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.measure.judge import block_errors, by_program, true_values
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import exactly
from codegen.measure.routine_builds import NATIVE, O2, Build, built
from codegen.spec.request import Variant
from codegen.trade import extremes
from codegen.trade.extreme_basins import basins_of
from codegen.trade.extreme_engine import singular_values_at
from codegen.trade.extreme_nan import COMPILED, compiled, nan_patterns
from codegen.trade.extreme_numbers import LINEAR, Change, multiplied, scaling_error, stretched
from codegen.trade.extreme_places import DISTANCES, DRIFTING, DRIFTS, angles, drifts, turns
from codegen.trade.extreme_rank import least_singular_value, rank_variants
from codegen.trade.extreme_table import POSES, ExtremeTable, digits, digits_of_given, least_digits, poses_of, routine_of
from codegen.trade.specimens import blocks_of
from tests.cli.runs import invoke

DOUBLE, FLOAT = 15.0, 6.0
"""Digits that are right at every extreme where nothing must be lost."""

MILLIMETRES = 1e-3
DISTANT = [
    Variant("revolute", "conventional", None),
    Variant("planar", "conventional", None, variation="world"),
    Variant("rigid", "conventional", None),
    Variant("ball", "parametric", "regular"),
    Variant("translational", "parametric", "regular"),
    Variant("universal", "parametric", "table4"),
]
COMPILERS = [name for name in ("gcc", "clang") if shutil.which(name)]

each_distant = pytest.mark.parametrize("variant", DISTANT, ids=lambda variant: variant.file_stem)


def far(distance: float) -> PoseDomain:
    return PoseDomain(r=MILLIMETRES, s=MILLIMETRES, d=MILLIMETRES, misfit=MILLIMETRES, distance=distance)


@each_distant
def test_phi_has_15_digits_of_a_millimetre_at_every_distance(variant: Variant) -> None:
    routine = routine_of(variant, "phi")
    for distance in DISTANCES:
        domain = far(distance)
        assert digits_of_given(routine, poses_of(routine, domain), domain, "double") >= DOUBLE, distance


SLIDING = ("translational", "screw", "cylindrical", "planar")


@pytest.mark.parametrize("output", ["phi_q_v", "gamma"])
@pytest.mark.parametrize("variation", ["body", "world"])
def test_velocities_and_gamma_of_joints_that_slide_have_15_digits_at_every_distance(
    variation: str, output: str
) -> None:
    """Of the largest value of the block: with bodies that move by 1 m/s it is no millimetre."""
    for joint in SLIDING:
        routine = routine_of(Variant(joint, "conventional", None, variation=variation), output)
        for distance in (1.0, 1e12):
            given = poses_of(routine, far(distance)).given(np.float64)
            true = true_values(routine.straight, exactly(given))
            (error,) = block_errors(by_program(routine.straight)(given), true, blocks_of(routine), POSES)
            size = max(float(np.max(np.abs(value.high))) for value in true[output])
            assert digits(float(np.max(error)), size) >= DOUBLE, (joint, distance)


@pytest.mark.parametrize("compiler", COMPILERS)
@pytest.mark.parametrize("flags", [O2, NATIVE], ids=["O2", "native"])
def test_no_optimisation_undoes_it(compiler: str, flags: tuple[str, ...], tmp_path: Path) -> None:
    routine = routine_of(DISTANT[0], "phi")
    domain = far(1e12)
    poses = poses_of(routine, domain)
    given = poses.given(np.float64)
    own = tuple(flag for flag in flags if compiler == "gcc" or flag != "-fno-tree-slp-vectorize")
    found = built(routine, Build("far", compiler=compiler, flags=own), tmp_path).values(given)["phi"]
    true = true_values(routine.straight, exactly(given))
    translation, rotation = block_errors({"phi": list(found)}, true, blocks_of(routine), POSES)
    assert digits(float(np.max(translation)), MILLIMETRES) >= DOUBLE
    assert digits(float(np.max(rotation)), 1.0) >= DOUBLE


@each_distant
def test_a_relative_position_has_15_digits_of_the_ideal(variant: Variant) -> None:
    routine = routine_of(variant, "phi")
    domain = far(0.0)
    poses = poses_of(routine, domain)
    assert least_digits(routine, poses.given(np.float64), poses.ideal, domain) >= DOUBLE


def numbers(table: ExtremeTable, *columns: str) -> list[list[float]]:
    places = [table.columns.index(column) for column in columns]
    return [[float(row[place]) for place in places] for row in table.rows]


def test_no_angle_costs_digits() -> None:
    for double, single in numbers(angles(), "double", "float"):
        assert double >= DOUBLE
        assert single >= FLOAT


def test_turns_and_angle_keep_what_one_angle_loses() -> None:
    found = numbers(turns(), "double, one angle", "double, turns and angle", "float, turns and angle")
    assert all(kept >= DOUBLE and single >= FLOAT for _, kept, single in found)
    assert found[-1][0] < 10.0


def test_the_effect_of_drift_is_linear() -> None:
    for row in drifts([pair for pair in DRIFTING if pair[0] == LINEAR[0]]).rows:
        effects = [float(cell) for cell in row[2:]]
        assert len(effects) == len(DRIFTS)
        assert max(effects) < 1.1 * min(effects)
        assert max(effects) < 20.0


@pytest.mark.parametrize("variant", rank_variants(), ids=lambda variant: variant.file_stem)
def test_rank_is_kept_but_by_table4(variant: Variant) -> None:
    least = least_singular_value(variant)
    if variant.rows == "table4":
        assert least.sigma < 1e-7
        assert min(abs(least.angle), abs(math.pi - abs(least.angle))) < 1e-9
    else:
        assert least.sigma >= 0.5


def test_gimbal_lock_takes_a_coordinate_and_no_row() -> None:
    ball = Variant("ball", "parametric", "regular")
    for gap in (1e-2, 1e-4):
        least = least_singular_value(ball, math.pi / 2 - gap)
        assert least.sigma >= 0.5
        assert 0.1 * gap < least.of_coordinates < 10 * gap
    quaternions = least_singular_value(Variant("ball", "parametric", "quaternion"), math.pi / 2)
    assert quaternions.sigma >= 0.5
    assert quaternions.of_coordinates >= 0.5


@pytest.mark.parametrize("variant", LINEAR, ids=lambda variant: variant.file_stem)
def test_multipliers_from_1e_300_to_1e300_change_no_bit(variant: Variant) -> None:
    routine = routine_of(variant, "phi_q_t_lambda_q")
    assert [scaling_error(routine, exponent) for exponent in (-996, -500, 500, 996)] == [0.0] * 4


@pytest.mark.parametrize("variant", LINEAR, ids=lambda variant: variant.file_stem)
@pytest.mark.parametrize(("output", "change"), [("phi_q_t_lambda_q", multiplied), ("phi", stretched)])
def test_denormal_numbers_lose_a_few_of_the_least_ones(variant: Variant, output: str, change: Change) -> None:
    routine = routine_of(variant, output)
    assert scaling_error(routine, -1060, "double", change) < 64.0
    assert scaling_error(routine, -140, "float", change) < 64.0


@pytest.mark.parametrize("variant", LINEAR, ids=lambda variant: variant.file_stem)
def test_single_precision_and_lengths_scale_without_a_change_of_bits(variant: Variant) -> None:
    product = routine_of(variant, "phi_q_t_lambda_q")
    assert [scaling_error(product, exponent, "float") for exponent in (-100, -50, 50, 100)] == [0.0] * 4
    phi = routine_of(variant, "phi")
    assert [scaling_error(phi, exponent, "double", stretched) for exponent in (-996, -500, 500, 996)] == [0.0] * 4


@pytest.mark.parametrize("variant", LINEAR, ids=lambda variant: variant.file_stem)
@pytest.mark.parametrize("output", ["phi", "phi_q", "gamma"])
def test_nan_reaches_exactly_what_depends_on_it(variant: Variant, output: str) -> None:
    routine = routine_of(variant, output)
    for run in (None, *(compiled(routine, choice) for choice in COMPILED)):
        for expected, found in nan_patterns(routine, run):
            np.testing.assert_array_equal(expected, found)


def test_the_engine_has_rank_21_at_dead_centre_with_regular_rows_and_18_with_table4() -> None:
    for degrees in (0, 90, 180):
        assert singular_values_at("conventional", None, degrees)[-1] > 0.1
        regular = singular_values_at("parametric", "regular", degrees)
        assert len(regular) == 21
        assert regular[-1] > 0.05
    for degrees in (0, 180):
        assert np.sum(singular_values_at("parametric", "table4", degrees) > 1e-9) == 18


def test_newton_closes_joints_from_30_degrees_and_finds_other_branches_from_150() -> None:
    for variant in (LINEAR[0], LINEAR[1]):
        near, far = basins_of(variant, (30, 150), 32)
        assert near.right == 1.0
        assert far.wrong > 0.5
        assert near.right + near.wrong + near.failed == 1.0
    (free,) = basins_of(Variant("ball", "conventional", None), (180,), 32)
    assert free.right == 1.0


def test_the_command_prints_data_and_writes_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extremes, "TABLES", (turns, angles))
    result = invoke("extremes", "--json")
    assert result.exit_code == 0, result.stderr
    data: dict[str, Any] = json.loads(result.stdout)
    assert list(data) == ["turns", "angle"]
    assert invoke("extremes", "-o", tmp_path / "out").exit_code == 0
    assert json.loads((tmp_path / "out/extremes.json").read_text()) == data
    assert (tmp_path / "out/extremes.md").read_text().startswith("# Extremes")
