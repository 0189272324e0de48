"""``jointgen simulate --form relative``: motion, reactions and efforts."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.chains.simulate import Settings
from codegen.chains.simulate_scene import refuse, simulated_relative
from codegen.errors import SpecificationError
from codegen.spec.scene import Drive, Scene
from codegen.spec.scene_file import read_scene
from tests.simulate.engine import holding_torque, motion, reactions, truth

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


def driven(scene: Scene, count: int = 1) -> Scene:
    """The first joints of a scene turn at 15 rad/s."""
    drive = Drive(Fraction(0), Fraction(15))
    joints = [
        replace(joint, coordinates=(replace(joint.coordinates[0], drive=drive),)) for joint in scene.joints[:count]
    ]
    return replace(scene, joints=(*joints, *scene.joints[count:]))


def test_more_drives_than_freedoms_are_refused() -> None:
    with pytest.raises(SpecificationError, match="2 drives for 1 freedoms"):
        simulated_relative(driven(example("in_line_engine"), 2), Settings("forward"))


def test_what_a_chain_does_not_have_is_refused_at_once() -> None:
    scene = example("in_line_engine")
    refuse(scene)
    text = (EXAMPLES / "in_line_engine.toml").read_text()
    more = '[[torque]]\nbody = "crank"\nvector = [0, 0, 1]\n'
    more += '[[spring]]\nbodies = ["ground", "crank"]\npoints = [[0, 1, 0], [0, 0, 0]]\nstiffness = 1.0\n'
    with pytest.raises(SpecificationError) as caught:
        refuse(read_scene(f"{text}\n{more}", "scene.toml"))
    assert len(caught.value.mistakes) == 2
