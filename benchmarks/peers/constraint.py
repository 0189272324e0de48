"""The constraint of a joint over the scalars of any tool, and its poses with virtual displacements.

Arguments are flat, as the routines take them: ``r_i[3] A_i[9] r_j[3] A_j[9] geometry[24, screw 27] lambda[rows]``,
matrices column-major. Rows stand in the order of docs/conventions.md.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from benchmarks.peers.linear import (
    Matrix,
    Scalar,
    Vector,
    apply,
    dot,
    identity,
    multiply,
    opposite,
    plus,
    product,
    sum_of,
    tilde,
)

ROWS: Mapping[str, tuple[str, ...]] = {
    "revolute": ("d", "f.h", "g.h"),
    "translational": ("f.h", "g.h", "f.g", "f.d", "g.d"),
    "screw": ("f.d", "g.d", "f.h", "g.h", "screw"),
    "cylindrical": ("f.d", "g.d", "f.h", "g.h"),
    "universal": ("d", "h.h"),
    "planar": ("f.h", "g.h", "h.d"),
    "ball": ("d",),
}
"""``d``: d_ij = 0; ``f.h``: f_i . h_j = 0; ``f.d``: f_i . d_ij = 0."""

JOINTS = tuple(ROWS)
PI = 3.141592653589793

Atan2 = Callable[[Scalar, Scalar], Scalar]


def row_count(joint: str) -> int:
    """Rows of the constraint."""
    return sum(3 if row == "d" else 1 for row in ROWS[joint])


def argument_lengths(joint: str) -> dict[str, int]:
    """Names and lengths of the arguments, in the order of the routines."""
    geometry = 27 if joint == "screw" else 24
    return {"r_i": 3, "A_i": 9, "r_j": 3, "A_j": 9, "geometry": geometry, "lambda": row_count(joint)}


def matrix(flat: Sequence[Scalar]) -> Matrix:
    """Matrix 3 x 3 from its columns."""
    return [[flat[3 * column + row] for column in range(3)] for row in range(3)]


@dataclass(frozen=True, slots=True)
class Pose:
    """Positions [3] (m, world) and rotations [3 x 3] (body to world) of both bodies."""

    r_i: Vector
    A_i: Matrix
    r_j: Vector
    A_j: Matrix

    def moved(self, delta: Sequence[Scalar]) -> Pose:
        """Apply (delta r_i, delta pi_i, delta r_j, delta pi_j) [12]: delta r in world axes, delta pi in body axes."""
        return Pose(
            sum_of([self.r_i, list(delta[0:3])]),
            product(self.A_i, plus(identity(), tilde(list(delta[3:6])))),
            sum_of([self.r_j, list(delta[6:9])]),
            product(self.A_j, plus(identity(), tilde(list(delta[9:12])))),
        )


@dataclass(frozen=True, slots=True)
class Geometry:
    """Attachment points s [3] (m) and axes f, g, h [3] of both joint frames, body axes; the screw's parameters."""

    s_i: Vector
    axes_i: Mapping[str, Vector]
    s_j: Vector
    axes_j: Mapping[str, Vector]
    parameters: Vector


def geometry_of(flat: Sequence[Scalar]) -> Geometry:
    """Unpack the argument ``geometry``."""
    frames = [{axis: list(flat[o + 3 * k : o + 3 * k + 3]) for k, axis in enumerate("fgh")} for o in (3, 15)]
    return Geometry(list(flat[0:3]), frames[0], list(flat[12:15]), frames[1], list(flat[24:27]))


def phi(joint: str, pose: Pose, geometry: Geometry, atan2: Atan2) -> Vector:
    """The constraint [rows]."""
    world_i = {axis: apply(pose.A_i, vector) for axis, vector in geometry.axes_i.items()}
    world_j = {axis: apply(pose.A_j, vector) for axis, vector in geometry.axes_j.items()}
    d_ij = sum_of(
        [pose.r_j, apply(pose.A_j, geometry.s_j), opposite(pose.r_i), opposite(apply(pose.A_i, geometry.s_i))]
    )
    values: Vector = []
    for row in ROWS[joint]:
        if row == "d":
            values += d_ij
        elif row == "screw":
            theta = atan2(dot(world_i["g"], world_j["f"]), dot(world_i["f"], world_j["f"]))
            values.append(dot(world_i["h"], d_ij) - advance(theta, geometry))
        else:
            axis_i, other = row.split(".")
            values.append(dot(world_i[axis_i], d_ij if other == "d" else world_j[other]))
    return values


def advance(theta: Scalar, geometry: Geometry) -> Scalar:
    """Advance of the screw: p (theta + 2 pi n + theta_0), m."""
    pitch, initial, revolutions = geometry.parameters
    return multiply(pitch, theta + 2 * PI * revolutions + initial)
