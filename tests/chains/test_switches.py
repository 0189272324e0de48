"""Switched forces on a mass on a slide, whose motion is known piece by piece."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction as F

import numpy as np
import pytest

from codegen.chains.mechanism import Mechanism
from codegen.spec.chain import BASE, Chain, Effector, Frame, Row
from codegen.spec.chain_forces import Condition, EffectorForce, JointForce
from codegen.spec.chain_motions import Independent

from .mechanisms import ZERO, link, row
from .runs import by_table, forward_run, generated

TIMES = np.linspace(0.0, 4.0, 9)
ZONE = Condition("mass", F("0.5"), F("1.5"), 1)


def sliding(*forces: JointForce, speed: F = F(1), position: F = F(0)) -> Chain:
    """A mass of 1 kg on a slide along x; no gravity."""
    mass = link("mass", BASE, row(psi=0, alpha=F("1.5707963267948966192313216916397514420985")), 1, type="prismatic")
    return Chain("mass", ZERO, (mass,), (), (), (Independent("mass", None, position, speed),), forces)


def test_a_brake_in_a_zone_takes_its_work() -> None:
    run = forward_run(by_table(sliding(JointForce("mass", F("-0.3"), when=ZONE))), TIMES, 1e-10)
    slow = np.sqrt(1 - 2 * 0.3)
    leaves = 0.5 + (1 - slow) / 0.3
    assert run.events == 2
    assert run.states[-1].qd[0] == pytest.approx(slow, abs=1e-9)
    assert run.states[-1].q[0] == pytest.approx(1.5 + slow * (4.0 - leaves), abs=1e-8)


def test_a_force_that_acts_one_way_only_is_gone_on_the_way_back() -> None:
    """Uphill against 1 N and a brake of 0.5 N, downhill without the brake."""
    brake = JointForce("mass", F("-0.5"), when=Condition("mass", None, None, 1))
    run = forward_run(by_table(sliding(JointForce("mass", F(-1)), brake, speed=F(2))), TIMES, 1e-10)
    top, turns = 2.0**2 / (2 * 1.5), 2.0 / 1.5
    assert run.events == 1
    for state in run.states:
        if state.t > turns:
            assert state.q[0] == pytest.approx(top - (state.t - turns) ** 2 / 2, abs=1e-8)
            assert state.loads is not None and state.loads.tau[0] == -1.0


def test_a_start_on_a_bound_is_inside_or_outside_by_where_it_goes() -> None:
    inwards = forward_run(by_table(sliding(JointForce("mass", F("-0.3"), when=ZONE), position=F("0.5"))), TIMES, 1e-10)
    outwards = forward_run(by_table(sliding(JointForce("mass", F("-0.3"), when=ZONE), position=F("1.5"))), TIMES, 1e-10)
    assert inwards.states[-1].qd[0] == pytest.approx(np.sqrt(1 - 2 * 0.3), abs=1e-9)
    assert outwards.states[-1].qd[0] == pytest.approx(1.0, abs=1e-9)


def test_a_start_at_rest_begins_to_move_under_a_force_that_needs_motion() -> None:
    push = JointForce("mass", F(1), when=Condition("mass", None, None, 1))
    run = forward_run(by_table(sliding(JointForce("mass", F(1)), push, speed=F(0))), TIMES, 1e-10)
    assert run.states[-1].qd[0] == pytest.approx(8.0, abs=1e-8)


def test_forces_that_switch_without_end_stop_the_run() -> None:
    """1 N pushes, 2 N hold as soon as the mass moves: it sticks."""
    hold = JointForce("mass", F(-2), when=Condition("mass", None, None, 1))
    run = forward_run(by_table(sliding(JointForce("mass", F(1)), hold)), TIMES, 1e-10)
    assert "forces switch without end at t = 1 s" in run.failure
    assert run.states[-1].t == 0.5 or run.states[-1].t == 1.0


@pytest.mark.parametrize("made", [by_table, generated])
def test_a_switched_wrench_at_an_effector_acts_along_its_own_axes(made: Callable[[Chain], Mechanism]) -> None:
    """The tool's x is the slide's z."""
    chain = sliding()
    tool = Effector("tool", Frame("mass", Row(psi=F(0), theta=F(0))), ZERO, ZERO)
    wrench = EffectorForce("tool", (F(5), F(7), F("-0.3")), ZERO, ZONE)
    changed = Chain(chain.name, ZERO, chain.links, (), (tool,), chain.independents, (), (wrench,))
    run = forward_run(made(changed), TIMES, 1e-10)
    assert run.states[-1].qd[0] == pytest.approx(np.sqrt(1 - 2 * 0.3), abs=1e-9)
