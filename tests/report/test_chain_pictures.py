"""The pictures of a chain's run show its links where they are."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from codegen.chains.mechanism import parted
from codegen.chains.read import read
from codegen.chains.simulate import Settings, SimulatedChain, simulated
from codegen.report.animation import page_data
from codegen.report.chain_pictures import as_scene, as_trajectory, chain_pictures
from codegen.spec.scene import GROUND

CHAINS = Path(__file__).parents[2] / "examples" / "chains"
NAMES = ("quick_return", "spatial_slider_crank")


@cache
def run(name: str) -> SimulatedChain:
    chain, tables = read(CHAINS / f"{name}.toml")
    return simulated(chain, tables, Settings("inverse", 0.5, 10))


@pytest.mark.parametrize("name", NAMES)
def test_joints_stand_at_one_place_on_both_bodies(name: str) -> None:
    done = run(name)
    scene = as_scene(done.mechanism, done.record)
    poses = {GROUND: np.eye(3, 4)} | {
        link.name: done.record.frames[0, k] for k, link in enumerate(done.mechanism.chain.links)
    }
    for joint in scene.joints:
        ends = [
            poses[body] @ np.array([*marker.point, 1], dtype=float)
            for body, marker in zip(joint.bodies, (joint.marker_i, joint.marker_j), strict=True)
        ]
        axes = [
            poses[body][:, :3] @ np.array(marker.axes, dtype=float)
            for body, marker in zip(joint.bodies, (joint.marker_i, joint.marker_j), strict=True)
        ]
        assert np.max(np.abs(axes[0][:, 2] - axes[1][:, 2])) < 1e-12
        apart = ends[1] - ends[0]
        if joint.type == "translational":
            apart -= (apart @ axes[0][:, 2]) * axes[0][:, 2]
        assert np.max(np.abs(apart)) < 1e-12


def test_a_plot_that_has_no_room_for_all_coordinates_has_the_independent_ones() -> None:
    done = run("quick_return")
    mechanism = parted(done.mechanism.chain, done.mechanism.equations, [5, 3])
    names = list(as_trajectory(mechanism, done.record, has_bodies=False).alpha)
    assert names == ["pivot", "coupler", "crank", "block", "rocker", "slider", "slide"]


@pytest.mark.parametrize("name", NAMES)
def test_the_page_holds_the_poses_of_the_links(name: str) -> None:
    done = run(name)
    trajectory = as_trajectory(done.mechanism, done.record, has_bodies=True)
    data = page_data(as_scene(done.mechanism, done.record), trajectory)
    last = [[p[-1] if isinstance(p, list) else p for p in body["pose"]] for body in data["bodies"]]
    for k, pose in enumerate(last):
        frame = done.record.frames[-1, k]
        w, *u = pose[3:]
        z = np.array([2 * (u[0] * u[2] + w * u[1]), 2 * (u[1] * u[2] - w * u[0]), 1 - 2 * (u[0] ** 2 + u[1] ** 2)])
        assert pose[:3] == pytest.approx(frame[:, 3], abs=1e-4)
        assert z == pytest.approx(frame[:, 2], abs=1e-4)


@pytest.mark.parametrize("name", NAMES)
def test_pictures_are_the_same_bytes_again_and_name_every_moving_joint(name: str) -> None:
    done = run(name)
    once = chain_pictures(done.mechanism, done.record, True)
    assert once == chain_pictures(done.mechanism, done.record, True)
    assert sorted(once) == ["animation.html", "plot.svg"]
    text = once["plot.svg"].decode()
    moving = [link.name for k, link in enumerate(done.mechanism.chain.links) if np.ptp(done.record.q[:, k]) > 1e-9]
    assert {f"{link}.alpha1" for link in moving} == set(re.findall(r'id="([^"]*\.alpha1)"', text))
    assert "centres of mass" not in text, "no bodies are drawn"
    assert "or the 2nd" not in text, "joints of chains have one coordinate"


def test_a_summary_is_json_without_numbers_that_are_none() -> None:
    numbers = json.loads(run("quick_return").files["summary.json"])
    assert numbers["binding_rows"] == 6
    assert numbers["joint_balance"] < 1e-12
    assert "cut.slide axis.fy" in numbers["undetermined"]
    assert "cut.slide axis.fx" not in numbers["undetermined"]
