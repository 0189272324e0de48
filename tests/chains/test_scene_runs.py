"""``jointgen simulate --form relative``: motion, reactions and efforts."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.chains.simulate import Settings
from codegen.chains.simulate_scene import simulated_relative
from codegen.errors import SpecificationError
from codegen.scenes.run import Settings as SceneSettings
from codegen.scenes.simulate import simulated
from codegen.spec.scene import Drive, Scene
from codegen.spec.scene_file import read_scene
from tests.simulate.engine import INERTIAS, MASSES, geometry, holding_torque, motion, reactions, truth

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name: str) -> Scene:
    return read_scene((EXAMPLES / f"{name}.toml").read_text(), name)


def test_a_scene_moves_and_reacts_as_one_degree_of_freedom_does() -> None:
    found = simulated_relative(example("in_line_engine"), Settings("forward", 0.3, 30, 1e-10)).trajectory
    true = truth(found.t)
    assert np.max(np.abs(found.r[..., :2] - true.r)) < 1e-8
    assert np.max(np.abs(found.v[..., :2] - true.v)) < 1e-7
    assert np.max(np.abs(found.a[..., :2] - true.a)) < 1e-5
    assert np.max(np.abs(found.w[..., 2] - true.omega)) < 1e-7
    assert np.max(np.abs(found.al[..., 2] - true.omegadot)) < 1e-5
    assert np.max(np.abs(found.alpha["main bearing"][:, 0] - true.angle[:, 0])) < 1e-8
    for joint, force in reactions(true).items():
        assert np.max(np.abs(found.reaction[joint][:, :2] - force)) < 1e-6 * np.max(np.abs(force))


def test_a_driven_scene_tells_the_effort_of_its_drive() -> None:
    found = simulated_relative(driven(example("in_line_engine")), Settings("forward", 0.3, 30)).trajectory
    angle, speed = 15 * found.t, np.full_like(found.t, 15.0)
    assert np.max(np.abs(found.r[..., :2] - motion(angle, speed).r)) < 1e-9
    effort = holding_torque(angle, speed)
    assert np.max(np.abs(found.effort["main bearing"][:, 0] - effort)) < 1e-6 * np.max(np.abs(effort))


def test_a_drive_that_swings_tells_the_effort_that_moves_the_inertia_too() -> None:
    swing = Drive(Fraction(0), Fraction(15), Fraction("0.3"), Fraction(20))
    found = simulated_relative(driven(example("in_line_engine"), swing=swing), Settings("forward", 0.3, 30)).trajectory
    sine, cosine = np.sin(20 * found.t), np.cos(20 * found.t)
    angle, speed, bend = 15 * found.t + 0.3 * sine, 15 + 6 * cosine, -120 * sine
    expected = motion(angle, speed)
    assert np.max(np.abs(found.r[..., :2] - expected.r)) < 1e-9
    assert np.max(np.abs(found.w[..., 2] - expected.omega)) < 1e-8
    (_, slope, _), (_, turn, _) = geometry(angle)
    inertia = np.sum(MASSES[:, None] * slope**2, (-2, -1)) + np.sum(INERTIAS * turn**2, -1)
    effort = inertia * bend + holding_torque(angle, speed)
    assert np.max(np.abs(found.effort["main bearing"][:, 0] - effort)) < 1e-6 * np.max(np.abs(effort))


STEADY = Drive(Fraction(0), Fraction(15))


def driven(scene: Scene, count: int = 1, swing: Drive = STEADY) -> Scene:
    """The first joints of a scene turn, at 15 rad/s or otherwise."""
    joints = [
        replace(joint, coordinates=(replace(joint.coordinates[0], drive=swing),)) for joint in scene.joints[:count]
    ]
    return replace(scene, joints=(*joints, *scene.joints[count:]))


def test_more_drives_than_freedoms_are_refused() -> None:
    with pytest.raises(SpecificationError, match="together they drive 1 of 1 freedoms") as caught:
        simulated_relative(driven(example("in_line_engine"), 3), Settings("forward"))
    assert len(caught.value.mistakes) == 2


BOOM = """
name = "boom"
gravity = [0.0, -9.81, 0.0]
motion = "planar"
[[body]]
name = "boom"
mass = 2.0
inertia = [0.02, 0.05, 0.06]
position = [0.3, 0.0, 0.0]
[[body]]
name = "trolley"
mass = 1.0
inertia = [0.01, 0.012, 0.011]
position = [0.2, 0.1, 0.0]
velocity = [0.4, 0.0, 0.0]
[[joint]]
name = "foot"
type = "revolute"
bodies = ["ground", "boom"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
damping = 0.1
limit = { lower = -0.2, upper = 1.0, stiffness = 500.0, damping = 2.0 }
[[joint]]
name = "rail"
type = "translational"
bodies = ["trolley", "boom"]
point = [0.0, 0.1, 0.0]
axis = [1.0, 0.0, 0.0]
drive = { position = 0.0, speed = -0.4 }
[[spring]]
bodies = ["ground", "trolley"]
points = [[0.2, 0.6, 0.0], [0.05, 0.0, 0.0]]
stiffness = 15.0
damping = 0.5
length = 0.3
[[torque]]
body = "trolley"
vector = [0.0, 0.0, -0.8]
"""
"""A trolley that is driven along a boom, which falls on its stop."""


def test_springs_torques_stops_and_a_drive_of_one_freedom_move_bodies_as_in_absolute_coordinates() -> None:
    scene = read_scene(BOOM, "boom")
    found = simulated_relative(scene, Settings("forward", 0.35, 5, 1e-8)).trajectory
    true = simulated(scene, SceneSettings(duration=0.35, outputs=5, tolerance=1e-8)).trajectory
    assert true.alpha["foot"].min() < -0.22
    for name, bound in {"r": 1e-8, "v": 1e-7, "w": 3e-7, "a": 1e-5, "al": 3e-5}.items():
        assert np.max(np.abs(getattr(found, name) - getattr(true, name))) < bound, name
    assert np.max(np.abs(found.effort["rail"] - true.effort["rail"])) < 1e-5
    for joint in ("foot", "rail"):
        assert np.max(np.abs(found.reaction[joint] - true.reaction[joint])) < 1e-5


VANE = """
name = "vane"
gravity = [0.0, 0.0, -9.81]
[[body]]
name = "vane"
mass = 2.0
inertia = [[0.2, 0.01, 0.0], [0.01, 0.21, 0.02], [0.0, 0.02, 0.3]]
position = [0.3, 0.4, 0.0]
quaternion = [0.6, 0.0, 0.0, 0.8]
[[joint]]
name = "cross"
type = "universal"
bodies = ["ground", "vane"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
axis2 = [1.0, 0.0, 0.0]
[[force]]
body = "vane"
vector = [8.0, -3.0, 30.0]
point = [0.2, -0.1, 0.3]
[[force]]
body = "vane"
vector = [0.0, 5.0, 0.0]
"""
"""Pushed off its centre of mass and at it."""


def test_forces_at_points_move_a_body_as_in_absolute_coordinates() -> None:
    scene = read_scene(VANE, "vane")
    found = simulated_relative(scene, Settings("forward", 0.5, 5, 1e-10)).trajectory
    true = simulated(scene, SceneSettings(duration=0.5, outputs=5, tolerance=1e-10)).trajectory
    assert np.max(np.abs(true.w)) > 4  # it moves
    for name, bound in {"r": 1e-8, "v": 1e-7, "w": 3e-7, "a": 1e-5, "al": 3e-5}.items():
        assert np.max(np.abs(getattr(found, name) - getattr(true, name))) < bound, name
    assert np.max(np.abs(found.reaction["cross"] - true.reaction["cross"])) < 1e-5


JACK = """
name = "jack"
gravity = [0.0, 0.0, -9.81]
[[body]]
name = "rod"
mass = 2.0
inertia = [0.2, 0.21, 0.02]
position = [0.01, 0.0, 0.4]
[[body]]
name = "nut"
mass = 1.0
inertia = [0.02, 0.02, 0.03]
position = [0.0, 0.0, 0.1]
[[joint]]
name = "slide"
type = "translational"
bodies = ["rod", "ground"]
point = [0.0, 0.1, 0.0]
axis = [0.0, 0.0, 1.0]
[[joint]]
name = "bearing"
type = "revolute"
bodies = ["ground", "nut"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
[[joint]]
name = "thread"
type = "screw"
bodies = ["rod", "nut"]
point = [0.0, 0.0, 0.2]
axis = [0.0, 0.0, 1.0]
pitch = 0.05
"""
"""A rod that slides down while the nut in which it is turns: z = -0.05 theta."""


def test_a_screw_that_closes_a_loop_moves_as_one_degree_of_freedom_does() -> None:
    found = simulated_relative(read_scene(JACK, "jack"), Settings("forward", 2.0, 5, 1e-9)).trajectory
    p, m, J = 0.05, 2.0, 0.03
    angle = m * 9.81 * p / (J + m * p * p) / 2 * found.t**2
    assert angle[-1] > 4 * np.pi
    assert np.max(np.abs(found.alpha["thread"][:, 0] - angle)) < 1e-7
    assert np.max(np.abs(found.r[:, 0, 2] - 0.4 + p * angle)) < 1e-8
    thrust = J * 2 * angle[-1] / found.t[-1] ** 2 / p
    assert found.reaction["thread"][:, 2] == pytest.approx(-thrust, abs=1e-9)


@pytest.mark.parametrize("bodies", ['["ground", "nut"]', '["nut", "ground"]'])
def test_a_nut_on_a_screw_counts_its_turns_and_feels_both_inertias(bodies: str) -> None:
    text = JACK[: JACK.index("[[body]]")] + JACK[JACK.index('[[body]]\nname = "nut"') : JACK.index("[[joint]]")]
    thread = JACK[JACK.index('[[joint]]\nname = "thread"') :].replace('["rod", "nut"]', bodies)
    run = simulated_relative(read_scene(f"{text}{thread}torque = 1.2\n", "nut"), Settings("forward", 1.5, 3, 1e-10))
    sense, p = 1 if bodies.startswith('["ground') else -1, 0.05
    angle = (1.2 - sense * 9.81 * p) / (0.03 + p * p) / 2 * run.trajectory.t**2
    assert abs(angle[-1]) > 7 * np.pi
    assert run.trajectory.alpha["thread"][:, 0] == pytest.approx(angle, rel=1e-9)
    assert run.trajectory.r[:, 0, 2] == pytest.approx(0.1 + sense * p * angle, rel=1e-9)
