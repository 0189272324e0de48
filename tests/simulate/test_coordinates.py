"""What acts on joint coordinates: springs, dampers, torques, forces, stops, drives; against equations of their own."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from codegen.scenes.motion_record import Record
from codegen.scenes.summary import is_conservative

from . import engine
from .preparations import EXAMPLES, prepared, told

PENDULUM = """
name = "pendulum"
gravity = [0.0, -9.81, 0.0]

[[body]]
name = "bob"
mass = 2.0
inertia = [0.01, 0.02, 0.03]
position = [0.5, 0.0, 0.0]
angular_velocity = [0.0, 0.0, {speed}]
velocity = [0.0, {velocity}, 0.0]

[[joint]]
name = "hinge"
type = "revolute"
bodies = ["ground", "bob"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
{loads}
"""

INERTIA = 0.03 + 2.0 * 0.5**2
"""kg m^2 about the hinge."""

WEIGHT = 2.0 * 9.81 * 0.5
"""N m at the hinge, of the bob lying along x."""


def swing(loads: str, duration: float, speed: float = 0.0) -> Record:
    text = PENDULUM.format(speed=speed, velocity=0.5 * speed, loads=loads)
    return told(prepared(text, "planar", "parametric"), duration, 1e-9)


def angle(record: Record) -> np.ndarray:
    return record.trajectory.alpha["hinge"][:, 0]


def test_a_pendulum_with_spring_damper_and_torque_follows_its_own_equation() -> None:
    found = swing("stiffness = 40.0\ndamping = 0.3\ntorque = 5.0\nrest = 0.2", 2.0)

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        x, speed = state
        return np.array([speed, (5.0 - 40.0 * (x - 0.2) - 0.3 * speed - WEIGHT * np.cos(x)) / INERTIA])

    t = found.trajectory.t
    x, speed = solve_ivp(rates, (0.0, 2.0), [0.0, 0.0], "DOP853", t, rtol=1e-12, atol=1e-12).y
    assert angle(found) == pytest.approx(x, abs=1e-6)
    assert found.trajectory.alphadot["hinge"][:, 0] == pytest.approx(speed, abs=1e-5)
    assert found.trajectory.al[:, 0, 2] == pytest.approx(
        [rates(0.0, s)[1] for s in zip(x, speed, strict=True)], abs=1e-4
    )


def test_a_pendulum_under_a_spring_keeps_its_energy() -> None:
    found = swing("stiffness = 40.0\ntorque = 5.0", 2.0, 3.0)
    assert np.ptp(found.energy) < 1e-6 * np.max(np.abs(found.energy))


PUSH = """
[[force]]
body = "bob"
vector = [12.0, 0.0, 0.0]
point = [0.25, 0.1, 0.0]
"""
"""At (0.75, 0.1) m from the hinge."""


def test_a_pendulum_pushed_by_a_horizontal_force_off_its_centre_follows_its_own_equation() -> None:
    found = swing(PUSH, 2.0)

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        x, speed = state
        push = -12.0 * (0.75 * np.sin(x) + 0.1 * np.cos(x))
        return np.array([speed, (push - WEIGHT * np.cos(x)) / INERTIA])

    x, speed = solve_ivp(rates, (0.0, 2.0), [0.0, 0.0], "DOP853", found.trajectory.t, rtol=1e-12, atol=1e-12).y
    assert angle(found) == pytest.approx(x, abs=1e-6)
    assert found.trajectory.alphadot["hinge"][:, 0] == pytest.approx(speed, abs=1e-5)
    height, way = 0.5 * np.sin(x), 0.75 * np.cos(x) - 0.1 * np.sin(x)
    stored = 2.0 * 9.81 * height - 12.0 * way
    assert found.energy == pytest.approx(INERTIA * speed**2 / 2 + stored, abs=1e-5)


def test_the_energy_of_a_pushed_pendulum_is_told_to_stay() -> None:
    ready = prepared(PENDULUM.format(speed=3.0, velocity=1.5, loads=PUSH), "spatial", "conventional")
    assert is_conservative(ready)
    found = told(ready, 1.0, 1e-9)
    assert np.ptp(found.energy) < 1e-6 * np.max(np.abs(found.energy))


def test_soft_stops_hold_a_falling_pendulum() -> None:
    """From the energy: at its deepest the spring has taken up what gravity gave."""
    stiffness, lower = 1e4, -0.5
    found = swing(f"limit = {{ lower = {lower}, stiffness = {stiffness}, damping = 0.0 }}", 1.5)
    deepest = np.roots([stiffness / 2, WEIGHT * np.cos(lower), WEIGHT * np.sin(lower)]).real
    assert np.min(angle(found)) > lower - 1.01 * np.max(np.abs(deepest))
    assert np.min(angle(found)) < lower
    assert np.max(angle(found)) < 1e-3  # it comes back to where it fell from, and no higher


def test_a_damped_stop_brings_a_pendulum_to_rest_where_spring_and_weight_balance() -> None:
    stiffness, lower = 1e3, -0.5
    found = swing(f"limit = {{ lower = {lower}, stiffness = {stiffness}, damping = 100.0 }}", 5.0)
    rest = angle(found)[-1]
    assert stiffness * (lower - rest) == pytest.approx(WEIGHT * np.cos(rest), rel=1e-4)


def test_the_effort_of_a_drive_is_the_power_that_the_energy_gains() -> None:
    """At constant speed the drive carries the weight alone."""
    found = swing("drive = { position = 0.0, speed = 4.0 }", 1.0, 4.0)
    turned = angle(found)
    assert turned == pytest.approx(4.0 * found.trajectory.t, abs=1e-8)
    effort = found.trajectory.effort["hinge"][:, 0]
    assert effort == pytest.approx(WEIGHT * np.cos(turned), abs=1e-5)


@pytest.mark.parametrize("index", [1, 2])
def test_the_effort_of_a_drive_that_swings_moves_the_inertia_too(index: int) -> None:
    loads = "drive = { position = -0.1, speed = 1.0, amplitude = 0.2, frequency = 5.0, phase = 0.5235987755982989 }"
    speed = 1.0 + np.sqrt(0.75)
    text = PENDULUM.format(speed=speed, velocity=0.5 * speed, loads=loads)
    found = told(prepared(text, "planar", "parametric", index=index), 1.5, 1e-9)
    turn = 5.0 * found.trajectory.t + np.pi / 6
    x, bend = -0.1 + found.trajectory.t + 0.2 * np.sin(turn), -0.2 * 25.0 * np.sin(turn)
    assert angle(found) == pytest.approx(x, abs=1e-8)
    assert found.trajectory.alphadot["hinge"][:, 0] == pytest.approx(1.0 + np.cos(turn), abs=1e-6)
    assert found.trajectory.al[:, 0, 2] == pytest.approx(bend, abs=1e-6)
    assert found.trajectory.effort["hinge"][:, 0] == pytest.approx(INERTIA * bend + WEIGHT * np.cos(x), abs=1e-5)


def test_the_reaction_of_a_driven_pendulum_carries_weight_and_centripetal_force() -> None:
    found = swing("drive = { position = 0.0, speed = 4.0 }", 1.0, 4.0)
    turned = angle(found)
    force = found.trajectory.reaction["hinge"][:, :2]
    assert force[:, 0] == pytest.approx(-2.0 * 0.5 * 16.0 * np.cos(turned), abs=1e-5)
    assert force[:, 1] == pytest.approx(2.0 * 9.81 - 2.0 * 0.5 * 16.0 * np.sin(turned), abs=1e-5)


def test_the_effort_of_a_driven_crank_balances_the_power_of_the_engine() -> None:
    text = (EXAMPLES / "in_line_engine.toml").read_text()
    bearing = 'name = "main bearing"\n'
    text = text.replace(bearing, bearing + "drive = { position = 0.0, speed = 15.0 }\n")
    found = told(prepared(text, "planar", "conventional"), 0.5)
    t, effort = found.trajectory.t, found.trajectory.effort["main bearing"][:, 0]
    assert effort == pytest.approx(engine.holding_torque(15.0 * t, np.full_like(t, 15.0)), abs=1e-4)
    # What the drive has done is what the energy has gained.
    work = np.concatenate([[0.0], np.cumsum(15.0 * (effort[1:] + effort[:-1]) / 2 * np.diff(t))])
    assert found.energy - found.energy[0] == pytest.approx(work, abs=0.01 * np.ptp(work))
