"""Compiled motion under forces does what the careful one does, and leaves to it what is not beyond doubt."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from typing import Any

import numpy as np
import pytest

from codegen.chains.afloat import afloat
from codegen.chains.mechanism import Mechanism
from codegen.chains.moving import Moving
from codegen.spec.chain import BASE, Chain, Effector, Frame, Row
from codegen.spec.chain_file import read_chain
from codegen.spec.chain_forces import Condition, JointForce, WorldForce
from codegen.spec.chain_motions import Independent
from tests.reference import quick_return as planar
from tests.reference import spatial_slider_crank as spatial

from .mechanisms import RIGHT, four_bar, link, quick_return, row, spatial_slider_crank, three_cranks
from .runs import forward_run, generated


class Careful:
    """Equations without compiled motion."""

    def __init__(self, equations: Any) -> None:
        self._equations = equations

    def __getattr__(self, name: str) -> Any:
        return getattr(self._equations, name)

    def code(self, *_: object) -> None:
        """There is none."""


def careful(ready: Mechanism) -> Mechanism:
    return replace(ready, equations=Careful(ready.equations))  # type: ignore[arg-type]


def cutting() -> Chain:
    """The quick return from where cutting ends: switches change."""
    return quick_return(1000, start=F(planar.crossings()[1]), drive=True)


def shaken() -> Chain:
    """A base of which one coordinate is driven and the others rest, under a pendulum of two bars."""
    bar = 'type = "revolute"\nmass = 2\ncentre = [0.5, 0, 0]\ninertia = [0.01, 0.1, 0.1]\n'
    return afloat(
        read_chain(
            'name = "bars"\ngravity = [0, -9.81, 0]\nbase = "moving"\n'
            f'[[link]]\nname = "upper"\nparent = "base"\n{bar}[[link]]\nname = "lower"\nparent = "upper"\na = 1\n{bar}'
            '[[independent]]\njoint = "base x"\ndriven = true\nharmonic = { amplitude = 0.2, frequency = 7.0 }\n'
            '[[independent]]\njoint = "upper"\n[[independent]]\njoint = "lower"\nspeed = 1.5\n',
            "bars.toml",
        )
    )


CHAINS = {
    "switches": (cutting, 0.1),
    "more rows than it takes": (lambda: replace(three_cranks(), joint_forces=(JointForce("crank 1", F(30)),)), 0.4),
    "driven": (shaken, 0.4),
}


@pytest.mark.parametrize("name", CHAINS)
def test_compiled_and_careful_motion_are_one_motion(name: str) -> None:
    make, duration = CHAINS[name]
    ready, times = generated(make()), np.linspace(0.0, duration, 4)
    runs = [forward_run(one, times, 1e-9) for one in (ready, careful(ready))]
    fast, slow = runs
    assert not fast.failure and not slow.failure
    assert fast.events == slow.events
    assert abs(fast.evaluations - slow.evaluations) < 0.02 * slow.evaluations
    for one, other in zip(fast.states, slow.states, strict=True):
        for part in ("q", "qd", "qdd"):
            a, b = getattr(one, part), getattr(other, part)
            assert np.max(np.abs(a - b)) < 1e-9 * max(1.0, float(np.max(np.abs(b)))), part
        assert one.loads is not None and other.loads is not None
        assert one.loads.reaction == pytest.approx(other.loads.reaction, rel=1e-8, abs=1e-7)


def test_where_branches_end_the_careful_motion_tells_it() -> None:
    """A crank without mass is driven to where it locks, at 0.1106 s; a pendulum beside it is free."""
    chain = spatial_slider_crank(F(str(spatial.lock_up().evalf(30))) - F("1e-4"))
    pendulum = link("pendulum", BASE, row(alpha=RIGHT), 1, (F(1, 10), 0, 0), (F(1, 100),) * 3)
    links = (replace(one, mass=F(0), inertia=((F(0),) * 3,) * 3) for one in chain.links)
    (crank,) = chain.independents
    independents = (replace(crank, driven=True), Independent("pendulum"))
    ready = generated(replace(chain, links=(*links, pendulum), independents=independents))
    run = forward_run(ready, np.linspace(0.0, 0.2, 9), 1e-6)
    assert "no solution" in run.failure and "last closed pose: crank" in run.failure
    assert [state.t for state in run.states] == pytest.approx([0.0, 0.025, 0.05, 0.075, 0.1])


def test_refused_steps_are_taken_with_care(monkeypatch: pytest.MonkeyPatch) -> None:
    ready, times = generated(spatial_slider_crank()), np.linspace(0.0, 0.2, 6)
    whole = forward_run(ready, times, 1e-9)
    compiled, asked = Moving.solver, []

    def sometimes(self: Moving, *arguments: Any) -> Any:
        asked.append(len(asked))
        return compiled(self, *arguments) if len(asked) % 2 else None

    def shortly(self: Any, until: float) -> bool:
        return False

    monkeypatch.setattr(Moving, "solver", sometimes)
    monkeypatch.setattr("codegen.chains.rate_solver.RateSolver.run", shortly)
    mixed = forward_run(ready, times, 1e-9)
    assert len(asked) > 4
    for one, other in zip(mixed.states, whole.states, strict=True):
        assert one.q == pytest.approx(other.q, abs=1e-10)


def test_a_switched_force_in_axes_of_the_world_pushes_along_them_while_it_acts() -> None:
    """A bar that turns without gravity: the force does ``F . way of its point``."""
    text = """
name = "bar"
[[link]]
name = "bar"
parent = "base"
type = "revolute"
mass = 2
centre = [0.5, 0, 0]
inertia = [0.01, 0.1, 0.1]
[[effector]]
name = "tip"
link = "bar"
a = 1.0
theta = 0.4
[[independent]]
joint = "bar"
speed = 1.0
[[force]]
effector = "tip"
force = [0, 3, 0]
axes = "world"
when = { joint = "bar", lower = 0.2, upper = 0.9, direction = "growing" }
"""
    ready = generated(read_chain(text, "bar.toml"))
    run = forward_run(ready, np.linspace(0.0, 2.0, 3), 1e-11)
    inertia = 0.1 + 2 * 0.25
    assert run.events == 2
    gained = 3 * (np.sin(0.9) - np.sin(0.2))
    assert run.states[-1].qd[0] == pytest.approx(np.sqrt(1 + 2 * gained / inertia), abs=1e-9)


def test_routines_of_a_package_leave_switched_forces_out_in_all_axes() -> None:
    tip = Effector("tip", Frame("crank 1", Row()), (F(0),) * 3, (F(0),) * 3)
    force = WorldForce("tip", (F(1),) * 3, (F(0),) * 3, Condition("crank 1", None, None, 1))
    chain = replace(four_bar(), effectors=(tip,), world_forces=(force,))
    assert "f_A" not in chain.wanted and chain.conditions == (force.when,)
