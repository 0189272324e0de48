"""Where a misprint of S1 hides: special geometries, special angles, no force on alpha."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from . import motion
from .claims import EXACT, VISIBLE, Misprint, error_as_printed
from .misprints import EQ_6, EQ_7, EQ_8, EQ_9, EQ_19_S_J, EQ_28, EQ_31_ROW_2, EQ_31_ROW_3, EQ_32_ROW_2, EQ_36, EQ_38
from .situations import SEEDS, Situation, draw, with_alpha


def where(misprint: Misprint, change: Callable[[Situation], Situation]) -> Misprint:
    """The same misprint at changed situations."""
    return replace(misprint, situations=lambda: tuple(change(s) for s in misprint.situations()))


def centred_on_body_j(s: Situation) -> Situation:
    return with_alpha(replace(s, geometry=replace(s.geometry, s_j=np.zeros(3))), s.pose.alpha)


def at(angle: float) -> Callable[[Situation], Situation]:
    return lambda s: with_alpha(s, np.array([s.offset, angle]))


@pytest.mark.parametrize("misprint", [EQ_6, EQ_8, *EQ_9, EQ_19_S_J], ids=lambda m: m.equation)
def test_eq_6_8_9_19_hide_where_s_j_is_zero(misprint: Misprint) -> None:
    assert error_as_printed(where(misprint, centred_on_body_j)) < EXACT


def test_eq_7_hides_where_both_bodies_have_one_attitude() -> None:
    def aligned(s: Situation) -> Situation:
        return replace(s, pose=replace(s.pose, A_j=s.A_i))

    assert error_as_printed(where(EQ_7, aligned)) < EXACT


@pytest.mark.parametrize("angle", [0.0, np.pi])
@pytest.mark.parametrize("misprint", [EQ_28, EQ_31_ROW_3], ids=lambda m: m.equation)
def test_eq_28_31_row_3_hides_in_the_reference_pose(misprint: Misprint, angle: float) -> None:
    assert error_as_printed(where(misprint, at(angle))) < EXACT


@pytest.mark.parametrize("misprint", [EQ_31_ROW_2, EQ_32_ROW_2], ids=lambda m: m.equation)
def test_eq_31_32_row_2_hides_at_a_quarter_turn_and_is_worst_in_the_reference_pose(misprint: Misprint) -> None:
    assert error_as_printed(where(misprint, at(np.pi / 2))) < EXACT
    assert error_as_printed(where(misprint, at(0.0))) > 1


def test_eq_36_hides_without_a_force_on_alpha() -> None:
    def without_force(s: Situation) -> Situation:
        return replace(s, lam_rot=s.lam_rot * [1, 1, 0])

    assert error_as_printed(where(EQ_36, without_force)) < EXACT


def test_eq_38_hides_where_the_frame_of_body_i_is_its_own() -> None:
    def own_frame(s: Situation) -> Situation:
        return with_alpha(replace(s, geometry=replace(s.geometry, C_i=np.eye(3))), s.pose.alpha)

    assert error_as_printed(where(EQ_38, own_frame)) < EXACT


def test_row_3_corrected_moves_the_bodies_by_action_and_reaction() -> None:
    for torque in (0.0, motion.TORQUE):
        assert motion.error_of_acceleration(torque, motion.as_corrected) < EXACT


def test_eq_32_row_3_as_printed_is_invisible_while_no_force_acts_on_alpha() -> None:
    assert motion.error_of_acceleration(0.0, motion.as_printed) < EXACT
    assert motion.error_of_angle(0.0) < EXACT


def test_eq_32_row_3_as_printed_moves_wrongly_as_soon_as_one_does() -> None:
    assert motion.error_of_acceleration(motion.TORQUE, motion.as_printed) > VISIBLE
    assert motion.error_of_angle(motion.TORQUE) > VISIBLE


def test_eq_32_row_3_as_printed_makes_angular_momentum_out_of_nothing() -> None:
    s, torque = motion.start().s, motion.TORQUE
    gain = motion.rate_of_angular_momentum(torque, motion.as_printed)
    np.testing.assert_allclose(gain, 2 * torque * s.h_i, atol=EXACT)
    np.testing.assert_allclose(motion.rate_of_angular_momentum(torque, motion.as_corrected), 0, atol=EXACT)


def test_eq_32_row_3_as_printed_is_invisible_where_body_i_is_the_ground() -> None:
    assert motion.error_with_body_i_held(motion.TORQUE) < EXACT


def test_eq_32_row_3_as_printed_gives_the_wrong_alphadot_even_without_a_force() -> None:
    assert motion.error_of_alpha_rate(motion.as_printed) > VISIBLE
    assert motion.error_of_alpha_rate(motion.as_corrected) < EXACT


def test_eq_32_row_3_as_printed_costs_newton_its_speed_even_without_a_force() -> None:
    assert max(motion.newton_steps(motion.as_corrected)) <= motion.NEWTON_FEW
    assert min(motion.newton_steps(motion.as_printed)) == motion.NEWTON_LIMIT


def test_eq_32_row_2_as_printed_moves_wrongly_without_a_force() -> None:
    assert motion.error_of_acceleration(0.0, motion.with_row_2_as_printed) > VISIBLE


def test_situations_are_general() -> None:
    """No axis of a joint frame is near an axis of its body, and no angle near a multiple of a quarter turn."""
    for seed in SEEDS:
        s = draw("cylindrical", seed)
        assert max(np.max(np.abs(s.C_i)), np.max(np.abs(s.C_j))) < 1 - VISIBLE / 10
        assert abs(np.sin(2 * s.angle)) > VISIBLE
