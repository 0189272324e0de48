"""The printed tables agree with each other, and where they do not there is a footnote."""

import pytest

from flopcount import paper


def test_tables_name_the_same_joints() -> None:
    assert tuple(paper.TABLE_1) == tuple(paper.TABLE_5) == tuple(paper.TABLE_7) == paper.JOINTS
    assert tuple(paper.TABLE_2) == paper.BASIC_CONSTRAINTS


@pytest.mark.parametrize("joint", paper.JOINTS)
def test_printed_rates_follow_from_the_printed_counts(joint: str) -> None:
    line = paper.TABLE_7[joint]
    for derivative, rate in zip(paper.DERIVATIVES, line.printed_rates, strict=True):
        misprinted = (joint, derivative) == ("ball", "phi_q_t_lambda_q")
        assert (round(line.rate(derivative), 1) == rate) is not misprinted


def test_misprinted_rate_of_the_ball_joint() -> None:
    note = paper.FOOTNOTES["ball-rate"]
    line = paper.TABLE_7["ball"]
    assert note.printed == f"{line.printed_rates[1]}"
    assert note.correct == f"{line.rate('phi_q_t_lambda_q'):.1f}"


def test_planar_has_three_coordinates_with_rot1_only() -> None:
    degrees_of_freedom = 3
    parts = paper.TABLE_5["planar"]
    assert parts.translation + parts.rotation == degrees_of_freedom
    assert "rot1" in paper.FOOTNOTES["planar"].correct
    assert "rot0" in str(paper.FOOTNOTES["planar"])


def test_proposed_method_is_not_faster_in_table_8() -> None:
    assert all(line.proposed >= line.conventional for line in paper.TABLE_8)
