"""A scene as a chain: the same bodies in the same places, the same inertia, the same freedom."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.chains.mechanism import characteristic_length
from codegen.chains.programs import FUSED, program
from codegen.chains.relative import relative
from codegen.chains.stand import check_start
from codegen.mechanics.chain.model import kept_rows
from codegen.spec.chain import Chain
from codegen.spec.chain_forces import JointForce
from codegen.spec.chain_motions import Polynomial
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene
from flopcount.count import count
from tests.cli.runs import invoke, refused
from tests.mechanics.chain.series import Account
from tests.mechanics.chain.trees import start
from tests.spec.mechanism import AXES, Tree, at_rest, floats
from tests.spec.texts import PENDULUM

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "chain.md").read_text()
TOLD = re.findall(r"^\| `(\w+)` \| (\d+) \| (\d+) \| (\d+) \|$", PAGE, re.MULTILINE)

CARRIERS = {
    "revolute": "ground",
    "translational": "revolute",
    "cylindrical": "translational",
    "universal": "revolute",
    "planar": "universal",
    "ball": "planar",
    "rigid": "cylindrical",
}
"""Type of a joint, and the body of the same name, -> the body that carries it."""


def tree_text(swapped: frozenset[str] = frozenset()) -> str:
    """A scene with a joint of each type, bodies and joints anywhere."""
    random = np.random.default_rng(7)
    parts = ['name = "tree"', "gravity = [1.0, 2.0, -9.0]"]
    for kind, carrier in CARRIERS.items():
        q = random.normal(size=4)
        numbers = [[round(float(x), 6) for x in random.normal(size=3)] for _ in range(3)]
        axis2 = np.cross(numbers[2], numbers[1]).tolist()
        bodies = [kind, carrier] if kind in swapped else [carrier, kind]
        parts += ["[[body]]", f'name = "{kind}"', f"mass = {random.uniform(1, 2):.6f}"]
        parts += [f"inertia = {random.uniform(1, 1.5, 3).round(6).tolist()}", f"position = {numbers[0]}"]
        parts += [f"quaternion = {(q / np.linalg.norm(q)).tolist()}"]
        parts += ["[[joint]]", f'name = "{kind} joint"', f'type = "{kind}"', f"bodies = {json.dumps(bodies)}"]
        parts += [f"point = {numbers[1]}", f"axis = {numbers[2]}"]
        parts += [f"axis2 = {axis2}"] if kind == "universal" else []
    return "\n".join(parts)


def swapped_joints(scene: Scene) -> set[str]:
    """Joints whose second body carries the first."""
    return {joint.name for joint in scene.joints if joint.bodies[1] == _carrier(joint)}


def places(scene: Scene, chain: Chain) -> list[tuple[str, int]]:
    """Joint and coordinate of the scene for each link."""
    found = []
    for link in chain.links:
        joint, _, number = link.name.partition(" joint ")
        freedoms = len(AXES[joint])
        step = int(number) - 1 if number else freedoms - 1
        is_swapped = f"{joint} joint" in swapped_joints(scene)
        found.append((f"{joint} joint", freedoms - 1 - step if is_swapped else step))
    return found


def inertias(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """M of the chain and of the tree in a random pose, coordinates in the order of the chain."""
    chain = relative(scene).chain
    random = np.random.default_rng(3)
    whole = read_scene(tree_text(), "tree")
    values = {joint.name: random.normal(size=len(AXES[joint.type])) for joint in whole.joints}
    order = places(scene, chain)
    signs = np.array([-1.0 if name in swapped_joints(scene) else 1.0 for name, _ in order])
    q = start(chain) + signs * np.array([values[name][k] for name, k in order])
    tree = [(joint.name, k) for joint in whole.joints for k in range(len(AXES[joint.type]))]
    M = Tree(whole, {name: list(value) for name, value in values.items()}).mass_matrix()
    chosen = [tree.index(place) for place in order]
    return Account(chain, q).M(), signs[:, None] * M[np.ix_(chosen, chosen)] * signs


def _carrier(joint) -> str:
    return CARRIERS[joint.name.removesuffix(" joint")]


def test_a_tree_of_all_joints_has_the_inertia_that_its_coordinates_have():
    chain, tree = inertias(read_scene(tree_text(), "tree"))
    assert np.abs(chain - tree).max() < 1e-12 * np.abs(tree).max()


def test_joints_may_be_gone_through_from_their_second_body():
    swapped = frozenset({"revolute", "translational", "cylindrical", "rigid"})
    chain, tree = inertias(read_scene(tree_text(swapped), "tree"))
    assert np.abs(chain - tree).max() < 1e-12 * np.abs(tree).max()


@pytest.mark.parametrize("name", ["four_bar", "spatial_slider_crank", "bricard"])
def test_the_loops_of_an_example_are_closed_and_its_bodies_where_they_were(name):
    scene = read_scene((ROOT / "examples" / f"{name}.toml").read_text(), name)
    chain = relative(scene).chain
    check_start(chain)
    freedom = dict(re.findall(r"^\| `(\w+)\.toml` \|.*\| (\d+) \|$", (ROOT / "examples/README.md").read_text(), re.M))
    assert len(chain.independents) == int(freedom[name])
    frames = Account(chain, start(chain)).frames().reshape(-1, 4, 3)
    poses = at_rest(scene)
    for number, link in enumerate(chain.links):
        if link.name in poses and link.name != "ground":
            R, p = frames[number, :3].T, frames[number, 3]
            assert np.abs(p + R @ floats(link.centre) - poses[link.name][0]).max() < 1e-9
            world = poses[link.name][1] @ floats(scene.body(link.name).inertia) @ poses[link.name][1].T
            assert np.abs(R @ floats(link.inertia) @ R.T - world).max() < 1e-9 * np.abs(world).max()


@pytest.mark.parametrize(("name", "coordinates", "rows", "operations"), TOLD)
def test_the_page_tells_what_scenes_become(name, coordinates, rows, operations):
    chain = relative(read_scene((ROOT / "examples" / f"{name}.toml").read_text(), name)).chain
    assert (len(chain.links), len(kept_rows(chain))) == (int(coordinates), int(rows))
    assert count(program(chain, FUSED)).total == int(operations)


def test_lengths_that_rounding_left_in_place_of_zeros_do_not_count():
    chain = relative(read_scene((ROOT / "examples" / "bricard.toml").read_text(), "bricard")).chain
    tiny = Fraction(1, 10**17)
    rows = [replace(link.row, c=link.row.c or tiny, a=link.row.a or tiny) for link in chain.links]
    links = tuple(replace(link, row=row) for link, row in zip(chain.links, rows, strict=True))
    assert characteristic_length(replace(chain, links=links)) == characteristic_length(chain) > 0.1


def test_a_body_that_nothing_holds_is_free():
    text = re.sub(r"\[\[joint\]\].*?(?=\[\[body\]\]|\Z)", "", tree_text(), flags=re.DOTALL)
    found = relative(read_scene(text, "free"))
    assert len(found.chain.links) == 6 * len(CARRIERS)
    assert any("it is free" in line for line in found.notes)
    frames = Account(found.chain, start(found.chain)).frames().reshape(-1, 4, 3)
    poses = at_rest(read_scene(text, "free"))
    for number, link in enumerate(found.chain.links):
        if link.name in poses:
            where = frames[number, 3] + frames[number, :3].T @ floats(link.centre)
            assert np.abs(where - poses[link.name][0]).max() < 1e-12


def test_drives_and_forces_act_on_the_coordinates_of_the_chain():
    """The coordinate of the chain is that of the joint and a constant, which is its value at t = 0."""
    load = "torque = 2.0\nstiffness = 3.0\ndamping = 0.1\nrest = 0.5\ndrive = { position = 0.0, speed = 4.0 }\n"
    chain = relative(read_scene(PENDULUM + load, "pendulum")).chain
    (link,), (force,), (independent,) = chain.links, chain.joint_forces, chain.independents
    assert force == JointForce("bar", Fraction(2), Fraction(3), Fraction("0.1"), link.coordinate + Fraction("0.5"))
    assert independent.motion == Polynomial((link.coordinate, Fraction(4))) and independent.driven


def test_the_command_prints_the_tree_and_writes_the_package_of_a_chain(tmp_path):
    done = invoke("scene", ROOT / "examples" / "four_bar.toml", "--form", "relative", "-o", tmp_path / "out")
    assert done.exit_code == 0
    assert "closes a loop" in done.stderr
    manifest = json.loads((tmp_path / "out" / "manifest.json").read_text())
    assert len(manifest["chain"]["rows"]) == 3
    (line,) = refused(
        invoke("scene", ROOT / "examples" / "four_bar.toml", "--form", "relative", "--measure", "-o", tmp_path / "no")
    )
    assert line.startswith("--measure")
