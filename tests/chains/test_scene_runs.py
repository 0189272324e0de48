"""``jointgen simulate --form relative``: the motion and the reactions of the other forms."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.chains.simulate import Settings
from codegen.chains.simulate_scene import refuse, simulated_relative
from codegen.errors import SpecificationError
from codegen.scenes import run
from codegen.scenes.motion_record import record
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

EXAMPLES = Path(__file__).parents[2] / "examples"


def example(name: str) -> Scene:
    return read_scene((EXAMPLES / f"{name}.toml").read_text(), name)


@pytest.mark.parametrize("name", ["in_line_engine_driven", "in_line_engine"])
def test_relative_and_absolute_coordinates_give_one_motion(name: str) -> None:
    scene = example("in_line_engine")
    if name.endswith("driven"):
        scene = driven(scene)
    relative = simulated_relative(scene, Settings("forward", 0.3, 30, 1e-9)).trajectory
    prepared = run.prepare(replace(scene, motion="planar"), run.Settings())
    absolute = record(prepared, run.run(prepared, run.Settings(0.3, 30, 1e-9))).trajectory
    limits = {"r": 1e-6, "v": 1e-5, "w": 1e-4, "a": 1e-3, "al": 1e-2}
    found = {word: np.max(np.abs(getattr(relative, word) - getattr(absolute, word))) for word in limits}
    assert {word: error for word, error in found.items() if error > limits[word]} == {}
    # In the plane of an engine its loop determines these.
    for joint in ("main bearing", "crank pin", "piston pin"):
        difference = relative.reaction[joint][:, :2] - absolute.reaction[joint][:, :2]
        assert np.max(np.abs(difference)) < 1e-3 * np.max(np.abs(absolute.reaction[joint]))
    for joint, effort in absolute.effort.items():
        assert np.max(np.abs(relative.effort[joint] - effort)) < 1e-4 * np.max(np.abs(effort))


def driven(scene: Scene) -> Scene:
    from codegen.spec.scene import Drive

    bearing = scene.joints[0]
    drive = Drive(Fraction(0), Fraction(15))
    loaded = replace(bearing, coordinates=(replace(bearing.coordinates[0], drive=drive),))
    return replace(scene, joints=(loaded, *scene.joints[1:]))


def test_what_a_chain_does_not_have_is_refused_at_once() -> None:
    scene = example("in_line_engine")
    refuse(scene)
    text = (EXAMPLES / "in_line_engine.toml").read_text()
    more = '[[torque]]\nbody = "crank"\nvector = [0, 0, 1]\n'
    more += '[[spring]]\nbodies = ["ground", "crank"]\npoints = [[0, 1, 0], [0, 0, 0]]\nstiffness = 1.0\n'
    with pytest.raises(SpecificationError) as caught:
        refuse(read_scene(f"{text}\n{more}", "scene.toml"))
    assert len(caught.value.mistakes) == 2
