"""Runs on a moving base: efforts are those of the routines that take its motion; a free base keeps its momentum."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from codegen.chains.afloat import afloat
from codegen.chains.stand import check_start
from codegen.errors import SpecificationError
from codegen.mechanics.chain.model import chain_program
from codegen.passes import simplify
from codegen.simulate.callable import callables
from codegen.spec.chain import BASE_COORDINATES, Chain
from codegen.spec.chain_file import read_chain

from .runs import forward_run, generated, prescribed_run

ARM = """
name = "arm"
gravity = [0, 0, -9.81]
base = "moving"
[[link]]
name = "upper"
parent = "base"
type = "revolute"
alpha = "pi/2"
c = 0.4
mass = 3
centre = [0.25, 0.02, 0]
inertia = [0.02, 0.3, 0.31]
[[link]]
name = "lower"
parent = "upper"
type = "revolute"
psi = 0.3
a = 0.5
alpha = 0.4
mass = 2
centre = [0.2, 0, 0.03]
inertia = [0.01, 0.2, 0.2]
"""
MOTIONS = """
[[independent]]
joint = "upper"
polynomial = [0.3, 1.1, 0.4]
[[independent]]
joint = "lower"
polynomial = [-0.2, 0.7]
[[independent]]
joint = "base x"
polynomial = [0.1, 0.5, 0.8]
[[independent]]
joint = "base yaw"
polynomial = [0.2, 0.9, -0.6]
"""
TIMES = np.array([0.0, 0.35])


def moved_base(t: float) -> dict[str, np.ndarray]:
    """Pose, velocity and acceleration of the base, axes of the base, by hand."""
    yaw, rate, turning = 0.2 + 0.9 * t - 0.6 * t * t, 0.9 - 1.2 * t, -1.2
    c, s = np.cos(yaw), np.sin(yaw)
    R = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    r, v, a = (np.array([x, 0, 0]) for x in (0.1 + 0.5 * t + 0.8 * t * t, 0.5 + 1.6 * t, 1.6))
    return {
        "T_0": np.column_stack([R, r]).T.ravel(),
        "v_0": np.array([*(R.T @ v), 0, 0, rate]),
        "vd_0": np.array([*(R.T @ a), 0, 0, turning]),
    }


def test_efforts_on_a_prescribed_base_are_those_of_the_routines_that_take_its_motion() -> None:
    chain = read_chain(ARM + MOTIONS, "arm.toml")
    program = simplify(chain_program(chain, ("M", "f_C", "f_G")))
    used = {argument.name for argument in program.used_arguments()}
    (evaluate,) = callables([program])
    for state in prescribed_run(generated(afloat(chain)), TIMES).states:
        base = {name: values for name, values in moved_base(state.t).items() if name in used}
        found = evaluate(q=state.q[6:], qd=state.qd[6:], **base)
        expected = found["M"] @ state.qdd[6:] + found["f_C"] - found["f_G"]
        assert state.loads is not None
        assert state.loads.tau[6:] == pytest.approx(expected, abs=1e-12)


def test_a_free_base_falls_and_momentum_along_the_ground_stays() -> None:
    deck = '[[link]]\nname = "deck"\nparent = "base"\ntype = "prismatic"\nd = 0.1\nmass = 9\ninertia = [1, 2, 3]\n'
    fast = '[[independent]]\njoint = "base y"\nspeed = 0.7\n[[independent]]\njoint = "upper"\nspeed = 2.0\n'
    rest = "".join(f'[[independent]]\njoint = "{name}"\n' for name in ("lower", "deck"))
    ready = generated(afloat(read_chain(ARM + deck + fast + rest, "arm.toml")))
    run = forward_run(ready, np.linspace(0.0, 0.2, 3), 1e-10)
    assert not run.failure
    momenta = [(ready.equations.terms(state.q, state.qd).M @ state.qd)[:3] for state in run.states]
    assert momenta[-1][:2] == pytest.approx(momenta[0][:2], abs=1e-8)
    assert momenta[-1][2] - momenta[0][2] == pytest.approx(-9.81 * 14 * 0.2, abs=1e-8)


def test_a_pendulum_swings_under_a_base_that_shakes_as_given() -> None:
    """``(I + m l^2) theta'' = -m l (g cos theta - x'' sin theta)``, x the way of the base, theta from its x axis."""
    shaken = '[[independent]]\njoint = "base x"\ndriven = true\nharmonic = { amplitude = 0.2, frequency = 7.0 }\n'
    bar = """
name = "bar"
gravity = [0, -9.81, 0]
base = "moving"
[[link]]
name = "bar"
parent = "base"
type = "revolute"
mass = 2
centre = [0.5, 0, 0]
inertia = [0.01, 0.1, 0.1]
"""
    ready = generated(afloat(read_chain(bar + shaken, "bar.toml")))
    run = forward_run(ready, np.linspace(0.0, 1.5, 4), 1e-10)

    def pushed(t: float) -> float:
        return -0.2 * 49 * np.sin(7 * t)

    def rate(t: float, y: np.ndarray) -> list[float]:
        return [y[1], -(9.81 * np.cos(y[0]) - pushed(t) * np.sin(y[0])) / 0.6]

    swung = solve_ivp(rate, (0.0, 1.5), [0.0, 0.0], "DOP853", np.linspace(0.0, 1.5, 4), rtol=1e-12, atol=1e-12).y
    for state, (angle, speed) in zip(run.states, swung.T, strict=True):
        assert state.q[6:] == pytest.approx(angle, abs=1e-8)
        assert state.loads is not None
        turning = rate(state.t, np.array([angle, speed]))[1]
        effort = 2 * (pushed(state.t) - (turning * np.sin(angle) + speed**2 * np.cos(angle)) / 2)
        assert state.loads.effort[0] == pytest.approx(effort, abs=1e-6)
        assert state.loads.effort[6] == 0


def test_a_spring_on_a_moving_base_may_not_have_coinciding_ends() -> None:
    """Before routines are made of the chain, whose base is anywhere."""
    ends = '[[effector]]\nname = "tip"\nlink = "lower"\n[[effector]]\nname = "hook"\nlink = "base"\na = {}\nc = 0.4\n'
    spring = '[[spring]]\neffectors = ["tip", "hook"]\nstiffness = 9\nlength = 0.1\n'
    straight = ARM.replace("psi = 0.3\n", "")
    check_start(read_chain(straight + ends.format(0.7) + spring, "arm.toml"))
    with pytest.raises(SpecificationError, match="ends coincide"):
        check_start(read_chain(straight + ends.format(0.5) + spring, "arm.toml"))


def test_a_fixed_base_has_no_coordinates_and_a_link_does_not_take_their_names() -> None:
    for text in (ARM.replace('base = "moving"', "") + MOTIONS, ARM.replace('"lower"', '"base z"')):
        with pytest.raises(SpecificationError, match="base"):
            read_chain(text, "arm.toml")


def test_what_stands_on_the_base_stands_on_its_last_coordinate() -> None:
    fixed: Chain = afloat(read_chain(ARM, str(Path("arm.toml"))))
    assert [link.name for link in fixed.links[:6]] == list(BASE_COORDINATES)
    assert fixed.links[6].parent == BASE_COORDINATES[-1] and fixed.base == "fixed"
    assert afloat(fixed) is fixed
