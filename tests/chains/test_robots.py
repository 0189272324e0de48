"""The robots among the examples, against what is published of one and the geometry of the other; rotors."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from codegen.chains.generated import Generated
from codegen.chains.interpreted import interpreted
from codegen.chains.mechanism import mechanism
from codegen.chains.record import balance, record
from codegen.chains.start import coordinates
from codegen.errors import SpecificationError
from codegen.spec.chain_file import read_chain

from .runs import generated, prescribed_run

EXAMPLES = Path(__file__).parents[2] / "examples" / "chains"


def example(name: str) -> str:
    return (EXAMPLES / name).read_text()


def test_the_puma_has_the_inertia_and_gravity_that_the_robotics_toolbox_prints() -> None:
    """``p560.inertia(qn)`` and ``p560.gravload(qn)``, four digits, rotors included."""
    chain = read_chain(example("puma560.toml"), "puma560.toml")
    equations = Generated(chain, True, interpreted)
    q = coordinates(mechanism(chain, equations))
    terms = equations.terms(q, np.zeros(6))
    assert -terms.f_G == pytest.approx([0, 31.6399, 6.0351, 0, 0.0283, 0], abs=6e-5)
    assert np.diagonal(terms.M) == pytest.approx([3.6594, 4.4137, 0.9378, 0.1925, 0.1713, 0.1941], abs=6e-5)
    couplings = {(0, 1): -0.4044, (0, 2): 0.1006, (0, 3): -0.0025, (1, 2): 0.3509, (1, 4): 0.0024, (2, 4): 0.0015}
    for place, value in couplings.items():
        assert terms.M[place] == pytest.approx(value, abs=6e-5)


def test_the_platform_of_the_delta_keeps_its_attitude_and_its_forearms_their_length() -> None:
    chain = read_chain(example("delta.toml"), "delta.toml")
    ready = mechanism(chain, Generated(chain, False, interpreted))
    for state in prescribed_run(ready, np.array([0.0, 0.3, 0.7]), is_inverse=False).states:
        tool = ready.equations.frames(state.q)[-1]  # type: ignore[attr-defined]
        assert tool[:, :3] == pytest.approx(np.eye(3), abs=1e-12)
        for k in range(3):
            turn, q = 2 * np.pi / 3 * k, state.q[chain.index(f"arm {k + 1}")]
            out = np.array([np.cos(turn), np.sin(turn), 0])
            elbow = (0.17 + 0.2 * np.cos(q)) * out - [0, 0, 0.2 * np.sin(q)]
            assert np.linalg.norm(tool[:, 3] + 0.05 * out - elbow) == pytest.approx(0.4, abs=1e-12)


BAR = """
name = "bar"
gravity = [0, -10, 0]
[[link]]
name = "bar"
parent = "base"
type = "revolute"
mass = 2
centre = [0.5, 0, 0]
inertia = [0, 0.25, 0.25]
rotor = 0.75
[[independent]]
joint = "bar"
polynomial = [0.3, 0, 2]
"""


def test_a_rotor_takes_effort_that_the_joint_does_not_feel() -> None:
    """``(I + rotor) qdd`` and the weight at ``q = 0.3 + 2 t^2``; the bearing turns the bar alone."""
    ready = generated(read_chain(BAR, "bar.toml"))
    run = prescribed_run(ready, np.array([0.0, 0.5]))
    found = record(ready, ready.equations, run)  # type: ignore[arg-type]
    assert found.effort is not None and found.wrenches is not None
    for q, effort, wrench in zip(found.q[:, 0], found.effort[:, 0], found.wrenches[:, 0], strict=True):
        own = (0.25 + 2 * 0.5**2) * 4 + 2 * 10 * 0.5 * np.cos(q)
        assert effort == pytest.approx(own + 0.75 * 4, rel=1e-14)
        assert wrench[5] == pytest.approx(own, rel=1e-14)
    assert balance(ready, found) < 1e-14


def test_a_rotor_of_less_than_nothing_is_refused() -> None:
    with pytest.raises(SpecificationError, match=r"rotor: is -1 kg m\^2"):
        read_chain(BAR.replace("0.75", "-1"), "bar.toml")
