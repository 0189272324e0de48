"""The two mechanisms of S2, run as chains, against their solutions in one coordinate from closed-form geometry."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism
from codegen.chains.record import balance, record
from codegen.chains.run import Run
from codegen.spec.chain import Chain
from codegen.spec.chain_forces import JointForce
from codegen.spec.chain_motions import Harmonic
from tests.reference import quick_return as planar
from tests.reference import spatial_slider_crank as spatial
from tests.reference.one_freedom import OneFreedom

from .mechanisms import PI, RIGHT, quick_return, spatial_slider_crank
from .runs import Array, forward_run, generated, prescribed_run

TURN = np.linspace(0.0, 1.0, 41)
X = -1
"""The slider's position is the last coordinate of both chains."""


def swinging(length: Fraction) -> Chain:
    """The crank speeds up and slows down."""
    motion = Harmonic(-RIGHT + Fraction("0.3"), Fraction("1.1"), 3 * PI, Fraction("0.4"))
    return spatial_slider_crank(length, motion=motion, q=0.3 + 1.1 * np.sin(0.4))


CASES: dict[str, tuple[Chain, OneFreedom, float]] = {
    "quick return, 2 pi": (quick_return(), planar.quick_return(), 0.0),
    "quick return, 4 pi": (quick_return(w=4 * PI), planar.quick_return(), 0.0),
    "quick return, other branch": (quick_return(branch=1), planar.quick_return(branch=1), 0.0),
    **{
        f"slider-crank {float(length)}": (
            spatial_slider_crank(length),
            spatial.spatial_slider_crank(length),
            float(RIGHT),
        )
        for length in spatial.LENGTHS
    },
    "slider-crank, other branch": (
        spatial_slider_crank(branch=-1),
        spatial.spatial_slider_crank(Fraction("0.27"), -1),
        float(RIGHT),
    ),
    "slider-crank, swinging": (
        swinging(Fraction("0.24")),
        spatial.spatial_slider_crank(Fraction("0.24")),
        float(RIGHT),
    ),
}
"""Chain, reference, and what is added to the crank's coordinate to give the reference's."""


@cache
def done(name: str) -> tuple[Mechanism, Run]:
    ready = generated(CASES[name][0])
    return ready, prescribed_run(ready, TURN)


def columns(run: Run, name: str) -> Array:
    return np.array([getattr(state, name) for state in run.states])


@pytest.mark.parametrize("name", CASES)
def test_position_velocity_and_acceleration_of_the_slider_are_right_to_1e_10(name: str) -> None:
    _, reference, offset = CASES[name]
    _, run = done(name)
    assert not run.failure
    q, qd, qdd = (columns(run, part) for part in ("q", "qd", "qdd"))
    for k, state in enumerate(run.states):
        x, v, a = reference.output("x", q[k, 0] + offset, qd[k, 0], qdd[k, 0])
        assert abs(state.q[X] - x) < 1e-10
        assert abs(state.qd[X] - v) < 1e-10
        assert abs(state.qdd[X] - a) < 1e-10 * max(1.0, abs(a))


@pytest.mark.parametrize("name", CASES)
def test_efforts_of_the_crank_are_right_to_1e_10_or_to_rounding_of_the_greatest(name: str) -> None:
    """In N m. The efforts of the quick return reach 5e6 N m, where half a unit of the last digit is 5e-10 N m."""
    _, reference, offset = CASES[name]
    _, run = done(name)
    efforts = [
        reference.effort(q[0] + offset, qd[0], qdd[0])
        for q, qd, qdd in zip(*(columns(run, part) for part in ("q", "qd", "qdd")), strict=True)
    ]
    rounding = 2.0**-53 * np.max(np.abs(efforts))
    for state, effort in zip(run.states, efforts, strict=True):
        assert state.loads is not None
        assert abs(state.loads.tau[0] - effort) < max(1e-10, 32 * rounding)


@pytest.mark.parametrize("name", CASES)
def test_joints_have_no_reaction_along_their_axis(name: str) -> None:
    """``h^T f = tau``: wrenches come link by link, efforts from the reduced equation."""
    ready, run = done(name)
    assert isinstance(ready.equations, Generated)
    found = record(ready, ready.equations, run)
    assert balance(ready, found) < 1e-10
    if name.startswith("slider"):
        along = [2 if link.type == "prismatic" else 5 for link in ready.chain.links]
        assert found.wrenches is not None and found.tau is not None
        assert np.max(np.abs(found.wrenches[:, np.arange(7), along] - found.tau)) < 1e-10


@pytest.mark.parametrize("name", CASES)
def test_the_power_of_all_forces_is_the_rate_of_the_kinetic_energy(name: str) -> None:
    """The rate from the reference's inertia: ``m qd qdd + m' qd^3 / 2``."""
    _, reference, offset = CASES[name]
    _, run = done(name)
    for state in run.states:
        assert state.loads is not None
        m, dm, _, _ = reference.inertia(state.q[0] + offset)
        rate = m * state.qd[0] * state.qdd[0] + dm * state.qd[0] ** 3 / 2
        assert abs(state.loads.kinetic - m * state.qd[0] ** 2 / 2) < 1e-10 * max(1.0, state.loads.kinetic)
        assert abs(state.loads.power - rate) < 1e-10 * max(1.0, state.loads.kinetic)


def test_the_guide_holds_the_slider_by_what_newton_says() -> None:
    """Slider and rod are a free body: the guide's force on them and the ball's give their accelerations."""
    length = Fraction("0.27")
    ready, run = done(f"slider-crank {float(length)}")
    assert isinstance(ready.equations, Generated)
    found = record(ready, ready.equations, run)
    assert found.wrenches is not None and found.reaction is not None
    reference = spatial.spatial_slider_crank(length)
    for k, state in enumerate(run.states):
        angle = state.q[0] + float(RIGHT)
        x, y, z = (_places(reference, part, angle, state.qd[0]) for part in ("slider", "rod", "crank"))
        g = np.array([0.0, 0.0, -9.81])
        needed = 2.0 * (x - g) + 0.5 * (y - g) + 0.12 * (z - g)
        base_axes = ready.equations.frames(state.q)
        bearing = base_axes[0, :, :3] @ found.wrenches[k, 0, :3]
        guide = base_axes[7, :, :3] @ found.reaction[k, :3]
        assert np.max(np.abs(bearing + guide - needed)) < 1e-10


def _places(reference: OneFreedom, body: str, angle: float, rate: float) -> Array:
    """Acceleration of a centre of mass at constant rate."""
    return np.asarray(reference.bodies[body].motion(angle)[2] * rate**2)


def test_free_running_of_the_slider_crank_keeps_to_the_energy_integral() -> None:
    """A constant torque on the crank; 1e-6 rad/s is asked."""
    torque = Fraction("0.05")
    ready = generated(spatial_slider_crank(forces=(JointForce("crank", torque),)))
    run = forward_run(ready, np.linspace(0.0, 0.5, 6), 1e-10)
    reference = spatial.spatial_slider_crank(Fraction("0.27"))
    assert not run.failure
    for state in run.states:
        angle = state.q[0] + float(RIGHT)
        assert abs(state.qd[0] - reference.speed_by_energy(0.0, 2 * np.pi, angle, float(torque) * angle)) < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("J", [1000, 3000])
def test_the_quick_return_keeps_to_the_energy_integral_through_all_switches(J: int) -> None:
    """Fig. 7 of S2: drive and cutting force, from where cutting ends; 1e-6 rad/s is asked."""
    _, ends = planar.crossings()
    ready = generated(quick_return(J, start=Fraction(ends), drive=True))
    run = forward_run(ready, np.linspace(0.0, 0.4, 5), 1e-10)
    reference = planar.quick_return(J)
    assert not run.failure
    assert run.events > 3
    for state in run.states:
        angle = state.q[0]
        work = planar.DRIVE * (angle - ends) + planar.cutting_work(ends, np.array(angle))
        assert abs(state.qd[0] - reference.speed_by_energy(ends, 2 * np.pi, angle, work)) < 1e-7


def test_forward_dynamics_agrees_with_the_reference_in_time() -> None:
    torque = Fraction("0.05")
    ready = generated(spatial_slider_crank(forces=(JointForce("crank", torque),)))
    times = np.linspace(0.0, 0.25, 6)
    run = forward_run(ready, times, 1e-10)
    truth = spatial.spatial_slider_crank(Fraction("0.27")).motion(0.0, 2 * np.pi, times, lambda *_: float(torque))
    assert np.max(np.abs(columns(run, "q")[:, 0] + float(RIGHT) - truth[:, 0])) < 1e-8
    assert np.max(np.abs(columns(run, "qd")[:, 0] - truth[:, 1])) < 1e-7


def test_a_spring_and_a_damper_on_a_dependent_coordinate_do_their_work() -> None:
    """On the slider: their generalised force on the crank is known from the slope of x."""
    spring = JointForce("slide", stiffness=Fraction(3), damping=Fraction("0.7"), rest=Fraction("0.1"))
    ready = generated(replace(spatial_slider_crank(), joint_forces=(spring,)))
    reference = spatial.spatial_slider_crank(Fraction("0.27"))
    for state in prescribed_run(ready, TURN[::8]).states:
        assert state.loads is not None
        x, slope, _ = reference.output("x", state.q[0] + float(RIGHT), 1.0)
        force = (-3 * (x - 0.1) - 0.7 * slope * state.qd[0]) * slope
        effort = reference.effort(state.q[0] + float(RIGHT), state.qd[0], 0.0, force)
        assert abs(state.loads.effort[0] - effort) < 1e-10
