"""What a URDF holds that a scene does not model."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from codegen.spec.imported import LeftOut, quoted
from codegen.spec.xml_text import number, tag

_READ = {
    "robot": ({"name", "version"}, {"link", "joint"}),
    "link": ({"name"}, {"inertial"}),
    "joint": ({"name", "type"}, {"origin", "parent", "child", "axis", "dynamics", "limit"}),
    "inertial": (set[str](), {"origin", "mass", "inertia"}),
    "origin": ({"xyz", "rpy"}, set[str]()),
    "mass": ({"value"}, set[str]()),
    "inertia": ({"ixx", "ixy", "ixz", "iyy", "iyz", "izz"}, set[str]()),
    "parent": ({"link"}, set[str]()),
    "child": ({"link"}, set[str]()),
    "axis": ({"xyz"}, set[str]()),
    "dynamics": ({"damping", "friction"}, set[str]()),
    "limit": ({"lower", "upper", "effort", "velocity"}, set[str]()),
}
"""Attributes and elements that are read, or listed one by one below."""

_WHY = {
    "visual": "shapes have no part in the equations",
    "collision": "contact is not modelled",
    "material": "looks have no part in the equations",
    "mimic": "the joint moves on its own; couple the two by their drives",
    "safety_controller": "control is not modelled",
    "calibration": "encoders are not modelled",
    "transmission": "actuators are not modelled; give the joint a torque or a drive, or the body a force",
    "gazebo": "belongs to another program",
    "mujoco": "belongs to another program",
    "sensor": "sensors are not modelled",
    "contact": "contact is not modelled",
}

_MOVING = ("revolute", "continuous", "prismatic")


def left_out(robot: Element, place: str, has_stops: bool) -> list[LeftOut]:
    """List what is not modelled, in the order of the file.

    Args:
        robot: the file.
        place: its name.
        has_stops: whether the limits of joints are soft stops.
    """
    return list(_unread(robot, place, has_stops))


def _unread(element: Element, place: str, has_stops: bool) -> Iterator[LeftOut]:
    attributes, children = _READ[element.tag]
    for key in element.attrib:
        if key not in attributes:
            yield LeftOut(f"{tag(element)}: {key}", place, "is not known here")
    if element.tag == "joint":
        yield from _of_joint(element, place, has_stops)
    for child in element:
        name = tag(child)
        named = f": {name} {quoted(child.get('name', ''))}" if child.get("name") else ""
        if child.tag in children:
            yield from _unread(child, f"{place}{named}", has_stops)
        else:
            yield LeftOut(name, f"{place}{named}", _WHY.get(name, "is not known here"))


def _of_joint(joint: Element, place: str, has_stops: bool) -> Iterator[LeftOut]:
    kind = joint.get("type", "")
    for limit in joint.findall("limit"):
        if not has_stops and {"lower", "upper"} & set(limit.attrib) and kind in ("revolute", "prismatic"):
            yield LeftOut("limit: lower, upper", place, "the joint has no stops; ask for soft ones")
        elif {"lower", "upper"} & set(limit.attrib) and kind not in ("revolute", "prismatic"):
            yield LeftOut("limit: lower, upper", place, f"have no meaning for a joint that is {kind}")
        strength = [key for key in ("effort", "velocity") if key in limit.attrib]
        if strength:
            yield LeftOut(f"limit: {', '.join(strength)}", place, "actuators are not modelled")
    for dynamics in joint.findall("dynamics"):
        if number(dynamics.get("friction", "0")):
            yield LeftOut("dynamics: friction", place, "dry friction is not modelled")
        if number(dynamics.get("damping", "0")) and kind not in _MOVING:
            yield LeftOut("dynamics: damping", place, f"has no single coordinate in a joint that is {kind}")
