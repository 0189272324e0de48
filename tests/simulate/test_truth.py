"""The in-line engine over 2 s against its one degree of freedom, integrated to 1e-13."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from codegen.scenes.motion_record import Record

from . import engine
from .preparations import example, told

Array = engine.Array

FORMS = {
    "planar": ("planar", "conventional", "exact"),
    "conventional": ("spatial", "conventional", "exact"),
    "parametric": ("spatial", "parametric", "exact"),
    "substituted": ("spatial", "parametric", "substituted"),
}

pytestmark = pytest.mark.slow


@cache
def run(name: str, tolerance: float = 1e-8, index: int = 2) -> Record:
    return told(example("in_line_engine", *FORMS[name], index), 2.0, tolerance, 200)


@cache
def truth() -> engine.Motion:
    return engine.truth(np.linspace(0.0, 2.0, 201))


def worst(found: Array, true: Array) -> float:
    return float(np.max(np.abs(found - true)))


@pytest.mark.parametrize("name", FORMS)
def test_positions_are_within_a_micrometre_of_the_truth_at_a_tolerance_of_1e_8(name: str) -> None:
    found = run(name).trajectory
    assert worst(found.r[..., :2], truth().r) < 1e-6
    assert np.max(np.abs(found.r[..., 2])) < 1e-9


@pytest.mark.parametrize("name", FORMS)
def test_velocities_and_accelerations_follow_the_truth(name: str) -> None:
    found = run(name).trajectory
    assert worst(found.v[..., :2], truth().v) < 3e-5
    assert worst(found.w[..., 2], truth().omega) < 2e-4
    assert worst(found.a[..., :2], truth().a) < 1e-3
    assert worst(found.al[..., 2], truth().omegadot) < 1e-2


@pytest.mark.parametrize("name", FORMS)
def test_attitudes_are_those_of_the_crank_and_rod(name: str) -> None:
    q = run(name).trajectory.q
    assert worst(2 * np.unwrap(np.arctan2(q[..., 3], q[..., 0]), axis=0), truth().angle) < 1e-5


@pytest.mark.parametrize("name", FORMS)
def test_constraints_drift_by_less_than_a_nanometre(name: str) -> None:
    assert np.max(run(name).drift) < 1e-9


@pytest.mark.parametrize("name", FORMS)
def test_energy_is_that_of_the_truth_which_stays(name: str) -> None:
    assert np.ptp(truth().energy) < 1e-10
    assert worst(run(name).energy, truth().energy) < 3e-6


@pytest.mark.parametrize("name", FORMS)
def test_reactions_are_the_forces_of_newtons_and_eulers_laws_on_the_second_body(name: str) -> None:
    found, true = run(name).trajectory.reaction, engine.reactions(truth())
    assert found.keys() == true.keys()
    for joint, force in true.items():
        assert worst(found[joint][:, :2], force) < 2e-3, joint
        # The engine is flat and no moment acts at its pins, nor at the centre of the piston.
        assert np.max(np.abs(found[joint][:, 2:])) < 1e-9, joint


@pytest.mark.parametrize("name", ["conventional", "parametric"])
def test_index_1_comes_within_ten_micrometres_at_1e_8_and_follows_the_tolerance(name: str) -> None:
    assert worst(run(name, 1e-8, 1).trajectory.r[..., :2], truth().r) < 1e-5
    assert worst(run(name, 1e-10, 1).trajectory.r[..., :2], truth().r) < 2e-7


@pytest.mark.parametrize("name", FORMS)
def test_the_error_falls_with_the_tolerance(name: str) -> None:
    errors = [worst(run(name, tolerance).trajectory.r[..., :2], truth().r) for tolerance in (1e-6, 1e-8, 1e-10)]
    assert errors[1] < errors[0] / 10
    assert errors[2] < errors[1] / 3
    assert errors[2] < errors[0] / 100
