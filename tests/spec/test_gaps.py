"""A joint that is given in body axes closes for some value of its coordinates, or its gap is told in mm and degrees.

The second body is moved by a known motion from the pose in which the joint frames coincide: along the freedom of the
joint, which closes, and against it, which opens the joint by just that much.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from .mobility import turned
from .texts import joined, refused, scene

S_I, S_J = np.array([0.3, -0.2, 0.1]), np.array([-0.1, 0.4, 0.25])
Z, X = "[0, 0, 1]", "[1, 0, 0]"
LINES = {
    "revolute": f"axes = [{Z}, {Z}]",
    "translational": f"axes = [{Z}, {Z}]",
    "screw": f"axes = [{Z}, {Z}]\npitch = 0.01",
    "cylindrical": f"axes = [{Z}, {Z}]",
    "universal": f"axes = [{Z}, {X}]",
    "planar": f"axes = [{Z}, {Z}]",
    "ball": "",
    "rigid": "",
}

# type, translations of joint frame j in joint frame i (m), rotations one after the other (axis, degrees).
CLOSED = [
    ("revolute", (0, 0, 0), [("z", 123)]),
    ("translational", (0, 0, -0.7), []),
    ("screw", (0, 0, 0.01 * math.radians(50)), [("z", 50)]),
    ("screw", (0, 0, 0.01 * (math.radians(50) - 6 * math.pi)), [("z", 50)]),
    ("cylindrical", (0, 0, 0.3), [("z", -170)]),
    ("universal", (0, 0, 0), [("z", 40), ("x", 110)]),
    ("planar", (0.2, -0.4, 0), [("z", 77)]),
    ("ball", (0, 0, 0), [("z", 40), ("y", 50), ("x", 60)]),
    ("rigid", (0, 0, 0), []),
]
OPEN = [
    ("revolute", (0, 0, 0.002), [("z", 123)], "2 mm apart"),
    ("revolute", (0.003, 0.004, 0), [("z", 10), ("y", 0.5)], "5 mm apart and 0.5 degrees out of line"),
    ("revolute", (0, 0, 0), [("x", 180)], "180 degrees out of line"),
    ("translational", (0.001, 0, 0.5), [], "1 mm apart"),
    ("translational", (0, 0, 0.5), [("z", 2)], "2 degrees out of line"),
    ("screw", (0, 0, 0.01 * math.radians(50) + 0.001), [("z", 50)], "1 mm apart"),
    ("screw", (0, 0.0005, 0), [("y", 1)], "0.5 mm apart and 1 degrees out of line"),
    ("cylindrical", (0.002, 0, 0.3), [("z", -170)], "2 mm apart"),
    ("universal", (0, 0, 0), [("z", 40), ("y", 3)], "3 degrees out of line"),
    ("universal", (0, 0.01, 0), [("z", 40)], "10 mm apart"),
    ("planar", (0.2, -0.4, 0.002), [("z", 77)], "2 mm apart"),
    ("planar", (0, 0, 0), [("x", 0.25)], "0.25 degrees out of line"),
    ("ball", (0, 0, 0.001), [("y", 50)], "1 mm apart"),
    ("rigid", (0, 0, 0), [("z", 1)], "1 degrees out of line"),
    ("rigid", (0, 0, 2e-6), [], "0.002 mm apart"),
]


def text(type_: str, translation: tuple[float, ...], rotations: list[tuple[str, float]], more: str = "") -> str:
    """Two bodies with the joint in body axes; the second is where the motion takes it."""
    attitude, quaternion = np.eye(3), np.array([1.0, 0.0, 0.0, 0.0])
    for name, angle in rotations:
        axis = np.eye(3)["xyz".index(name)]
        attitude = attitude @ turned(math.radians(angle) * axis)
        half = math.radians(angle) / 2
        w, v, c, s = quaternion[0], quaternion[1:], math.cos(half), math.sin(half) * axis
        quaternion = np.array([w * c - v @ s, *(w * s + c * v + np.cross(v, s))])
    position = S_I + np.array(translation) - attitude @ S_J
    bodies = f"""name = "bars"
[[body]]
name = "a"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[body]]
name = "b"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = {position.tolist()}
quaternion = {quaternion.tolist()}
"""
    points = f"points = [{S_I.tolist()}, {S_J.tolist()}]"
    return joined(f'type = "{type_}"\n{points}\n{LINES[type_]}\n{more}', bodies)


@pytest.mark.parametrize(("type_", "translation", "rotations"), CLOSED)
def test_a_joint_that_is_moved_along_its_freedom_closes(type_, translation, rotations) -> None:
    assert scene(text(type_, translation, rotations)).joints[0].type == type_


@pytest.mark.parametrize(("type_", "translation", "rotations", "gap"), OPEN)
def test_a_joint_that_is_moved_against_its_freedom_is_open_by_just_that(type_, translation, rotations, gap) -> None:
    (line,) = refused(text(type_, translation, rotations))
    assert line.startswith(f'scene.toml: joint "pin": does not close at t = 0: it is {gap}; correct its points')
    assert line.endswith("accept gaps with assemble = true")


@pytest.mark.parametrize(("type_", "translation", "rotations", "gap"), OPEN)
def test_gaps_are_accepted_on_request(type_, translation, rotations, gap) -> None:
    accepted = scene(text(type_, translation, rotations).replace('name = "bars"', 'name = "bars"\nassemble = true'))
    assert accepted.assemble


DRIVEN = [
    ("revolute", (0, 0, 0), [("z", 30)], [math.radians(30)]),
    ("translational", (0, 0, 0.125), [], [0.125]),
    ("screw", (0, 0, 0.01 * (math.radians(50) + 2 * math.pi)), [("z", 50)], [math.radians(50) + 2 * math.pi]),
    ("cylindrical", (0, 0, 0.3), [("z", 20)], [0.3, math.radians(20)]),
    ("universal", (0, 0, 0), [("z", 40), ("x", 110)], [math.radians(40), math.radians(110)]),
    ("planar", (0.2, -0.4, 0), [("z", 77)], [0.2, -0.4, math.radians(77)]),
    ("ball", (0, 0, 0), [("z", 40), ("y", 50), ("x", 60)],
     [math.radians(40), math.radians(50), math.radians(60)]),
]  # fmt: skip


@pytest.mark.parametrize(("type_", "translation", "rotations", "values"), DRIVEN)
def test_a_drive_starts_where_the_pose_has_the_coordinate(type_, translation, rotations, values) -> None:
    def driven(numbers: list[float]) -> str:
        drives = ", ".join(f"{{ position = {number}, speed = 1.0 }}" for number in numbers)
        return text(type_, translation, rotations, f"drive = [{drives}]")

    assert scene(driven(values)).joints[0].needs_coordinates
    for k in range(len(values)):
        shifted = [value + (0.001 if m == k else 0) for m, value in enumerate(values)]
        (line,) = refused(driven(shifted))
        assert line.startswith('scene.toml: joint "pin": drive: does not close at t = 0: position is ')
        assert "1 mm apart" in line or f"{math.degrees(0.001):.6g} degrees apart" in line


def test_a_joint_in_world_axes_has_coordinates_0_at_the_start() -> None:
    more = 'type = "translational"\npoint = [0, 0, 0]\naxis = [1, 0, 0]\ndrive = { position = 0.002, speed = 1 }'
    (line,) = refused(joined(more))
    assert "position is 0.002 m, the pose has 0 m, 2 mm apart" in line
