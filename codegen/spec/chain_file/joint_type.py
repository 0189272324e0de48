"""The type of a joint in a chain file; of joints that are made of several it is told how."""

from __future__ import annotations

from codegen.errors import Mistake
from codegen.spec.chain import JOINT_TYPES
from codegen.spec.scene_file.text import quoted
from codegen.spec.scene_file.values import Kind, choice

_KNOWN = choice(JOINT_TYPES)

_MADE_OF = {
    "ball": "three revolute links whose axes meet, the first two massless",
    "spherical": "three revolute links whose axes meet, the first two massless",
    "universal": "two revolute links whose axes meet, the first massless",
    "cylindrical": "a prismatic and a revolute link on one axis, the first massless",
    "planar": "two prismatic links and a revolute one across them, the first two massless",
    "translational": 'type = "prismatic"',
    "fixed": "its mass on the parent, and frames of cuts and effectors there",
    "rigid": "its mass on the parent, and frames of cuts and effectors there",
}


def _read(value: object, place: str, mistakes: list[Mistake]) -> str | None:
    made_of = _MADE_OF.get(value) if isinstance(value, str) else None
    if made_of is None:
        return _KNOWN.read(value, place, mistakes)
    mistakes.append(Mistake(place, f"there is no {quoted(str(value))}", f"write {made_of}"))
    return None


JOINT_TYPE: Kind[str] = Kind(_read, _KNOWN.schema)
