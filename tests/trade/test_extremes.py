"""Floors of digits at the extremes, and what is lost where it must be lost."""

from __future__ import annotations

import json
import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.measure.judge import block_errors, true_values
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import exactly
from codegen.measure.routine_builds import NATIVE, O2, Build, built
from codegen.spec.request import Variant
from codegen.trade import extremes
from codegen.trade.accuracy import blocks_of
from codegen.trade.extreme_numbers import LINEAR, nan_patterns, scaling_error
from codegen.trade.extreme_places import DISTANCES, DRIFTS, angles, drifts, turns
from codegen.trade.extreme_rank import least_singular_value, rank_variants
from codegen.trade.extreme_table import POSES, ExtremeTable, digits, digits_of_given, least_digits, poses_of, routine_of
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
    for row in drifts().rows:
        effects = [float(cell) for cell in row[2:]]
        assert len(effects) == len(DRIFTS)
        assert max(effects) < 1.1 * min(effects)
        assert max(effects) < 10.0


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
def test_denormal_multipliers_lose_a_few_of_the_least_numbers(variant: Variant) -> None:
    routine = routine_of(variant, "phi_q_t_lambda_q")
    assert scaling_error(routine, -1060) < 64.0


@pytest.mark.parametrize("variant", LINEAR, ids=lambda variant: variant.file_stem)
@pytest.mark.parametrize("output", ["phi", "phi_q", "gamma"])
def test_nan_reaches_exactly_what_depends_on_it(variant: Variant, output: str) -> None:
    for expected, found in nan_patterns(routine_of(variant, output)):
        np.testing.assert_array_equal(expected, found)


def test_the_command_prints_data_and_writes_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extremes, "TABLES", (turns, angles))
    result = invoke("extremes", "--json")
    assert result.exit_code == 0, result.stderr
    data: dict[str, Any] = json.loads(result.stdout)
    assert list(data) == ["turns", "angle"]
    assert invoke("extremes", "-o", tmp_path / "out").exit_code == 0
    assert json.loads((tmp_path / "out/extremes.json").read_text()) == data
    assert (tmp_path / "out/extremes.md").read_text().startswith("# Extremes")
