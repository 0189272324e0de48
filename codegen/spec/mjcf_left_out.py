"""What a model of MuJoCo holds, element by element, that a scene does not model."""

from __future__ import annotations

from xml.etree.ElementTree import Element

from codegen.spec.imported import LeftOut, quoted

_READ = {
    *("mujoco", "compiler", "include", "worldbody", "body", "frame", "replicate", "inertial", "joint", "freejoint"),
    *("equality", "connect", "weld"),
}
"""Elements that are read, or that only hold others."""

_SOLVER = "settings of a solver have no part in the equations"
_CONTACT = "contact is not modelled"
_ACTUATORS = "actuators are not modelled; give the joint a torque or a drive, or the body a force"
_SENSORS = "sensors are not modelled"
_LOOKS = "looks have no part in the equations"

_WHY = {
    "actuator": _ACTUATORS,
    "asset": "shapes and looks have no part in the equations, but for inertias that follow from shapes",
    "camera": _LOOKS,
    "contact": _CONTACT,
    "custom": "belongs to other programs",
    "deformable": "what bends is not modelled",
    "geom": "contact is not modelled; a shape counts only where an inertia follows from it",
    "keyframe": "the scene starts in the initial pose qpos0",
    "light": _LOOKS,
    "option": "but for gravity these are settings of a solver, or of a medium that is not modelled",
    "sensor": _SENSORS,
    "site": "a point without effect, but for the loops that it closes",
    "size": _SOLVER,
    "statistic": _LOOKS,
    "tendon": "tendons and their springs are not modelled; a straight one may become a spring of the scene",
    "visual": _LOOKS,
}

_EQUALITIES = "couples coordinates; not modelled, give the joints drives instead"

_LISTED_WITHIN = ("actuator", "asset", "contact", "keyframe", "sensor", "tendon")
"""Sections whose elements are listed one by one."""


def left_out(root: Element, place: str) -> list[LeftOut]:
    """List what is not modelled, in the order of the file; defaults only as they act on what is read."""
    found: list[LeftOut] = []
    waiting = [(root, place, "")]
    while waiting:
        element, where, section = waiting.pop()
        within = element.tag if element.tag in (*_LISTED_WITHIN, "equality") else section
        children = []
        for child in element:
            name = child.get("name") or child.get("joint") or child.get("joint1") or ""
            here = f"{where}: {child.tag} {quoted(name)}" if name else where
            why = _why(child, within)
            if why:
                found.append(LeftOut(child.tag, here, why))
            elif child.tag != "default":
                children.append((child, f"{where}: body {quoted(name)}" if child.tag == "body" else where, within))
        waiting += reversed(children)
    return found


def _why(element: Element, section: str) -> str | None:
    """Why an element is left out; None if it is read or holds others."""
    if section == "equality":
        return None if element.tag in ("connect", "weld") else _EQUALITIES
    if section:
        return _WHY[section]
    if element.tag in _LISTED_WITHIN or element.tag in _READ or element.tag == "default":
        return None
    if element.tag == "option" and not set(element.keys()) - {"gravity"} and not len(element):
        return None
    return _WHY.get(element.tag, "is not known here")
