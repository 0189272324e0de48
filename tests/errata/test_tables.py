"""S1, Tables 4 to 8."""

import numpy as np
import pytest

from flopcount import paper
from tests.reference.constraints import alpha_size, pair

from . import tables
from .claims import EXACT, VISIBLE, error, error_as_printed, error_corrected, error_elsewhere
from .confirmed import TABLE_4, TABLE_6_TRN
from .misprints import TABLE_6

ROTATING = tuple(joint for joint in paper.JOINTS if pair(joint)[1] > 0)
SECOND = "phi_q_t_lambda_q"


def test_table_4_as_printed_is_right() -> None:
    assert error(TABLE_4) < EXACT


@pytest.mark.parametrize("joint", ROTATING)
@pytest.mark.parametrize("angle", [0.0, np.pi])
def test_table_4_loses_rank_in_the_reference_pose(joint: str, angle: float) -> None:
    rotations = 1 if joint == "screw" else pair(joint)[1]
    angles = (angle, *(0.5,) * (rotations - 1))
    assert np.max(tables.smallest_singular_values(joint, "table4", angles)) < EXACT
    assert np.min(tables.smallest_singular_values(joint, "regular", angles)) > 0.5


def test_table_4_loses_rank_in_proportion_to_the_sine() -> None:
    for angle in (0.01, 0.001):
        ratio = tables.smallest_singular_values("revolute", "table4", (angle,)) / np.sin(angle)
        assert np.all((ratio > 1.4) & (ratio < 1.8))


def test_table_4_rot3_keeps_its_rank_at_a_middle_angle_of_zero() -> None:
    assert np.min(tables.smallest_singular_values("ball", "table4", (0.5, 0.0, 0.6))) > 0.5


def test_table_5_planar_as_printed_cannot_turn_about_its_normal() -> None:
    assert tables.planar_residual_conventional() < EXACT
    assert tables.planar_residual(tables.PLANAR_AS_PRINTED) > VISIBLE
    assert tables.freedom(tables.PLANAR_AS_PRINTED) == 2


def test_table_5_planar_corrected_is_the_planar_joint() -> None:
    assert tables.planar_residual(tables.PLANAR_CORRECTED) < EXACT
    assert tables.freedom(tables.PLANAR_CORRECTED) == 3


@pytest.mark.parametrize("joint", [joint for joint in paper.JOINTS if joint != "planar"])
def test_table_5_other_joints_have_the_degrees_of_freedom_of_table_1(joint: str) -> None:
    assert tables.freedom(joint) == alpha_size(joint, "parametric")


def test_table_6_translational_column_as_printed_is_right() -> None:
    assert error(TABLE_6_TRN) < EXACT


@pytest.mark.parametrize("joint", TABLE_6)
def test_table_6_rotational_column_as_printed_inherits_eq_32_and_38(joint: str) -> None:
    assert error_as_printed(TABLE_6[joint]) > VISIBLE
    assert error_elsewhere((TABLE_6[joint],)) < EXACT


@pytest.mark.parametrize("joint", TABLE_6)
def test_table_6_with_eq_32_and_38_corrected_is_right(joint: str) -> None:
    assert error_corrected(TABLE_6[joint]) < EXACT


def test_table_7_rate_of_the_ball_joint_as_printed_is_wrong() -> None:
    line = paper.TABLE_7["ball"]
    assert line.printed_rates[1] == 494.4
    assert round(line.rate(SECOND), 1) == 494.9


def test_table_7_other_thirteen_rates_as_printed_are_right() -> None:
    rates = [
        (round(line.rate(derivative), 1), printed)
        for line in paper.TABLE_7.values()
        for derivative, printed in zip(paper.DERIVATIVES, line.printed_rates, strict=True)
    ]
    assert sum(rate == printed for rate, printed in rates) == 13


def test_table_7_counts_the_planar_joint_with_rot1() -> None:
    """One more translational coordinate than the cylindrical joint, so one more product of 9 operations."""
    second = {joint: line.proposed.of(SECOND) for joint, line in paper.TABLE_7.items()}
    assert second["planar"] - second["cylindrical"] == second["translational"] == 9


def test_table_8_grows_with_the_number_of_sets_as_seconds_do() -> None:
    one, *more = paper.TABLE_8
    for line in more:
        assert 0.9 < line.conventional / one.conventional / line.sets < 1.1
        assert 0.9 < line.proposed / one.proposed / line.sets < 1.1
