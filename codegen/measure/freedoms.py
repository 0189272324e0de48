"""What a joint holds and what it lets go, as forces, torques and twists in its frame: independent of form and rows.

On the manifold the rows of a joint span the forces and torques that it can carry. A freer joint carries fewer; this is
how a replacement is judged.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from codegen.measure.constraints import Array, JointConstraint, Pose

_F, _T = ("Ff", "Fg", "Fh"), ("Tf", "Tg", "Th")

CARRIED: dict[str, tuple[str, ...]] = {
    "revolute": (*_F, "Tf", "Tg"),
    "translational": ("Ff", "Fg", *_T),
    "screw": ("Ff", "Fg", "Tf", "Tg", "S"),
    "cylindrical": ("Ff", "Fg", "Tf", "Tg"),
    "universal": (*_F, "X"),
    "planar": ("Fh", "Tf", "Tg"),
    "ball": _F,
    "rigid": (*_F, *_T),
}
"""What each joint carries: forces F and torques T along f, g, h; a screw the force S along h with its torque, a
universal joint the torque X across its axes."""

FREE: dict[str, tuple[str, ...]] = {
    "revolute": ("Th",),
    "translational": ("Fh",),
    "screw": ("S",),
    "cylindrical": ("Fh", "Th"),
    "universal": ("Th", "Xf"),
    "planar": ("Ff", "Fg", "Th"),
    "ball": _T,
    "rigid": (),
}
"""Motions that each joint leaves: along (F) and about (T) its axes; Xf about f of body j, S a screw about h."""


@dataclass(frozen=True, slots=True)
class FreerJoint:
    """A freer joint that may take the place of another.

    Attributes:
        type: of the freer joint.
        note: how it stands, where the type does not say it.
        released: what it no longer carries, out of `CARRIED` of the joint it replaces.
    """

    type: str
    note: str
    released: tuple[str, ...]


FREER: dict[str, tuple[FreerJoint, ...]] = {
    "revolute": (
        FreerJoint("cylindrical", "", ("Fh",)),
        FreerJoint("ball", "", ("Tf", "Tg")),
        FreerJoint("universal", "second axis along f", ("Tf",)),
        FreerJoint("universal", "second axis along g", ("Tg",)),
        FreerJoint("planar", "", ("Ff", "Fg")),
    ),
    "translational": (
        FreerJoint("cylindrical", "", ("Th",)),
        FreerJoint("planar", "normal along f", ("Fg", "Tf")),
        FreerJoint("planar", "normal along g", ("Ff", "Tg")),
    ),
    "screw": (FreerJoint("cylindrical", "", ("S",)),),
    "universal": (FreerJoint("ball", "", ("X",)),),
    "rigid": (
        FreerJoint("ball", "", _T),
        *(
            freer
            for axis, f, g in (("h", "f", "g"), ("f", "g", "h"), ("g", "h", "f"))
            for freer in (
                FreerJoint("revolute", f"axis along {axis}", (f"T{axis}",)),
                FreerJoint("translational", f"axis along {axis}", (f"F{axis}",)),
                FreerJoint("cylindrical", f"axis along {axis}", (f"F{axis}", f"T{axis}")),
                FreerJoint("universal", f"axes along {f} and {g}", (f"T{f}", f"T{g}")),
                FreerJoint("planar", f"normal along {axis}", (f"F{f}", f"F{g}", f"T{axis}")),
            )
        ),
    ),
}
"""Joints of the catalogue that allow everything that a joint allows, and more."""


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """A joint in a pose: its point [3] m and axes, world; f of body j; pitch, m/rad."""

    point: Array
    axes: dict[str, Array]
    second: Array
    pitch: float


def placed(joint: JointConstraint, pose: Pose) -> Placed:
    """Find where a joint stands; its point and axes are those of body i."""
    i, j = joint.bodies
    (r, A), (_, A_j) = pose.body(i), pose.body(j)
    own, other = joint.frames
    axes = dict(zip("fgh", (A @ own.C).T, strict=True))
    pitch = joint.parameters[0] if joint.type == "screw" else 0.0
    return Placed(r + A @ own.s, axes, A_j @ other.C[:, 0], pitch)


def carried_rows(joint: JointConstraint, pose: Pose, labels: Sequence[str], length: float) -> Array:
    """Give rows for what a joint carries, [k, 12] in the columns of a joint's ``phi_q``, without dimension.

    Args:
        joint: the joint.
        pose: consistent.
        labels: out of `CARRIED`.
        length: unit of length, m.
    """
    here = placed(joint, pose)
    bodies = [pose.body(body) for body in joint.bodies]
    rows = [_carried(label, here, bodies, length) for label in labels]
    return np.array(rows).reshape(-1, 12)


def _carried(label: str, here: Placed, bodies: Sequence[tuple[Array, Array]], length: float) -> Array:
    if label == "S":
        turn = here.pitch / length * _carried("Th", here, bodies, length)
        return _carried("Fh", here, bodies, length) - turn
    if label == "X":
        across = np.cross(here.axes["h"], here.second)
        force, torque = np.zeros(3), across / np.linalg.norm(across)
    elif label[0] == "F":
        force, torque = here.axes[label[1]], np.zeros(3)
    else:
        force, torque = np.zeros(3), here.axes[label[1]]
    parts = [(force, A.T @ (np.cross(here.point - r, force) / length + torque)) for r, A in bodies]
    (move_i, turn_i), (move_j, turn_j) = parts
    return np.concatenate([-move_i, -turn_i, move_j, turn_j])


def twists(joint: JointConstraint, pose: Pose, origin: Array, length: float) -> Array:
    """Give the twists that a joint allows, [dof, 6]: angular, then linear at the origin, world, without dimension."""
    here = placed(joint, pose)
    arm = (here.point - origin) / length
    found = []
    for label in FREE[joint.type]:
        axis = here.second if label == "Xf" else here.axes[label[1] if len(label) > 1 else "h"]
        if label[0] == "F":
            found.append(np.concatenate([np.zeros(3), axis]))
        else:
            along = here.pitch / length * axis if label == "S" else np.zeros(3)
            found.append(np.concatenate([axis, np.cross(arm, axis) + along]))
    return np.array(found).reshape(-1, 6)
