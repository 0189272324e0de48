"""The frames of several joints of a scene put together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from codegen.ir.lower import Places
from codegen.mechanics.places import WORLD

_MAPPINGS = (
    "rotations",
    "explicit",
    "frames",
    "stages",
    "bodies",
    "rows",
    "axis_names",
    "vector_names",
    "constants",
    "same_axes",
)


def merged(parts: Sequence[Places], columns: Mapping[int, str]) -> Places:
    """Put the frames of several joints together; what two joints say of a body is the same.

    Args:
        parts: of each joint.
        columns: first column of each virtual displacement that is a vector -> its frame.
    """
    maps: dict[str, dict[Any, Any]] = {name: {} for name in _MAPPINGS}
    for part in parts:
        for name in _MAPPINGS:
            maps[name].update(getattr(part, name))
    given = tuple(dict.fromkeys(symbol for part in parts for symbol in part.given))
    bodies = {WORLD: WORLD} | maps.pop("bodies")
    used = {WORLD, *(frame for symbol in given for frame in maps["rotations"][symbol])}
    return Places(
        **maps,  # type: ignore[arg-type]
        given=given,
        bodies={frame: body for frame, body in bodies.items() if frame in used},
        axes=frozenset(frame for part in parts for frame in part.axes),
        columns=tuple(columns.items()),
        whole=frozenset(symbol for part in parts for symbol in part.whole),
        near=tuple(frozenset(part.bodies) for part in parts),
    )
