"""Models of MuJoCo as scenes: what MuJoCo computes of the same text is the truth."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.errors import SpecificationError
from codegen.spec.imported import ImportOptions, Stops
from codegen.spec.mjcf import read_mjcf
from codegen.spec.scene import Coordinate, Joint, Scene
from tests.spec.mechanism import Tree, at_rest, floats, frame_in_world
from tests.spec.truth import TOLERANCE, loaded, same_at_start, same_bodies, same_in_motion

pytest.importorskip("mujoco")
pytest.importorskip("defusedxml")

FOUR_BAR = (Path(__file__).parents[2] / "examples" / "four_bar.xml").read_text()
MASS = '<inertial mass="2" pos="0.1 -0.2 0.3" fullinertia="0.3 0.25 0.4 0.01 -0.02 0.03"/>'


def model_of(bodies: str, rest: str = "") -> str:
    return f'<mujoco model="m"><compiler angle="radian"/><worldbody>{bodies}</worldbody>{rest}</mujoco>'


def body(joints: str, inside: str = "", name: str = "a", where: str = 'pos="1 2 3"', mass: str = MASS) -> str:
    return f'<body name="{name}" {where}>{joints}{mass}{inside}</body>'


STACKS = {
    "cylindrical": (
        '<joint name="s" type="slide" axis="1 2 -1" pos="0.1 0 0"/><joint name="h" axis="-1 -2 1" pos="0 1 0"/>',
        [-1, 1],
    ),
    "universal": (
        '<joint name="h" axis="1 2 0" pos="0 0.3 0.4"/><joint name="k" axis="-2 1 3" pos="-0.2 0.4 0.7"/>',
        [1, 1],
    ),
    "ball": (
        '<joint name="h" axis="0 1 0" pos="0.1 0.2 0.3"/><joint name="k" axis="1 0 1" pos="0.1 0.2 0.3"/>'
        '<joint name="l" axis="1 0 -1" pos="0.1 0.2 0.3"/>',
        [1, 1, -1],
    ),
    "planar": (
        '<joint name="s" type="slide" axis="1 1 0"/><joint name="t" type="slide" axis="1 -1 0"/>'
        '<joint name="h" axis="0 0 1" pos="0.3 0.2 0.1"/>',
        [1, -1, 1],
    ),
}
"""Joints of one body, and whether each coordinate of the joint that they make counts as theirs or against it."""


@pytest.mark.parametrize("kind", STACKS)
def test_a_stack_of_joints_moves_as_the_joint_that_it_becomes(kind):
    import mujoco

    joints, signs = STACKS[kind]
    joints = joints.replace("<joint ", '<joint stiffness="2" springref="0.25" ')
    text = model_of(body('<joint name="first" axis="1 1 1"/>', body(joints, "", "b", 'quat="0.6 0 0.8 0"')))
    scene = read_mjcf(text, "x").scene
    stack = scene.joints[1]
    assert stack.type == kind
    model, data = loaded(text)
    same_at_start(scene, model, data)
    for seed in range(3):
        values = np.random.default_rng(seed).uniform(-1.2, 1.2, len(signs))
        for name, value, sign in zip(stack.name.split(" + "), values, signs, strict=True):
            data.qpos[model.joint(name).qposadr[0]] = sign * value
        mujoco.mj_forward(model, data)
        same_bodies(scene, model, data, Tree(scene, {stack.name: list(values)}).poses)
    assert [coordinate.rest for coordinate in stack.coordinates] == [Fraction(sign, 4) for sign in signs]


@pytest.mark.parametrize(
    "joints",
    [
        '<joint name="h"/><joint name="k" axis="0 1 1"/>',
        '<joint name="h"/><joint name="k" axis="0 1 0" pos="1 0 0"/>',
        '<joint name="h"/><joint name="k" type="slide" axis="1 0 0"/>',
        '<joint name="h"/><joint name="k" axis="1 0 0"/><joint name="l" axis="1 0 1"/>',
        '<joint name="k" type="ball"/><joint name="h" type="slide"/>',
        '<joint name="s" type="slide" axis="1 0 0"/><joint name="t" type="slide" axis="0 1 0"/>',
        '<joint name="h"/><joint name="s" type="slide" axis="1 0 0" damping="1"/>'
        '<joint name="t" type="slide" axis="0 1 0"/>',
    ],
)
def test_a_stack_that_is_no_joint_is_refused(joints, recwarn):
    with pytest.raises(SpecificationError, match="put a body with a mass between them"):
        read_mjcf(model_of(body(joints)), "x")
    assert not recwarn.list


def random_model(generator: np.random.Generator, depth: int, name: str = "b") -> str:
    def some(low: float, high: float, count: int = 3) -> str:
        return " ".join(f"{value:.6f}" for value in generator.uniform(low, high, count))

    kind = generator.choice(["hinge", "slide", "none"], p=[0.6, 0.25, 0.15])
    joint = "" if kind == "none" else f'<joint name="{name}j" type="{kind}" axis="{some(-1, 1)}" pos="{some(-1, 1)}"/>'
    masses = f'<geom type="box" size="{some(0.05, 0.3)}" pos="{some(-1, 1)}" euler="{some(-90, 90)}"/>' + (
        f'<geom type="capsule" size="{some(0.05, 0.2, 2)}" pos="{some(-1, 1)}" density="300"/>'
    )
    branches = generator.integers(1, 3) if depth else 0
    inside = joint + masses + "".join(random_model(generator, depth - 1, f"{name}{k}") for k in range(branches))
    return f'<body name="{name}" pos="{some(-1, 1)}" euler="{some(-180, 180)}">{inside}</body>'


@pytest.mark.parametrize("seed", range(12))
def test_a_random_tree_moves_as_in_mujoco(seed):
    generator = np.random.default_rng(seed)
    text = model_of(random_model(generator, 3)).replace('"radian"', '"degree" fusestatic="true"')
    scene = read_mjcf(text, "x").scene
    model, data = loaded(text)
    same_at_start(scene, model, data)
    same_in_motion(scene, model, data, {}, generator)


def closed(scene: Scene, *joints: Joint) -> None:
    """The frames of each joint are one at t = 0."""
    poses = at_rest(scene)
    for joint in joints:
        first = frame_in_world(joint.marker_i, poses[joint.bodies[0]])
        second = frame_in_world(joint.marker_j, poses[joint.bodies[1]])
        np.testing.assert_allclose(first[0], second[0], rtol=0, atol=2e-15)
        np.testing.assert_allclose(first[1], second[1], rtol=0, atol=2e-15)


def test_the_four_bar_is_closed_and_exact():
    read = read_mjcf(FOUR_BAR, "four_bar.xml")
    _, data = loaded(FOUR_BAR)
    closed(read.scene, *read.scene.joints)
    for part in read.scene.bodies:
        np.testing.assert_allclose(floats(part.position), data.body(part.name).xipos, rtol=0, atol=TOLERANCE)
    assert [(joint.type, joint.bodies) for joint in read.scene.joints][2:] == [
        ("revolute", ("coupler", "rocker")),
        ("ball", ("rocker", "ground")),
    ]
    assert read.scene.body("coupler").inertia[0] == (Fraction("0.0022"), 0, Fraction("-0.0036"))
    spring = Coordinate(stiffness=Fraction("1.5"), damping=Fraction("0.002"), rest=Fraction("0.2"))
    assert read.scene.joints[2].coordinates == (spring,)
    assert {item.element for item in read.left_out} == {"option", "light", "geom", "motor", "jointpos"}


def test_a_coordinate_counts_from_the_initial_pose():
    text = model_of(
        body('<joint name="h" ref="0.3" springref="0.5" stiffness="2" range="-1 1" limited="true" damping="0.1"/>')
    )
    (coordinate,) = (
        read_mjcf(text, "x", ImportOptions(stops=Stops(*map(Fraction, (9, 8, 7, 6))))).scene.joints[0].coordinates
    )
    assert (coordinate.stiffness, coordinate.damping, coordinate.rest) == (2, Fraction("0.1"), Fraction("0.2"))
    assert (coordinate.limit.lower, coordinate.limit.upper, coordinate.limit.stiffness) == (
        Fraction("-1.3"),
        Fraction("0.7"),
        9,
    )


def test_loops_become_ball_and_rigid_joints_that_close():
    arms = body('<joint name="h"/>', "", "a") + body(
        '<joint name="k" axis="0 1 0"/>', "", "b", 'pos="0 1 0" euler="0.3 1 2"'
    )
    text = model_of(
        arms.replace("</body>", '<site name="at a" pos="0 1 2"/></body>', 1).replace(
            '<joint name="k"', '<site name="at b" pos="0 0 0"/><joint name="k"'
        ),
        '<equality><connect name="c" body1="a" body2="b" anchor="0.1 0.2 0.3"/><weld name="w" body1="b" body2="a"/>'
        '<weld name="off" body1="a" active="false"/><joint name="gear" joint1="h" joint2="k"/></equality>',
    )
    read = read_mjcf(text, "x")
    kinds = {joint.name: joint for joint in read.scene.joints}
    assert kinds["c"].type == "ball" and kinds["w"].type == "rigid" and "off" not in kinds
    closed(read.scene, kinds["c"], kinds["w"])
    assert [(item.element, item.place) for item in read.left_out if item.element not in ("site",)] == [
        ("joint", 'x: joint "gear"'),
        ("weld", 'x: "off"'),
    ]


def test_sites_that_are_apart_do_not_close_a_loop():
    arms = body('<joint name="h"/><site name="p" pos="-1 -2 -3"/>')
    for where, is_closed in (("0 0 0", True), ("0 0 0.001", False)):
        text = model_of(
            f'<site name="q" pos="{where}"/>{arms}', '<equality><connect site1="p" site2="q" name="c"/></equality>'
        )
        if is_closed:
            assert read_mjcf(text, "x").scene.joints[1].bodies == ("a", "ground")
        else:
            with pytest.raises(SpecificationError, match="open at t = 0, by 1 mm"):
                read_mjcf(text, "x")


def test_free_bodies_have_no_joint_and_fixed_ones_are_part_of_their_parent():
    fixed = body("", "", "c", 'pos="0 0 1"')
    text = model_of(
        body("<freejoint/>", fixed) + body("", body('<joint name="h" type="ball" damping="1"/>', "", "e"), "d")
    )
    read = read_mjcf(text, "x")
    assert [part.name for part in read.scene.bodies] == ["a", "e"]
    assert [(joint.name, joint.type, joint.bodies) for joint in read.scene.joints] == [("h", "ball", ("ground", "e"))]
    assert read.scene.bodies[0].mass == 4
    assert [(item.element, item.place) for item in read.left_out] == [
        ("damping", 'x: joint "h"'),
        ("mass", 'x: body "d"'),
    ]
    _, data = loaded(text.replace("<compiler", '<compiler fusestatic="true"'))
    for part in read.scene.bodies:
        np.testing.assert_allclose(floats(part.position), data.body(part.name).xipos, rtol=0, atol=TOLERANCE)


def test_what_a_joint_has_beyond_the_scene_is_listed():
    text = model_of(
        '<body name="a" gravcomp="1"><joint name="h" armature="0.1" frictionloss="0.2" range="0 1" limited="true" '
        f'stiffness="1 2" damping="1 2"/>{MASS}</body>',
        '<tendon><fixed name="t"><joint joint="h" coef="1"/></fixed></tendon><contact>'
        '<exclude body1="a" body2="world"/>'
        '</contact><keyframe><key name="k" qpos="1"/></keyframe><visual/><option timestep="0.1"/>',
    )
    assert {item.element for item in read_mjcf(text, "x").left_out} == {
        *("gravcomp", "armature", "frictionloss", "range", "stiffness", "damping"),
        *("fixed", "exclude", "key", "visual", "option"),
    }


def test_gravity_is_that_of_the_file():
    for option, gravity in (
        ('<option gravity="1 -2.5 3"/>', ("1", "-2.5", "3")),
        ('<option><flag gravity="disable"/></option>', ("0", "0", "0")),
    ):
        scene = read_mjcf(model_of(body('<joint name="h"/>'), option), "x").scene
        assert scene.gravity == tuple(map(Fraction, gravity))


def test_files_beside_the_model_are_taken_and_no_others():
    shape = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    joints = b'<mujoco><default><joint damping="0.5"/></default></mujoco>'
    text = model_of(
        body('<joint name="h"/><geom type="mesh" mesh="m"/>', mass=""),
        '<include file="parts/joints.xml"/><asset><mesh name="m" file="shape.obj"/><texture name="t" type="2d" '
        'file="nowhere.png"/></asset>',
    ).replace("<compiler", '<compiler meshdir="shapes"')
    read = read_mjcf(text, "x", files={"parts/joints.xml": joints, "shapes/shape.obj": shape})
    assert abs(float(read.scene.bodies[0].mass) - 1000 / 6) < 1e-4
    assert read.scene.joints[0].coordinates[0].damping == Fraction("0.5")
