"""Robots from URDF: MuJoCo, which has a reader of its own, is the truth for kinematics and masses."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from codegen.spec.imported import ImportOptions, Stops
from codegen.spec.scene import Limit
from codegen.spec.urdf import read_urdf
from tests.spec.mechanism import floats
from tests.spec.truth import loaded, same_at_start, same_in_motion

pytest.importorskip("mujoco")
pytest.importorskip("defusedxml")

ARM = (Path(__file__).parents[2] / "examples" / "robot.urdf").read_text()
LINK = """<link name="{0}"><inertial><mass value="2"/>
<inertia ixx="0.3" ixy="0" ixz="0" iyy="0.2" iyz="0" izz="0.4"/></inertial></link>"""
HINGE = """<joint name="{0}" type="{1}"><parent link="{2}"/><child link="{3}"/>{4}</joint>"""


def robot(*parts: str) -> str:
    return f'<robot name="r">{"".join(parts)}</robot>'


def theirs(text: str) -> str:
    """The same robot for MuJoCo, without files of shapes."""
    text = text.replace('<mesh filename="package://six_axis_arm/meshes/shoulder.stl"/>', '<sphere radius="0.1"/>')
    return text.replace("</robot>", '<mujoco><compiler discardvisual="true" fusestatic="true"/></mujoco></robot>')


def random_robot(generator: np.random.Generator, links: int) -> str:
    def three(low: float, high: float) -> str:
        return " ".join(f"{value:.7f}" for value in generator.uniform(low, high, 3))

    parts = []
    for k in range(links):
        edges = generator.uniform(0.05, 0.2, 3)
        xx, yy, zz = (edges[1] + edges[2], edges[0] + edges[2], edges[0] + edges[1])
        parts.append(
            f'<link name="L{k}"><inertial><origin xyz="{three(-0.2, 0.2)}" rpy="{three(-3, 3)}"/>'
            f'<mass value="{generator.uniform(0.5, 3):.4f}"/>'
            f'<inertia ixx="{xx:.5f}" iyy="{yy:.5f}" izz="{zz:.5f}" ixy="0.01" ixz="-0.003" iyz="0.007"/>'
            f"</inertial></link>"
        )
    for k in range(1, links):
        kind = generator.choice(["revolute", "continuous", "prismatic", "fixed"])
        parts.append(
            f'<joint name="J{k}" type="{kind}"><parent link="L{generator.integers(0, k)}"/><child link="L{k}"/>'
            f'<origin xyz="{three(-1, 1)}" rpy="{three(-3, 3)}"/><axis xyz="{three(-1, 1)}"/>'
            f'<limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
        )
    return robot(*parts)


def test_the_arm_moves_as_in_mujoco():
    scene = read_urdf(ARM, "robot.urdf").scene
    model, data = loaded(theirs(ARM))
    same_at_start(scene, model, data)
    for seed in range(5):
        same_in_motion(scene, model, data, {}, np.random.default_rng(seed))


@pytest.mark.parametrize("seed", range(12))
def test_a_random_robot_moves_as_in_mujoco(seed):
    generator = np.random.default_rng(seed)
    text = random_robot(generator, 9)
    scene = read_urdf(text, "r.urdf").scene
    model, data = loaded(theirs(text))
    same_at_start(scene, model, data)
    same_in_motion(scene, model, data, {}, generator)


def test_fixed_links_that_stay_bodies_weigh_as_much_as_one():
    merged = read_urdf(ARM, "robot.urdf").scene
    kept = read_urdf(ARM, "robot.urdf", ImportOptions(keep_fixed=True)).scene
    moving = [body for body in kept.bodies if body.name != "base"]
    assert sum(body.mass for body in moving) == sum(body.mass for body in merged.bodies)
    first = sum((float(body.mass) * floats(body.position) for body in moving), np.zeros(3))
    np.testing.assert_allclose(
        first, sum((float(body.mass) * floats(body.position) for body in merged.bodies), np.zeros(3)), atol=1e-15
    )
    assert [joint.type for joint in kept.joints if joint.name == "gripper fixed"] == ["rigid"]


def test_numbers_are_the_decimals_of_the_file():
    scene = read_urdf(ARM, "robot.urdf").scene
    arm = scene.body("upper arm")
    assert arm.mass == Fraction("5.8") and arm.inertia[1][2] == Fraction("0.0023")
    assert scene.body("forearm").position == (Fraction("0.11"), Fraction("-0.016"), Fraction("0.61"))
    lift = scene.joints[1]
    assert lift.marker_i.point == (0, Fraction("-0.048"), Fraction("0.038"))
    assert {component for row in lift.marker_i.axes for component in row} <= {-1, 0, 1}


def test_everything_that_is_not_modelled_is_listed():
    listed = {(item.element, item.place.removeprefix("a: ")) for item in read_urdf(ARM, "a").left_out}
    for element in ("visual", "collision", "mass"):
        assert (element, 'link "base"') in listed
    assert ("dynamics: friction", 'joint "turn"') in listed
    assert ("limit: effort, velocity", 'joint "twist"') in listed
    assert ("transmission", 'transmission "turn drive"') in listed
    assert ("material", 'material "grey"') in listed
    extra = ARM.replace('<link name="tool centre point"/>', '<link name="tool centre point" hue="1"><bulb/></link>')
    extra = extra.replace(
        '<child link="forearm"/>', '<child link="forearm"/><mimic joint="lift"/><safety_controller k_velocity="1"/>'
    )
    more = {(item.element, item.place.removeprefix("a: ")) for item in read_urdf(extra, "a").left_out}
    assert more - listed == {
        ("link: hue", 'link "tool centre point"'),
        ("bulb", 'link "tool centre point"'),
        ("mimic", 'joint "elbow"'),
        ("safety_controller", 'joint "elbow"'),
    }


def test_limits_become_soft_stops_where_asked():
    stops = Stops(*map(Fraction, (100, 1, 2000, 5)))
    read = read_urdf(ARM, "a", ImportOptions(stops=stops))
    lift, twist = read.scene.joints[1], read.scene.joints[5]
    assert lift.coordinates[0].limit == Limit(Fraction("-1.9"), Fraction("2.1"), Fraction(100), Fraction(1))
    assert twist.coordinates[0].limit is None
    assert not [item for item in read.left_out if item.element == "limit: lower, upper"]


def test_floating_and_planar_joints_leave_what_they_say():
    text = robot(
        '<link name="world"/>',
        *map(LINK.format, "abc"),
        HINGE.format("f", "floating", "world", "a", '<origin xyz="1 2 3"/>'),
        HINGE.format("p", "planar", "a", "b", '<axis xyz="0 0 2"/><dynamics damping="1"/>'),
        HINGE.format("s", "prismatic", "b", "c", '<dynamics damping="0.5"/>'),
    )
    read = read_urdf(text, "r")
    assert [(joint.name, joint.type, joint.bodies) for joint in read.scene.joints] == [
        ("p", "planar", ("a", "b")),
        ("s", "translational", ("b", "c")),
    ]
    assert len(read.scene.joints[0].coordinates) == 3
    assert read.scene.joints[1].coordinates[0].damping == Fraction("0.5")
    assert read.scene.body("a").position == (1, 2, 3)
    assert [item.element for item in read.left_out] == ["dynamics: damping"]


def test_a_free_base_is_a_body_without_joint():
    text = robot(*map(LINK.format, "ab"), HINGE.format("h", "continuous", "a", "b", ""))
    scene = read_urdf(text, "r", ImportOptions(free_base=True)).scene
    assert [body.name for body in scene.bodies] == ["a", "b"]
    assert [joint.bodies for joint in scene.joints] == [("a", "b")]


def test_a_rounded_right_angle_is_one_only_where_asked():
    text = ARM.replace('rpy="0 1.5707963267948966 0"', 'rpy="0 1.5708 0"')
    exact = read_urdf(text, "r", ImportOptions(right_angle=Fraction(1, 10**5))).scene
    assert exact == read_urdf(ARM, "r").scene
    model, data = loaded(theirs(text))
    same_at_start(read_urdf(text, "r").scene, model, data)
