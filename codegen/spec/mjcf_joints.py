"""The joints that one body of a MuJoCo model has, as one joint of a scene.

MuJoCo stacks joints in a body: the axis of the first is fixed in the parent, that of the last in the body. Between two
of them there is no body, so a stack is only a joint of a scene where the catalogue has it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen.spec.imported import LONGEST_NAME
from codegen.spec.link_tree import LinkJoint
from codegen.spec.placement import NEARLY, cross, dot, length, unit
from codegen.spec.pose import plus, scaled
from codegen.spec.scene import Coordinate, Vector


@dataclass(frozen=True, slots=True)
class Simple:
    """One joint of a body.

    Attributes:
        name: of the joint.
        kind: ``hinge``, ``slide``, ``ball`` or ``free``.
        point: [3] m, axes of the body in the initial pose.
        axis: [3], direction in the same axes.
        coordinate: what acts on it; 0 in the initial pose.
    """

    name: str
    kind: str
    point: Vector
    axis: Vector
    coordinate: Coordinate


def combined(stack: Sequence[Simple]) -> LinkJoint | None:
    """The joint of a scene that a stack of joints is; None if there is none."""
    slides = [joint for joint in stack if joint.kind == "slide"]
    hinges = [joint for joint in stack if joint.kind == "hinge"]
    if len(stack) == 1:
        return _single(stack[0])
    if len(slides) + len(hinges) != len(stack):
        return None
    match len(slides), len(hinges):
        case 1, 1:
            return _cylindrical(slides[0], hinges[0])
        case 0, 2:
            return _universal(*hinges)
        case 0, 3:
            return _ball(*hinges)
        case 2, 1:
            return _planar(slides[0], slides[1], hinges[0], stack[2].kind == "hinge")
    return None


def _single(joint: Simple) -> LinkJoint:
    if joint.kind in ("ball", "free"):
        return LinkJoint(joint.name, joint.kind, joint.point)
    kind = "revolute" if joint.kind == "hinge" else "translational"
    return LinkJoint(joint.name, kind, joint.point, joint.axis, coordinates=(joint.coordinate,))


def _cylindrical(slide: Simple, hinge: Simple) -> LinkJoint | None:
    if not _parallel(slide.axis, hinge.axis):
        return None
    along = slide.coordinate if dot(slide.axis, hinge.axis) > 0 else _reversed(slide.coordinate)
    name = _name(slide, hinge)
    return LinkJoint(name, "cylindrical", hinge.point, hinge.axis, coordinates=(along, hinge.coordinate))


def _universal(first: Simple, second: Simple) -> LinkJoint | None:
    crossing = _crossing(first, second)
    if crossing is None or not _perpendicular(first.axis, second.axis):
        return None
    coordinates = (first.coordinate, second.coordinate)
    return LinkJoint(_name(first, second), "universal", crossing, first.axis, second.axis, coordinates)


def _ball(first: Simple, second: Simple, third: Simple) -> LinkJoint | None:
    """Turns about h, g and f in this order, as in the parametric form."""
    crossing = _crossing(first, second)
    pairs = ((first, second), (second, third), (third, first))
    if crossing is None or not all(_perpendicular(a.axis, b.axis) for a, b in pairs):
        return None
    if not _on_axis(crossing, third):
        return None
    f = cross(unit(second.axis), unit(first.axis))
    last = third.coordinate if dot(f, third.axis) > 0 else _reversed(third.coordinate)
    name = _name(first, second, third)
    return LinkJoint(name, "ball", crossing, first.axis, f, (first.coordinate, second.coordinate, last))


def _planar(first: Simple, second: Simple, hinge: Simple, hinge_is_last: bool) -> LinkJoint | None:
    """Slides along f and g of the parent, then a turn about h; in another order only if nothing acts on the slides."""
    across = _perpendicular(first.axis, hinge.axis) and _perpendicular(second.axis, hinge.axis)
    loaded = first.coordinate.is_loaded or second.coordinate.is_loaded
    if not across or not _perpendicular(first.axis, second.axis) or (loaded and not hinge_is_last):
        return None
    g = cross(unit(hinge.axis), unit(first.axis))
    sideways = second.coordinate if dot(g, second.axis) > 0 else _reversed(second.coordinate)
    coordinates = (first.coordinate, sideways, hinge.coordinate)
    name = _name(first, second, hinge)
    return LinkJoint(name, "planar", hinge.point, hinge.axis, first.axis, coordinates)


def _name(*joints: Simple) -> str:
    """All their names, or that of the first if this is too long."""
    names = " + ".join(joint.name for joint in joints)
    return names if len(names) <= LONGEST_NAME else joints[0].name


def _reversed(coordinate: Coordinate) -> Coordinate:
    """What acts on the coordinate that counts the other way."""
    limit = coordinate.limit
    if limit is not None:
        lower = None if limit.upper is None else -limit.upper
        limit = replace(limit, lower=lower, upper=None if limit.lower is None else -limit.lower)
    return replace(coordinate, rest=-coordinate.rest, torque=-coordinate.torque, limit=limit)


def _parallel(a: Vector, b: Vector) -> bool:
    return length(cross(unit(a), unit(b))) < NEARLY


def _perpendicular(a: Vector, b: Vector) -> bool:
    return abs(dot(unit(a), unit(b))) < NEARLY


def _crossing(a: Simple, b: Simple) -> Vector | None:
    """Where two axes meet that are not parallel; one of their points where it can be."""
    for point, other in ((a.point, b), (b.point, a)):
        if _on_axis(point, other):
            return point
    across = cross(a.axis, b.axis)
    if not any(across):
        return None
    between = plus(b.point, scaled(a.point, Fraction(-1)))
    along = dot(cross(between, b.axis), across) / dot(across, across)
    point = plus(a.point, scaled(a.axis, along))
    return point if _on_axis(point, b) else None


def _on_axis(point: Vector, joint: Simple) -> bool:
    """Whether a point is on the axis of a joint, within a part in 1e9 of what is measured."""
    offset = plus(point, scaled(joint.point, Fraction(-1)))
    size = max(map(abs, (*point, *joint.point)))
    return length(cross(unit(joint.axis), offset)) <= NEARLY * size
