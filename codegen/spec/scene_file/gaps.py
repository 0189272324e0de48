"""Whether a joint closes in the pose at t = 0: how far its two halves are apart, whatever its coordinates are.

With joint frames ``[f g h]`` on both bodies, ``d`` is the vector from the origin on body i to that on body j in the
axes of joint frame i and ``H`` the rotation of joint frame j seen from joint frame i; ``H`` and ``d`` as functions of
the coordinates are those of the parametric form (S1 Tables 3 and 5).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from codegen.errors import Mistake
from codegen.spec.placement import dot, times, transposed
from codegen.spec.scene import COORDINATE_UNITS, Drive, Joint, Marker, Matrix, Vector
from codegen.spec.scene_file.bodies import Pose

CLOSED_LENGTH = 1e-6
"""m; below it a joint is closed."""

CLOSED_ANGLE = 1e-6
"""rad; below it a joint is closed."""

Rotation = tuple[tuple[float, ...], ...]


@dataclass(frozen=True, slots=True)
class Closure:
    """A joint in a pose.

    Attributes:
        length: m, by which the joint is open.
        angle: rad, by which it is open.
        coordinates: those at which it is closed, or least open.
    """

    length: float
    angle: float
    coordinates: tuple[float, ...]


def closure(joint: Joint, poses: tuple[Pose, Pose]) -> Closure:
    """Tell how far a joint is open in the pose of its two bodies."""
    points = [_world_point(marker, pose) for marker, pose in zip((joint.marker_i, joint.marker_j), poses, strict=True)]
    axes = [_world_axes(marker, pose) for marker, pose in zip((joint.marker_i, joint.marker_j), poses, strict=True)]
    apart = [b - a for a, b in zip(*points, strict=True)]
    d = tuple(float(dot(axis, apart)) for axis in axes[0])
    H = tuple(tuple(float(dot(a, b)) for b in axes[1]) for a in axes[0])
    return _CLOSURES[joint.type](d, H, float(joint.pitch))


def gap_mistakes(joint: Joint, poses: tuple[Pose, Pose], place: str) -> Iterator[Mistake]:
    """Report a joint that is open in the pose at t = 0, or whose drive asks for another coordinate then."""
    found = closure(joint, poses)
    open_by = []
    if found.length > CLOSED_LENGTH:
        open_by.append(f"{found.length * 1e3:.6g} mm apart")
    if found.angle > CLOSED_ANGLE:
        open_by.append(f"{math.degrees(found.angle):.6g} degrees out of line")
    if open_by:
        remedy = "correct its points and axes or the pose of its bodies, or accept gaps with assemble = true"
        yield Mistake(place, f"does not close at t = 0: it is {' and '.join(open_by)}", remedy)
        return
    values = zip(joint.coordinates, found.coordinates, COORDINATE_UNITS[joint.type], strict=True)
    for coordinate, value, unit in values:
        if coordinate.drive is not None:
            yield from _drive_mistakes(coordinate.drive, value, unit, joint, f"{place}: drive")


def _drive_mistakes(drive: Drive, value: float, unit: str, joint: Joint, place: str) -> Iterator[Mistake]:
    wanted = drive.value(0.0)
    is_turn = unit == "rad" and joint.type != "screw"
    gap = abs(math.remainder(wanted - value, math.tau) if is_turn else wanted - value)
    if gap <= (CLOSED_ANGLE if unit == "rad" else CLOSED_LENGTH):
        return
    told = f"{math.degrees(gap):.6g} degrees" if unit == "rad" else f"{gap * 1e3:.6g} mm"
    start = "position with the sine" if drive.amplitude else "position"
    what = f"does not close at t = 0: {start} is {wanted:.9g} {unit}, the pose has {value:.9g} {unit}, {told} apart"
    yield Mistake(place, what, "correct position or the pose of the bodies, or accept gaps with assemble = true")


def _world_point(marker: Marker, pose: Pose) -> list[Vector]:
    return [a + b for a, b in zip(times(pose.attitude, marker.point), pose.position, strict=True)]  # type: ignore[misc]


def _world_axes(marker: Marker, pose: Pose) -> Matrix:
    """The axes f, g, h as rows, world."""
    f, g, h = (times(pose.attitude, axis) for axis in transposed(marker.axes))
    return f, g, h


def _tilt(H: Rotation) -> float:
    """Angle between the axes h of both frames."""
    return math.atan2(math.hypot(H[0][2], H[1][2]), H[2][2])


def _turn(H: Rotation) -> float:
    """Rotation about h, at which the frames are nearest."""
    return math.atan2(H[1][0] - H[0][1], H[0][0] + H[1][1])


def _whole_angle(H: Rotation) -> float:
    """Angle of a rotation."""
    sine = math.hypot(H[2][1] - H[1][2], H[0][2] - H[2][0], H[1][0] - H[0][1])
    return math.atan2(sine, H[0][0] + H[1][1] + H[2][2] - 1)


def _revolute(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    return Closure(math.hypot(*d), _tilt(H), (_turn(H),))


def _translational(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    return Closure(math.hypot(*d[:2]), _whole_angle(H), (d[2],))


def _screw(d: tuple[float, ...], H: Rotation, pitch: float) -> Closure:
    """The advance along the axis belongs to the turn, but for whole revolutions."""
    advance = d[2] / pitch
    along = pitch * math.remainder(_turn(H) - advance, math.tau)
    return Closure(math.hypot(d[0], d[1], along), _tilt(H), (advance,))


def _cylindrical(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    return Closure(math.hypot(*d[:2]), _tilt(H), (d[2], _turn(H)))


def _universal(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    """``H = Rz(a1) Rx(a2)``: the axes of the cross, h_i and f_j, are perpendicular."""
    turns = (math.atan2(H[1][0], H[0][0]), math.atan2(H[2][1], H[2][2]))
    return Closure(math.hypot(*d), math.asin(min(1.0, abs(H[2][0]))), turns)


def _planar(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    return Closure(abs(d[2]), _tilt(H), (d[0], d[1], _turn(H)))


def _ball(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    """``H = Rz(a1) Ry(a2) Rx(a3)``."""
    middle = math.atan2(-H[2][0], math.hypot(H[0][0], H[1][0]))
    return Closure(math.hypot(*d), 0.0, (math.atan2(H[1][0], H[0][0]), middle, math.atan2(H[2][1], H[2][2])))


def _rigid(d: tuple[float, ...], H: Rotation, _: float) -> Closure:
    return Closure(math.hypot(*d), _whole_angle(H), ())


_CLOSURES = {
    "revolute": _revolute,
    "translational": _translational,
    "screw": _screw,
    "cylindrical": _cylindrical,
    "universal": _universal,
    "planar": _planar,
    "ball": _ball,
    "rigid": _rigid,
}
