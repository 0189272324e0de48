"""Whether a mechanism that is to be reduced to the plane moves in one: which joint or body forbids it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from codegen.errors import Mistake
from codegen.spec.placement import cross, times
from codegen.spec.scene import Body, Joint, Vector
from codegen.spec.scene_file.axes import is_parallel, is_perpendicular
from codegen.spec.scene_file.bodies import Pose
from codegen.spec.scene_file.text import quoted

_SPATIAL = ("screw", "cylindrical", "universal", "ball")
_NORMAL = ("revolute", "planar")
_REMEDY = 'correct it, or leave motion = "planar" out'


@dataclass(frozen=True, slots=True)
class Placed:
    """A joint, its place in mistakes and its axis h, world."""

    joint: Joint
    place: str
    axis: Vector


def placed(joint: Joint, poses: tuple[Pose, Pose], place: str) -> Placed:
    """A joint with its axis in the pose at t = 0."""
    h: Vector = tuple(row[2] for row in joint.marker_i.axes)  # type: ignore[assignment]
    return Placed(joint, place, times(poses[0].attitude, h))


def planar_mistakes(joints: Sequence[Placed]) -> Iterator[Mistake]:
    """Report the joints that leave the plane: axes that are not its normal, and types that turn or move out of it."""
    for item in joints:
        if item.joint.type in _SPATIAL:
            what = f"a {item.joint.type} joint is not planar"
            yield Mistake(f"{item.place}: type", what, _REMEDY)
    normal = plane_normal(joints)
    for item in joints:
        if normal is None:
            return
        if item.joint.type in _NORMAL and not is_parallel(item.axis, normal[0]):
            what = f"its axis is not parallel to that of {normal[1]}, so the motion is not planar"
            yield Mistake(item.place, what, _REMEDY)
        elif item.joint.type == "translational" and not is_perpendicular(item.axis, normal[0]):
            what = f"it does not move perpendicularly to the axis of {normal[1]}, so the motion is not planar"
            yield Mistake(item.place, what, _REMEDY)


def out_of_plane_mistakes(bodies: Sequence[tuple[Body, Pose, str]], joints: Sequence[Placed]) -> Iterator[Mistake]:
    """Report the bodies that leave the plane by their velocities at t = 0."""
    normal = plane_normal(joints)
    if normal is None:
        return
    for body, pose, place in bodies:
        if not is_perpendicular(body.velocity, normal[0]):
            yield Mistake(f"{place}: velocity", f"leaves the plane across the axis of {normal[1]}", _REMEDY)
        if not is_parallel(times(pose.attitude, body.angular_velocity), normal[0]):
            yield Mistake(f"{place}: angular_velocity", f"is not along the axis of {normal[1]}", _REMEDY)


def plane_normal(joints: Sequence[Placed]) -> tuple[Vector, str] | None:
    """Normal of the plane of motion, world, and the joint that tells it; None if none does.

    It is the axis of the first revolute or planar joint, else perpendicular to two directions of sliding.
    """
    first = next((item for item in joints if item.joint.type in _NORMAL), None)
    if first is not None:
        return first.axis, f"joint {quoted(first.joint.name)}"
    slides = [item for item in joints if item.joint.type == "translational"]
    for item in slides[1:]:
        if not is_parallel(slides[0].axis, item.axis):
            names = f"the plane of joints {quoted(slides[0].joint.name)} and {quoted(item.joint.name)}"
            return cross(slides[0].axis, item.axis), names
    return None
