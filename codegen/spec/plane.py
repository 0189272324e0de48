"""Planar mechanisms, anywhere in space, written as mechanisms in the plane of world x and y.

Input: a scene whose bodies move across one normal. Output: the same mechanism with the normal as third axis of the
world and of every body, and without what does not matter in the plane: heights along the normal, loads and velocities
out of it. Axes that are those of the world or of a body stay so, up to their order and sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen.spec.placement import (
    IDENTITY,
    NEARLY,
    columns,
    cross,
    dot,
    frame,
    on_axes,
    rotation,
    square_root,
    times,
    transposed,
    turned_back,
    unit,
)
from codegen.spec.scene import GROUND, Body, Force, Joint, Marker, Matrix, Quaternion, Scene, Spring, Torque, Vector
from codegen.spec.scene_file.planar import Placed, planar_mistakes, plane_normal

_Z: Vector = IDENTITY[2]


@dataclass(frozen=True, slots=True)
class InPlane:
    """A planar mechanism in the plane of world x and y, and how it came there.

    Attributes:
        scene: the mechanism; its motion is ``planar``.
        world: [3, 3] from the axes that the world had to those it has now; its third row is the normal.
        bodies: body -> [3, 3] from the axes it had to those it has now; the ground among them.
        heights: body -> m, its centre of mass along the normal, which is left out.
        gravity: m/s^2 along the normal, left out: the joints bear it.
    """

    scene: Scene
    world: Matrix
    bodies: Mapping[str, Matrix]
    heights: Mapping[str, Fraction]
    gravity: Fraction


def planar_normal(scene: Scene) -> Vector | None:
    """Find the normal of a mechanism that cannot leave a plane: unit vector, world; None for all others.

    All its joints are revolute or planar about the normal, translational across it, or rigid, and they join every body
    to the ground.
    """
    joints = _placed(scene)
    found = plane_normal(joints)
    if found is None or any(planar_mistakes(joints)) or not _is_joined(scene):
        return None
    return _upward(unit(found[0]))


def flattened(scene: Scene) -> Scene:
    """Write a planar mechanism in the plane of world x and y; see `in_plane`."""
    return in_plane(scene).scene


def in_plane(scene: Scene) -> InPlane:
    """Write a planar mechanism in the plane of world x and y.

    A body that has an axis along the normal keeps its axes, in another order; any other has those of the world at
    t = 0. Frames of translational and rigid joints are turned with their joint, so that their rows part into those in
    the plane and those across it. The points of a spring keep their distance along the normal, which its length needs.

    Args:
        scene: whose bodies, by its joints or by what the user says, move across one normal; where the joints tell none,
            it is the axis of the world across which they slide, z before y and x.
    """
    normal = _normal(scene)
    world = transposed(frame(normal))
    axes = {GROUND: world} | {body.name: _body_axes(body, normal, world) for body in scene.bodies}
    heights = {GROUND: Fraction(0)} | {body.name: dot(normal, body.position) for body in scene.bodies}
    flat = replace(
        scene,
        gravity=_across(times(world, scene.gravity)),
        bodies=tuple(_body(body, world, axes[body.name]) for body in scene.bodies),
        joints=tuple(_joint(joint, axes) for joint in scene.joints),
        springs=tuple(_spring(spring, axes, heights) for spring in scene.springs),
        torques=tuple(Torque(torque.body, _along(times(world, torque.vector))) for torque in scene.torques),
        motion="planar",
        forces=tuple(_force(force, world, axes[force.body]) for force in scene.forces),
    )
    del heights[GROUND]
    return InPlane(flat, world, axes, heights, dot(normal, scene.gravity))


def _placed(scene: Scene) -> list[Placed]:
    attitudes = {GROUND: IDENTITY} | {body.name: rotation(body.quaternion) for body in scene.bodies}
    return [
        Placed(joint, joint.name, times(attitudes[joint.bodies[0]], transposed(joint.marker_i.axes)[2]))
        for joint in scene.joints
    ]


def _is_joined(scene: Scene) -> bool:
    """Whether joints lead from the ground to every body."""
    reached, grown = {GROUND}, True
    while grown:
        ends = {name for joint in scene.joints if reached & set(joint.bodies) for name in joint.bodies}
        grown = not ends <= reached
        reached |= ends
    return all(body.name in reached for body in scene.bodies)


def _normal(scene: Scene) -> Vector:
    found = plane_normal(_placed(scene))
    if found is not None:
        return _upward(unit(found[0]))
    slides = [unit(joint.axis) for joint in _placed(scene) if joint.joint.type == "translational"]
    across = [axis for axis in reversed(IDENTITY) if all(abs(dot(axis, slide)) <= NEARLY for slide in slides)]
    return across[0] if across else transposed(frame(slides[0]))[0]


def _upward(normal: Vector) -> Vector:
    """A normal or its opposite: the one whose greatest component is positive."""
    x, y, z = normal
    return normal if max(normal, key=abs) > 0 else (-x, -y, -z)


def _body_axes(body: Body, normal: Vector, world: Matrix) -> Matrix:
    """From the axes of a body to those it has in the plane."""
    attitude = rotation(body.quaternion)
    third = unit(turned_back(attitude, normal))
    if third not in (*IDENTITY, *(_opposite(axis) for axis in IDENTITY)):
        return _product(world, attitude)
    k = next(k for k in range(3) if third[k])
    first, second = IDENTITY[(k + 1) % 3], IDENTITY[(k + 2) % 3]
    return (first, second, third) if third[k] > 0 else (second, first, third)


def _body(body: Body, world: Matrix, axes: Matrix) -> Body:
    attitude = _product(_product(world, rotation(body.quaternion)), transposed(axes))
    return replace(
        body,
        inertia=_product(_product(axes, body.inertia), transposed(axes)),
        position=_across(times(world, body.position)),
        quaternion=_turn(attitude[0][0], attitude[1][0]),
        velocity=_across(times(world, body.velocity)),
        angular_velocity=_along(times(axes, body.angular_velocity)),
    )


def _turn(cosine: Fraction, sine: Fraction) -> Quaternion:
    """Quaternion of a turn about z; its first component is not negative."""
    cosine, sine, _ = unit((cosine, sine, Fraction(0)))
    w = square_root((1 + cosine) / 2)
    return (w, Fraction(0), Fraction(0), sine / (2 * w) if w else Fraction(1))


def _joint(joint: Joint, axes: Mapping[str, Matrix]) -> Joint:
    first, second = (
        (times(axes[body], marker.point), _product(axes[body], marker.axes))
        for body, marker in zip(joint.bodies, (joint.marker_i, joint.marker_j), strict=True)
    )
    if joint.type == "rigid":
        frames = IDENTITY, _about_normal(_product(second[1], transposed(first[1])))
    elif joint.type == "translational":
        frames = _slide(first[1]), _slide(second[1])
    else:
        frames = _about_normal(first[1]), _about_normal(second[1])
    marker_i, marker_j = (
        Marker(_across(on_axes(point)), frame_) for (point, _), frame_ in zip((first, second), frames, strict=True)
    )
    return replace(joint, marker_i=marker_i, marker_j=marker_j)


def _about_normal(axes: Matrix) -> Matrix:
    """A joint frame whose third axis is along the normal, or against it, exactly."""
    f, _, h = transposed(axes)
    third = _Z if h[2] > 0 else _opposite(_Z)
    first = unit(_across(f))
    return columns(first, cross(third, first), third)


def _slide(axes: Matrix) -> Matrix:
    """A joint frame whose third axis lies in the plane exactly, and whose second is the normal."""
    h = unit(_across(transposed(axes)[2]))
    return columns(cross(_Z, h), _Z, h)


def _spring(spring: Spring, axes: Mapping[str, Matrix], heights: Mapping[str, Fraction]) -> Spring:
    points = [times(axes[body], point) for body, point in zip(spring.bodies, spring.points, strict=True)]
    levels = [heights[body] + point[2] for body, point in zip(spring.bodies, points, strict=True)]
    apart = levels[1] - levels[0]
    first, (x, y, _) = (_across(on_axes(point)) for point in points)
    size = max(map(abs, (*points[0], *points[1], *levels)))
    return replace(spring, points=(first, (x, y, apart if abs(apart) > NEARLY * size else Fraction(0))))


def _force(force: Force, world: Matrix, axes: Matrix) -> Force:
    """The part in the plane; its moment about the normal takes no height."""
    return Force(force.body, _across(times(world, force.vector)), _across(on_axes(times(axes, force.point))))


def _across(vector: Vector) -> Vector:
    """The part of a vector in the plane."""
    return (vector[0], vector[1], Fraction(0))


def _along(vector: Vector) -> Vector:
    """The part of a vector along the normal."""
    return (Fraction(0), Fraction(0), vector[2])


def _opposite(vector: Vector) -> Vector:
    x, y, z = vector
    return (-x, -y, -z)


def _product(a: Matrix, b: Matrix) -> Matrix:
    return transposed(tuple(times(a, column) for column in transposed(b)))  # type: ignore[arg-type]
