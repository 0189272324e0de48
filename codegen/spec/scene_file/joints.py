"""Joints of a scene file: their geometry is checked, their frames are laid, then a `Joint` is made.

The geometry is given once for both bodies, by world vectors in the pose at t = 0, or for each body by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from fractions import Fraction

from codegen.errors import Mistake
from codegen.spec.placement import (
    IDENTITY,
    columns,
    cross,
    frame,
    marker,
    on_axes,
    perpendicular,
    times,
    transposed,
    unit,
)
from codegen.spec.scene import GROUND, ZERO_VECTOR, Joint, Marker, Matrix, Vector
from codegen.spec.scene_file.axes import axis_mistakes, perpendicular_mistakes
from codegen.spec.scene_file.bodies import GROUND_POSE, Pose
from codegen.spec.scene_file.coordinates import coordinate_mistakes, make_coordinates
from codegen.spec.scene_file.entries import JointEntry
from codegen.spec.scene_file.names import pair_mistakes

_WITHOUT_AXIS = ("ball", "rigid")
"""Joint types that need no axis: h is the third axis of the first body, or of each body."""

_Z: Vector = (Fraction(0), Fraction(0), Fraction(1))


def joint_mistakes(entry: JointEntry, bodies: Mapping[str, Pose | None]) -> Iterator[Mistake]:
    """Check one joint but for the pose.

    Args:
        entry: the joint.
        bodies: poses of the bodies by name, None where a pose is wrong; without the ground.
    """
    if entry.bodies is not None:
        yield from pair_mistakes(entry.bodies, f"{entry.place}: bodies", bodies)
    yield from _geometry_mistakes(entry)
    if entry.type is not None:
        yield from _pitch_mistakes(entry)
        yield from coordinate_mistakes(entry)


def poses_of(entry: JointEntry, bodies: Mapping[str, Pose | None]) -> tuple[Pose, Pose] | None:
    """Poses of the two bodies of a joint; None if one of them is not known."""
    i, j = (GROUND_POSE if name == GROUND else bodies.get(name) for name in entry.bodies or ("", ""))
    return None if i is None or j is None else (i, j)


def make_joint(entry: JointEntry, poses: tuple[Pose, Pose]) -> Joint:
    """Make a joint of an entry without mistakes."""
    marker_i, marker_j = _world_markers(entry, poses) if entry.points is None else _body_markers(entry, entry.points)
    return Joint(
        entry.name or "",
        entry.type or "",
        entry.bodies or ("", ""),
        marker_i,
        marker_j,
        entry.pitch or Fraction(0),
        entry.form,
        make_coordinates(entry),
    )


def _world_markers(entry: JointEntry, poses: tuple[Pose, Pose]) -> tuple[Marker, Marker]:
    axes = _world_axes(entry.axis or times(poses[0].attitude, _Z), entry.axis2, poses)
    i, j = (marker(entry.point or ZERO_VECTOR, axes, pose.position, pose.attitude) for pose in poses)
    return i, j


def _world_axes(axis: Vector, axis2: Vector | None, poses: tuple[Pose, Pose]) -> Matrix:
    """``[f g h]``: h along the axis, f along the second axis or, where there is none, along an axis of a body."""
    if axis2 is None:
        return frame(axis, (*transposed(poses[0].attitude), *transposed(poses[1].attitude)))
    h = unit(axis)
    f = perpendicular(unit(axis2), h)
    return columns(f, cross(h, f), h)


def _body_markers(entry: JointEntry, points: tuple[Vector, Vector]) -> tuple[Marker, Marker]:
    h_i, second = entry.axes or (_Z, _Z)
    C_j = _frame_on(second) if entry.type == "universal" else frame(second)  # noqa: N806
    return Marker(on_axes(points[0]), frame(h_i)), Marker(on_axes(points[1]), C_j)


def _frame_on(first: Vector) -> Matrix:
    """``[f g h]`` with a given first axis; h is laid along the third axis of the body rather than the first."""
    x, y, z = IDENTITY
    h, _, f = transposed(frame(first, (z, x, y)))
    return columns(f, cross(h, f), h)


def _geometry_mistakes(entry: JointEntry) -> Iterator[Mistake]:
    world, body = {"point", "axis", "axis2"} & entry.given, {"points", "axes"} & entry.given
    if world and body:
        what = f"mixes {', '.join(sorted(world))} in world axes with {', '.join(sorted(body))} in body axes"
        yield Mistake(entry.place, what, "give point and axis, or points and axes")
    elif body:
        yield from _body_axes_mistakes(entry)
    else:
        yield from _world_axes_mistakes(entry)


def _world_axes_mistakes(entry: JointEntry) -> Iterator[Mistake]:
    if "point" not in entry.given:
        yield Mistake(f"{entry.place}: point", "is missing", "give its origin at t = 0 in m, world axes")
    if entry.type is not None and entry.type not in _WITHOUT_AXIS and "axis" not in entry.given:
        yield Mistake(f"{entry.place}: axis", "is missing", "give its direction at t = 0, world axes")
    if entry.axis is not None:
        yield from axis_mistakes(entry.axis, f"{entry.place}: axis")
    if entry.type is not None:
        yield from _second_axis_mistakes(entry, f"{entry.place}: axis2")


def _second_axis_mistakes(entry: JointEntry, place: str) -> Iterator[Mistake]:
    if entry.type != "universal":
        if "axis2" in entry.given:
            yield Mistake(place, f"a {entry.type} joint has one axis", "leave axis2 out")
    elif "axis2" not in entry.given:
        remedy = "give the axis that is fixed in the second body, world axes at t = 0, perpendicular to axis"
        yield Mistake(place, "is missing", remedy)
    elif entry.axis2 is not None:
        yield from axis_mistakes(entry.axis2, place)
        if entry.axis is not None and any(entry.axis) and any(entry.axis2):
            yield from perpendicular_mistakes(entry.axis, entry.axis2, place)


def _body_axes_mistakes(entry: JointEntry) -> Iterator[Mistake]:
    if "points" not in entry.given:
        remedy = "give its origin on both bodies in m, body axes from the centre of mass"
        yield Mistake(f"{entry.place}: points", "is missing", remedy)
    if entry.type is not None and entry.type not in _WITHOUT_AXIS and "axes" not in entry.given:
        yield Mistake(f"{entry.place}: axes", "is missing", "give its direction in the axes of both bodies")
    for k, axis in enumerate(entry.axes or (), 1):
        yield from axis_mistakes(axis, f"{entry.place}: axes: entry {k}")


def _pitch_mistakes(entry: JointEntry) -> Iterator[Mistake]:
    place = f"{entry.place}: pitch"
    if entry.type != "screw":
        if "pitch" in entry.given:
            yield Mistake(place, f"a {entry.type} joint has no pitch", "leave pitch out, or make it a screw")
    elif "pitch" not in entry.given:
        yield Mistake(place, "is missing", "give the advance in m/rad")
    elif entry.pitch == 0:
        yield Mistake(place, "is 0 m/rad", "give the advance in m/rad, or make it a revolute joint")
