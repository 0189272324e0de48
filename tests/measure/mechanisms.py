"""Mechanisms as numeric constraint systems: the library's generic routines on joints that stand at world points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import numpy as np

from codegen import models
from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.measure.constraints import Array, ConstraintSystem, Evaluate, Frame, JointConstraint, Pose
from codegen.measure.row_names import conventional_rows, coordinate_units, parametric_rows
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import Variant

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
Point = Sequence[float]
Mechanism = tuple[ConstraintSystem, Pose]


@dataclass(frozen=True)
class At:
    """A joint in the world: type, bodies (None: ground), point [3] m, axis h, and f where it matters.

    It is drawn open where its point on body j, ``point_j``, is another.
    """

    name: str
    type: str
    bodies: tuple[str | None, str | None]
    point: Point
    axis: Point = Z
    second: Point | None = None
    pitch: float = 0.0
    point_j: Point | None = None


@dataclass
class Drawing:
    """Bodies with their poses, and joints."""

    bodies: dict[str, tuple[Array, Array]] = field(default_factory=dict)
    joints: list[At] = field(default_factory=list)

    def bar(self, name: str, start: Point, end: Point) -> None:
        """A body with its reference point midway and its x axis from start to end (in the plane z = const)."""
        a, b = np.array(start, float), np.array(end, float)
        self.bodies[name] = (a + b) / 2, about_z(np.arctan2(b[1] - a[1], b[0] - a[0]))

    def body(self, name: str, position: Point, attitude: Any = None) -> None:
        """A body in a pose."""
        self.bodies[name] = np.array(position, float), np.eye(3) if attitude is None else attitude

    def joint(self, *arguments: Any, **options: Any) -> None:
        """A joint, see `At`."""
        self.joints.append(At(*arguments, **options))

    def mechanism(self, form: str = "conventional", rows: str = "regular") -> Mechanism:
        """The drawing as a system, in the pose drawn, all joint coordinates 0."""
        names = list(self.bodies)
        joints = tuple(self._constraint(joint, names, form, rows) for joint in self.joints)
        system = ConstraintSystem(tuple(names), joints)
        count = sum(len(joint.coordinates) for joint in joints)
        r = np.array([self.bodies[name][0] for name in names]).reshape(-1, 3)
        A = np.array([self.bodies[name][1] for name in names]).reshape(-1, 3, 3)
        return system, Pose(r, A, np.zeros(count))

    def _constraint(self, joint: At, names: list[str], form: str, rows: str) -> JointConstraint:
        kind = JOINTS[joint.type]
        axes = world_axes(joint)
        poses = [(np.zeros(3), np.eye(3)) if name is None else self.bodies[name] for name in joint.bodies]
        points = (joint.point, joint.point if joint.point_j is None else joint.point_j)
        frames = [
            Frame(A.T @ (np.array(point, float) - r), A.T @ axes) for point, (r, A) in zip(points, poses, strict=True)
        ]
        i, j = (None if name is None else names.index(name) for name in joint.bodies)
        is_conventional = form == "conventional"
        return JointConstraint(
            joint.name,
            joint.type,
            (i, j),
            conventional_rows(kind) if is_conventional else parametric_rows(kind, rows),
            () if is_conventional else coordinate_units(kind, rows),
            (frames[0], frames[1]),
            routine(joint.type, form, rows, geometry(joint, frames, form)),
            (joint.pitch,),
        )


def about_z(angle: float) -> Array:
    """Rotation about z."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])


def world_axes(joint: At) -> Array:
    """[f g h] of a joint, world."""
    h = np.array(joint.axis, float) / np.linalg.norm(joint.axis)
    if joint.second is None:
        least = np.eye(3)[int(np.argmin(np.abs(h)))]
        f = least - (least @ h) * h
    else:
        f = np.array(joint.second, float)
    f = f / np.linalg.norm(f)
    return np.column_stack([f, np.cross(h, f), h])


def geometry(joint: At, frames: Sequence[Frame], form: str) -> list[float]:
    """The argument ``geometry``; a conventional universal joint has its second axis as h_j."""
    own, other = frames
    C_j = other.C[:, [1, 2, 0]] if joint.type == "universal" and form == "conventional" else other.C
    values = np.concatenate([own.s, own.C.ravel(order="F"), other.s, C_j.ravel(order="F")]).tolist()
    return [*values, joint.pitch, 0.0, 0.0] if joint.type == "screw" else list(values)


@cache
def program(kind: str, form: str, rows: str) -> Program:
    """The generic routine of a joint, ``phi`` and ``phi_q``."""
    variant = Variant(kind, form, None if form == "conventional" else rows)
    return models.model(variant).program(("phi", "phi_q"))


def routine(kind: str, form: str, rows: str, constants: list[float]) -> Evaluate:
    """A joint routine; translations of the parametric form are turned from body axes to the world's."""
    generic = program(kind, form, rows)

    def evaluated(r_i: Array, A_i: Array, r_j: Array, A_j: Array, alpha: Array) -> tuple[Array, Array]:
        arrays = {"r_i": r_i, "A_i": A_i.ravel(order="F"), "r_j": r_j, "A_j": A_j.ravel(order="F"), "alpha": alpha}
        inputs = {name: array.tolist() for name, array in arrays.items()} | {"geometry": constants}
        values = evaluate(generic, inputs)
        phi_q = dense(generic, values["phi_q"])
        if form == "parametric":
            phi_q[:, :3] = phi_q[:, :3] @ A_i.T
            phi_q[:, 6:9] = phi_q[:, 6:9] @ A_j.T
        return np.array(values["phi"]), phi_q

    return evaluated


def dense(generic: Program, values: Sequence[Any], zero: Any = 0.0) -> Any:
    """``phi_q`` as a dense matrix."""
    sparsity = generic.output("phi_q").sparsity
    matrix = np.full((sparsity.nrow, sparsity.ncol), zero)
    for (row, column), value in zip(sparsity.entries(), values, strict=True):
        matrix[row, column] = value
    return matrix


def slider_crank(
    crank: float = 0.3, rod: float = 0.5, angle: float = 0.7, unit: float = 1.0, copies: int = 1
) -> Drawing:
    """In-line slider-cranks beside each other along z: three revolute joints along z and one translational along x."""
    drawing = Drawing()
    for copy in range(copies):
        name = "" if copies == 1 else f" {copy + 1}"
        z = 0.25 * copy * unit
        pin = np.array([crank * np.cos(angle) * unit, crank * np.sin(angle) * unit, z])
        along = np.sqrt(rod**2 - (crank * np.sin(angle)) ** 2) * unit
        piston = np.array([pin[0] + along, 0.0, z])
        drawing.bar(f"crank{name}", (0, 0, z), pin)
        drawing.bar(f"rod{name}", pin, piston)
        drawing.body(f"piston{name}", piston)
        drawing.joint(f"main{name}", "revolute", (None, f"crank{name}"), (0, 0, z))
        drawing.joint(f"crank pin{name}", "revolute", (f"crank{name}", f"rod{name}"), pin)
        drawing.joint(f"piston pin{name}", "revolute", (f"rod{name}", f"piston{name}"), piston)
        drawing.joint(f"cylinder{name}", "translational", (None, f"piston{name}"), piston, X)
    return drawing


def polygon(points: dict[str, Point], bars: dict[str, tuple[str, str]]) -> Drawing:
    """Bars pinned about z: a point that starts with ``O`` is on the ground; others join the bars that meet there."""
    drawing = Drawing()
    for name, (start, end) in bars.items():
        drawing.bar(name, points[start], points[end])
    for point, place in points.items():
        meeting: list[str | None] = [name for name, ends in bars.items() if point in ends]
        first = None if point.startswith("O") else meeting.pop(0)
        for other in meeting:
            name = point if len(meeting) == 1 else f"{point} {other}"
            drawing.joint(name, "revolute", (first, other), place)
    return drawing


def four_bar() -> Drawing:
    """A general plane four-bar linkage."""
    return polygon(
        {"O1": (0, 0, 0), "A": (0.1, 0.25, 0), "B": (0.62, 0.4, 0), "O2": (0.7, 0, 0)},
        {"crank": ("O1", "A"), "coupler": ("A", "B"), "rocker": ("B", "O2")},
    )


def parallelogram_with_a_third_crank() -> Drawing:
    """Three equal parallel cranks on one coupler: Haug's double parallelogram."""
    drawing = Drawing()
    top = np.array([0.2, 0.5, 0.0])
    drawing.bar("coupler", top, top + np.array([2.0, 0.0, 0.0]))
    for k in range(3):
        foot = np.array([float(k), 0.0, 0.0])
        drawing.bar(f"crank {k}", foot, foot + top)
        drawing.joint(f"foot {k}", "revolute", (None, f"crank {k}"), foot)
        drawing.joint(f"top {k}", "revolute", (f"crank {k}", "coupler"), foot + top)
    return drawing


def bricard(edge: float = 1.0) -> Drawing:
    """Bricard's orthogonal six-bar: links along six edges of a cube, hinges across two edges each."""
    corners = edge * np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1], [0, 0, 1]], float)
    axes = (Y, Z, X, Y, Z, X)
    drawing = Drawing()
    for k in range(1, 6):
        drawing.body(f"link {k}", (corners[k] + corners[(k + 1) % 6]) / 2, about_z(0.3 * k))
    names = [None, *(f"link {k}" for k in range(1, 6))]
    for k in range(6):
        drawing.joint(f"hinge {k}", "revolute", (names[k - 1], names[k]), corners[k], axes[k])
    return drawing


SHORT, LONG = (0.3, np.radians(30.0)), (0.3 * np.sin(np.radians(80.0)) / np.sin(np.radians(30.0)), np.radians(80.0))
"""Length (m) and twist (rad) of the links of Bennett's linkage; sine of the twist over length is the same for both."""


def bennett_axes(angle: float) -> Array:
    """Frames [4, 4, 4] of the hinges of Bennett's linkage, z along each, x along the link behind it.

    Its closed form: tan(theta_1 / 2) tan(theta_2 / 2) = sin((b + a) / 2) / sin((b - a) / 2), theta_3 = -theta_1,
    theta_4 = -theta_2 (rad), with the twists a and b.

    Args:
        angle: theta_1, rad, not 0.
    """
    a, b = SHORT[1], LONG[1]
    other = 2 * np.arctan2(np.sin((b + a) / 2) * np.cos(angle / 2), np.sin((b - a) / 2) * np.sin(angle / 2))
    frames = [np.eye(4)]
    for theta, (length, twist) in zip((angle, other, -angle), (SHORT, LONG, SHORT), strict=True):
        along = np.eye(4)
        c, s = np.cos(twist), np.sin(twist)
        along[:3, :] = [[1, 0, 0, length], [0, c, -s, 0], [0, s, c, 0]]
        about = np.eye(4)
        about[:3, :3] = about_z(theta)
        frames.append(frames[-1] @ about @ along)
    return np.array(frames)


def bennett_bodies(angle: float) -> dict[str, tuple[Array, Array]]:
    """Poses of the three moving links: midway between two hinges, z along the first of them."""
    frames, found = bennett_axes(angle), {}
    for k in range(3):
        x = frames[k + 1, :3, 3] - frames[k, :3, 3]
        x, z = x / np.linalg.norm(x), frames[k, :3, 2]
        found[f"link {k + 1}"] = (frames[k, :3, 3] + frames[k + 1, :3, 3]) / 2, np.column_stack([x, np.cross(z, x), z])
    return found


def bennett(angle: float) -> Drawing:
    """Bennett's linkage: four hinges on skew axes, three rows of which are redundant by its dimensions."""
    drawing = Drawing(bennett_bodies(angle))
    names = [None, "link 1", "link 2", "link 3", None]
    for k, frame in enumerate(bennett_axes(angle)):
        drawing.joint(f"hinge {k + 1}", "revolute", (names[k], names[k + 1]), frame[:3, 3], frame[:3, 2])
    return drawing


def spatial_slider_crank(at_slider: str = "universal") -> Drawing:
    """Haug's spatial slider-crank: revolute, ball, universal (or ball) and translational joint, from the crank on."""
    pin, slider = np.array([0.0, 0.1, 0.2]), np.array([0.2, 0.0, 0.0])
    drawing = Drawing()
    drawing.body("crank", (0.0, 0.1, 0.16))
    drawing.body("rod", (pin + slider) / 2, about_z(0.4))
    drawing.body("slider", slider)
    across = np.cross(slider - pin, X)
    drawing.joint("bearing", "revolute", (None, "crank"), (0.0, 0.1, 0.12), X)
    drawing.joint("pin", "ball", ("crank", "rod"), pin)
    drawing.joint("knuckle", at_slider, ("rod", "slider"), slider, across, second=X)
    drawing.joint("guide", "translational", (None, "slider"), slider, X)
    return drawing


def pendulum() -> Drawing:
    """A bar on a pin."""
    return polygon({"O": (0, 0, 0), "end": (0.6, -0.8, 0)}, {"bar": ("O", "end")})


def triangle() -> Drawing:
    """Two bars and the ground pinned to a triangle."""
    points = {"O1": (0, 0, 0), "A": (0.3, 0.5, 0), "O2": (1, 0, 0)}
    return polygon(points, {"left": ("O1", "A"), "right": ("A", "O2")})


def two_bars_in_line() -> Drawing:
    """The triangle without height: its middle moves infinitesimally, and no further."""
    points = {"O1": (0, 0, 0), "A": (0.4, 0, 0), "O2": (1, 0, 0)}
    return polygon(points, {"left": ("O1", "A"), "right": ("A", "O2")})


def bars_that_are_too_short() -> Drawing:
    """Two bars of 0.3 m between pins that are 1 m apart: 0.4 m are missing."""
    points = {"O1": (0, 0, 0), "A": (0.3, 0, 0)}
    drawing = polygon(points | {"end": (0.6, 0, 0)}, {"left": ("O1", "A"), "right": ("A", "end")})
    drawing.joint("O2", "revolute", ("right", None), (0.6, 0, 0), point_j=(1, 0, 0))
    return drawing


def shaky_arm() -> Drawing:
    """A pendulum that carries two bars in line between two of its points."""
    drawing = Drawing()
    drawing.bar("arm", (0, 0, 0), (1, 0, 0))
    drawing.bar("left", (0.2, 0, 0), (0.5, 0, 0))
    drawing.bar("right", (0.5, 0, 0), (0.9, 0, 0))
    drawing.joint("O", "revolute", (None, "arm"), (0, 0, 0))
    drawing.joint("A", "revolute", ("arm", "left"), (0.2, 0, 0))
    drawing.joint("B", "revolute", ("left", "right"), (0.5, 0, 0))
    drawing.joint("C", "revolute", ("right", "arm"), (0.9, 0, 0))
    return drawing
