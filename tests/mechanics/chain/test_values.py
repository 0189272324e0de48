"""Every quantity of a chain has the value that 4 x 4 transforms and d'Alembert's principle give."""

from __future__ import annotations

import numpy as np
import pytest

from codegen.mechanics.chain.model import kept_rows
from codegen.spec.chain import Chain
from tests.mechanics.chain.series import Account
from tests.mechanics.chain.states import evaluated, state
from tests.mechanics.chain.trees import example, loaded, start, tree

_OF_ROWS = ("phi", "phi_q", "J", "gamma_R")

CHAINS = {
    "quick return": lambda: _started("quick_return"),
    "spatial slider-crank": lambda: _started("spatial_slider_crank"),
    "two loops on each other": lambda: tree(8, 9, 2, 1),
    "a loop on moving links": lambda: tree(7, 8, 1, 1),
    "open tree": lambda: tree(6, 7, 0, 2),
    "three loops": lambda: tree(31, 7, 3, 1),
    "loop on a moving base": lambda: tree(40, 6, 1, 1, "moving"),
    "tree on a moving base": lambda: tree(43, 6, 0, 1, "moving"),
    "screws and two loops": lambda: tree(8, 9, 2, 1, screws=(0, 2, 4, 7)),
    "forces of every kind": lambda: _with_forces(*tree(6, 4, 0, 1)),
    "forces on a moving base": lambda: _with_forces(*tree(43, 4, 0, 1, "moving", screws=(0, 1, 2))),
}


def _started(name: str) -> tuple[Chain, np.ndarray]:
    chain = example(name)
    return chain, start(chain)


def _with_forces(chain: Chain, q: np.ndarray) -> tuple[Chain, np.ndarray]:
    return loaded(chain), q


@pytest.mark.parametrize("name", CHAINS)
def test_every_quantity_agrees_with_an_independent_account(name):
    chain, q = CHAINS[name]()
    found = state(chain, q)
    rows = list(kept_rows(chain))
    values = evaluated(chain, chain.wanted, found.inputs)
    del values["wrenches"]
    for quantity, value in values.items():
        truth = np.real(getattr(found.account, quantity)())
        if quantity in _OF_ROWS:
            assert np.abs(np.delete(truth, rows, 0)).max(initial=0.0) < 1e-12, f"{quantity}: a row that was left out"
            truth = truth[rows]
        scale = max(1.0, np.abs(truth).max(initial=0.0))
        assert np.abs(value - truth).max(initial=0.0) < 1e-12 * scale, quantity


@pytest.mark.parametrize("name", CHAINS)
def test_joint_wrenches_do_the_work_that_the_equations_of_motion_say(name):
    """``h^T f = M qdd + f_C - f_G - J^T f_R - D_E^T f_E`` for any accelerations and wrenches."""
    chain, q = CHAINS[name]()
    found = state(chain, q)
    wrenches = evaluated(chain, chain.wanted, found.inputs)["wrenches"]
    parts = [(wrenches[6 * k + 2], wrenches[6 * k + 5]) for k in range(len(chain.links))]
    along = [
        force if link.type == "prismatic" else moment + float(link.pitch) * force
        for link, (force, moment) in zip(chain.links, parts, strict=True)
    ]
    account, inputs = found.account, found.inputs
    truth = account.M() @ inputs["qdd"] + account.f_C() - account.f_G()
    truth -= account.J().T @ inputs["f_R"] if chain.cuts else 0.0
    truth -= account.D_E().T @ inputs["f_E"] if chain.effectors else 0.0
    assert np.abs(along - truth).max() < 1e-12 * max(1.0, np.abs(truth).max())


@pytest.mark.parametrize("seed", range(3))
def test_jacobians_of_the_cuts_are_exact_where_they_are_open(seed):
    chain, q = tree(20 + seed, 6, 2, 0)
    q = q + 0.3 * np.random.default_rng(seed).normal(size=len(q))
    rows = list(kept_rows(chain))
    account = Account(chain, q)
    for quantity, value in evaluated(chain, ("closure", "phi", "phi_q", "J"), {"q": q}).items():
        truth = np.real(getattr(account, quantity)())
        truth = truth if quantity == "closure" else truth[rows]
        assert np.abs(value - truth).max(initial=0.0) < 1e-13


@pytest.mark.parametrize("name", ["spatial slider-crank", "three loops", "screws and two loops"])
def test_the_inertia_matrix_is_the_same_by_moments_about_the_far_end_of_a_loop(name):
    chain, q = CHAINS[name]()
    (M,) = evaluated(chain, ("M",), {"q": q}, progressive=False).values()
    truth = state(chain, q).account.M()
    assert np.abs(M - truth).max() < 1e-12 * np.abs(truth).max()


@pytest.mark.parametrize("name", ["open tree", "two loops on each other"])
def test_the_inertia_matrix_is_symmetric_and_positive(name):
    chain, q = CHAINS[name]()
    M = evaluated(chain, chain.wanted, state(chain, q).inputs)["M"]
    assert (M == M.T).all()
    assert np.linalg.eigvalsh(M).min() > -1e-13 * np.abs(M).max()


def test_the_power_of_the_bias_forces_is_what_the_kinetic_energy_gains_without_acceleration():
    """``d/dt (qd^T M qd / 2) = qd^T f_C`` while qdd = 0, M differentiated along qd by differences."""
    chain, q = CHAINS["open tree"]()
    inputs = state(chain, q).inputs
    qd, f_C = inputs["qd"], evaluated(chain, chain.wanted, inputs)["f_C"]
    step = 1e-5
    energies = []
    for sign in (1, -1):
        M = evaluated(chain, chain.wanted, inputs | {"q": q + sign * step * qd})["M"]
        energies.append(qd @ M @ qd / 2)
    assert (energies[0] - energies[1]) / (2 * step) == pytest.approx(qd @ f_C, rel=1e-8)
