"""Free coordinates that turn back while the mechanism moves on, and poses near which no step leads on."""

from __future__ import annotations

import numpy as np
import pytest

from codegen.chains.mechanism import Mechanism
from codegen.chains.moving import Moving
from codegen.chains.steps import _ROW
from codegen.spec.chain_file import read_chain

from .mechanisms import spatial_slider_crank
from .runs import forward_run, generated
from .test_compiled_motion import careful

BAR = 'mass = 1\ninertia = [0.001, 0.5, 0.5]\ntype = "revolute"\n'

ROCKERS = f"""
name = "rockers"
gravity = [0, -9.81, 0]
assemble = true
[[link]]
name = "left"
parent = "base"
theta = 1.63
centre = [1.5, 0, 0]
{BAR}
[[link]]
name = "coupler"
parent = "left"
a = 3
theta = -1.98
centre = [1, 0, 0]
{BAR}
[[link]]
name = "right"
parent = "coupler"
a = 2
theta = -0.72
centre = [1.6, 0, 0]
{BAR}
[[link]]
name = "pin"
parent = "right"
type = "revolute"
a = 3.3
theta = 1.07
[[cut]]
name = "pin"
base = {{ link = "base", a = 4 }}
far = {{ link = "pin" }}
[[independent]]
joint = "left"
speed = 0.6
"""
"""No bar turns over: coupler and right bar stretch out, where the left one turns back."""


def energy(ready: Mechanism, q: np.ndarray, qd: np.ndarray) -> float:
    """Kinetic energy by M, and heights of the centres of mass by the frames of the links."""
    frames = ready.equations.frames(q)  # type: ignore[attr-defined]
    centres = (np.array([float(x) for x in one.centre]) for one in ready.chain.links)
    heights = (T[:, :3] @ c + T[:, 3] for T, c in zip(frames, centres, strict=False))
    potential = sum(9.81 * float(one.mass) * p[1] for one, p in zip(ready.chain.links, heights, strict=False))
    return float(qd @ ready.equations.terms(q, qd).M @ qd / 2 + potential)


def test_a_swinging_linkage_goes_through_where_its_independent_coordinate_turns_back() -> None:
    ready, times = generated(read_chain(ROCKERS, "rockers.toml")), np.linspace(0.0, 0.8, 5)
    runs = [forward_run(one, times, 1e-9) for one in (ready, careful(ready))]
    for run in runs:
        assert not run.failure and run.exchanges == 1
        rates = [state.qd[0] for state in run.states]
        assert rates[0] > 0 > rates[-1]
        energies = [energy(ready, state.q, state.qd) for state in run.states]
        assert np.ptp(energies) < 1e-6 * abs(energies[0])
    for one, other in zip(*(run.states for run in runs), strict=True):
        assert one.q == pytest.approx(other.q, abs=1e-7)


def test_steps_that_lead_nowhere_near_a_singular_pose_end_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    ready = generated(spatial_slider_crank())
    monkeypatch.setattr(Moving, "reach", lambda *_: 1e-9)
    monkeypatch.setattr("codegen.chains.rate_solver.RateSolver.run", lambda *_: False)
    run = forward_run(ready, np.linspace(0.0, 1.0, 2), 1e-6)
    assert "steps become too short near a singular pose" in run.failure
    assert run.evaluations < 40 * _ROW
