"""The spatial slider-crank as a chain and as a scene with absolute coordinates: the same motion and effort."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path

import pytest

from codegen.chains.simulate import Settings, simulated
from codegen.scenes.run import Settings as SceneSettings
from codegen.scenes.simulate import simulated as scene_simulated
from codegen.spec.chain import Chain
from codegen.spec.scene import Coordinate, Drive
from codegen.spec.scene_file import read_scene

from .mechanisms import spatial_slider_crank

FILE = Path(__file__).parents[2] / "examples" / "spatial_slider_crank.toml"


@pytest.mark.slow
def test_slider_and_drive_agree_with_absolute_coordinates() -> None:
    """The scene's masses and inertias are put on the chain; its crank is not balanced, and turns about -x."""
    scene = read_scene(FILE.read_text(), FILE.name)
    bearing = scene.joints[0]
    drive = Coordinate(drive=Drive(F(0), -F("6.2831853071795864769")))
    joints = (replace(bearing, coordinates=(drive,), form="parametric"), *scene.joints[1:])
    by_scene = scene_simulated(replace(scene, joints=joints), SceneSettings(0.25, 10, 1e-10)).trajectory
    by_chain = simulated(_with_masses_of(), {}, Settings("inverse", 0.25, 10)).record
    slider = by_scene.bodies.index("slider")
    assert by_chain.tau is not None
    assert by_scene.r[:, slider, 0] == pytest.approx(by_chain.q[:, -1], abs=1e-8)
    assert by_scene.v[:, slider, 0] == pytest.approx(by_chain.qd[:, -1], abs=1e-7)
    effort = by_scene.effort[bearing.name][:, 0]
    assert -effort == pytest.approx(by_chain.tau[:, 0], abs=1e-5)


def _with_masses_of() -> Chain:
    """The chain with the masses of the scene: rod inertia 0.00002 along, 0.003 across; crank's centre in its middle."""
    chain = spatial_slider_crank()
    changed = {
        "crank": ((F("0.04"), F(0), F(0)), (F("0.00001"), F("0.0001"), F("0.0001"))),
        "rod": ((F(0), F(0), F("0.135")), (F("0.003"), F("0.003"), F("0.00002"))),
        "slider": ((F(0), F(0), F(0)), (F("0.001"),) * 3),
    }
    links = []
    for link in chain.links:
        if link.name in changed:
            centre, moments = changed[link.name]
            inertia = tuple(tuple(moments[i] if i == k else F(0) for k in range(3)) for i in range(3))
            link = replace(link, centre=centre, inertia=inertia)  # type: ignore[arg-type]
        links.append(link)
    return replace(chain, links=tuple(links))
