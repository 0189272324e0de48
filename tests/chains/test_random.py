"""Random trees with cuts, revolute and prismatic joints, massless links and several independent coordinates."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from functools import cache

import numpy as np
import pytest
from scipy.linalg import qr

from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism
from codegen.chains.record import Record, balance, record
from codegen.chains.reduced import reduced
from codegen.chains.run import Run
from codegen.chains.state import generalised
from codegen.spec.chain import Chain, Link
from codegen.spec.chain_forces import EffectorForce, JointForce
from codegen.spec.chain_motions import Independent, Polynomial
from tests.mechanics.chain.trees import NONE, tree

from .mechanisms import four_bar
from .runs import by_table, forward_run, generated, prescribed_run
from .table import TableEquations

CASES = ((1, 9, 1), (4, 10, 1), (8, 14, 2))
"""Seed, links, cuts."""

STEP = 1e-4
TIMES = np.array([0.0, STEP, 2 * STEP])


def closed(seed: int, size: int, cuts: int) -> Chain:
    """A random chain at a pose in which it is closed; as many coordinates move as the cuts leave free."""
    chain, q = tree(seed, size, cuts, 1)
    links = tuple(_at(link, value) for link, value in zip(chain.links, q, strict=True))
    J = TableEquations(chain).jacobian(q)
    _, R, order = qr(J, pivoting=True)
    pivots = np.abs(np.diagonal(R))
    free = sorted(order[int(np.sum(pivots > 1e-9 * pivots[0])) :])
    random = np.random.default_rng(seed)
    independents = tuple(
        Independent(links[k].name, Polynomial((F(float(q[k])), *(F(float(x)) for x in random.normal(size=2)))))
        for k in free
    )
    forces = (JointForce("link 2", F(1), F(2), F(3), F("0.1")), JointForce(f"link {size - 1}", F(-2)))
    wrench = EffectorForce("tool 0", (F(1), F(2), F(3)), (F(-1), F("0.5"), F(2)))
    return replace(
        chain, links=links, independents=independents, joint_forces=forces, effector_forces=(wrench,), assemble=True
    )


def _at(link: Link, value: float) -> Link:
    exact = F(float(value))
    return replace(link, row=replace(link.row, **{"theta" if link.type == "revolute" else "d": exact}))


@cache
def done(case: tuple[int, int, int]) -> tuple[Mechanism, Run, Record]:
    ready = generated(closed(*case))
    assert isinstance(ready.equations, Generated)
    run = prescribed_run(ready, TIMES)
    assert not run.failure
    return ready, run, record(ready, ready.equations, run)


@pytest.mark.parametrize("case", CASES)
def test_cuts_stay_closed_and_several_coordinates_are_independent(case: tuple[int, int, int]) -> None:
    ready, run, _ = done(case)
    assert len(ready.part.v) > 1
    for state in run.states:
        closure = TableEquations(ready.chain).closure(state.q)
        assert np.max(np.abs(closure.p)) < 1e-11
        assert np.max(np.abs(closure.R - np.eye(3))) < 1e-11


@pytest.mark.parametrize("case", CASES)
def test_rates_and_accelerations_are_difference_quotients(case: tuple[int, int, int]) -> None:
    _, run, found = done(case)
    before, here, after = run.states
    scale = 1 + np.max(np.abs(found.qdd))
    assert (after.q - before.q) / (2 * STEP) == pytest.approx(here.qd, abs=1e-5 * scale)
    assert (after.qd - before.qd) / (2 * STEP) == pytest.approx(here.qdd, abs=1e-4 * scale)


@pytest.mark.parametrize("case", CASES)
def test_every_coordinate_is_in_balance(case: tuple[int, int, int]) -> None:
    """``M qdd + f_C = f_G + tau + J^T f_R + D_E^T f_E`` in all rows, by the table; and joint by joint."""
    ready, run, found = done(case)
    table = TableEquations(ready.chain)
    for state in run.states:
        assert state.loads is not None
        terms = table.terms(state.q, state.qd)
        applied = state.loads.tau + table.effectors(state.q).T @ state.loads.wrenches
        rest = terms.M @ state.qdd + terms.f_C - terms.f_G - applied - table.jacobian(state.q).T @ state.loads.reaction
        assert np.max(np.abs(rest)) < 1e-10 * max(1.0, np.max(np.abs(state.loads.reaction)))
    assert balance(ready, found) < 1e-12


@pytest.mark.parametrize("case", CASES)
def test_forward_dynamics_gives_back_the_accelerations_of_inverse_dynamics(case: tuple[int, int, int]) -> None:
    """With a mass on every link, so that there is something to accelerate."""
    light = closed(*case)
    round_ = tuple(tuple(F(int(i == k)) for k in range(3)) for i in range(3))
    links = tuple(link if link.mass else replace(link, mass=F(1), inertia=round_) for link in light.links)
    ready = by_table(replace(light, links=links))
    for state in prescribed_run(ready, TIMES).states:
        assert state.loads is not None
        there = reduced(ready.equations, ready.part, state.q, state.qd[ready.part.v])
        force = generalised(ready, state.q, state.qd, ())
        force[ready.part.v] += state.loads.effort
        scale = 1 + np.max(np.abs(state.qdd))
        assert there.forward(force, np.zeros(len(ready.part.v), dtype=bool), np.zeros(0)) == pytest.approx(
            state.qdd[ready.part.v], abs=1e-8 * scale
        )


def test_a_coordinate_that_moves_no_mass_has_no_forward_dynamics() -> None:
    """The last link of a pendulum has none."""
    chain = four_bar()
    ready = by_table(
        replace(
            chain,
            links=(chain.links[0], replace(chain.links[1], mass=F(0), inertia=(NONE,) * 3)),
            cuts=(),
            independents=(Independent("crank 1"), Independent("coupler")),
        )
    )
    run = forward_run(ready, TIMES, 1e-8)
    assert run.failure == "no mass resists the acceleration of coupler"
    assert not run.states
