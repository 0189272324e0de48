"""Each switch brings the cells that it claims to the printed number, and changes no other cell."""

import pytest

from flopcount.rules import SWITCHES, cells, explain, printed, tally
from flopcount.rules.switches import Cell


def count(cell: Cell, *switches: str) -> int:
    return tally(cell.name, cell.derivative, cell.form, switches=switches)


@pytest.mark.parametrize("name", SWITCHES)
def test_switch_changes_exactly_what_it_claims(name: str) -> None:
    changed = {cell for cell in cells() if count(cell, name) != count(cell)}
    assert changed == set(SWITCHES[name].changes)
    assert len(SWITCHES[name].changes) == len(changed)


@pytest.mark.parametrize("name", SWITCHES)
def test_switch_explains_the_printed_number(name: str) -> None:
    switch = SWITCHES[name]
    assert switch.assumption and "Against it:" in switch.justification
    for cell in switch.explains:
        assert count(cell) != printed(cell) == count(cell, name)
    for cell in switch.also_changes:
        assert count(cell, name) != printed(cell)


def test_with_all_switches_only_the_ball_joint_is_left() -> None:
    left = {cell for cell in cells() if count(cell, *SWITCHES) != printed(cell)}
    assert left == {Cell("parametric", "ball", "phi_q_t_lambda_q")}


def test_zero_row_explains_five_cells_by_six() -> None:
    switch = SWITCHES["zero-row"]
    assert [cell.name for cell in switch.explains] == [
        "revolute",
        "screw",
        "cylindrical",
        "universal",
        "planar",
    ]
    assert {count(cell) - count(cell, "zero-row") for cell in switch.changes} == {6}


def test_switches_are_off_by_default_and_named_in_the_explanation() -> None:
    for name, switch in SWITCHES.items():
        for cell in switch.changes:
            plain = explain(cell.name, cell.derivative, cell.form)
            amended = explain(cell.name, cell.derivative, cell.form, switches=(name,))
            assert not any(term.rule in SWITCHES for term in plain)
            assert switch.structure or any(term.rule == name for term in amended)
