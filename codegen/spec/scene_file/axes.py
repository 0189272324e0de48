"""Directions in a scene file: axes that are not zero, and second axes perpendicular to the first."""

from __future__ import annotations

import math
from collections.abc import Iterator

from codegen.errors import Mistake
from codegen.spec.placement import IDENTITY, cross, dot
from codegen.spec.scene import Vector
from codegen.spec.scene_file.bodies import TOLERANCE
from codegen.spec.scene_file.text import shown_vector


def axis_mistakes(axis: Vector, place: str) -> Iterator[Mistake]:
    """Check that a vector has a direction."""
    if not any(axis):
        yield Mistake(place, "is zero and has no direction", "give a vector along the axis, of any length")


def perpendicular_mistakes(axis: Vector, second: Vector, place: str) -> Iterator[Mistake]:
    """Check that the second axis of a universal joint is perpendicular to the first, within 1e-9 rad."""
    along, squared = dot(axis, second), dot(axis, axis)
    if along * along <= TOLERANCE**2 * squared * dot(second, second):
        return
    nearest = tuple(squared * y - along * x for x, y in zip(axis, second, strict=True))
    if not any(nearest):
        nearest = next(across for across in (cross(axis, e) for e in IDENTITY) if any(across))
    greatest = max(map(abs, nearest))
    offered = shown_vector(value / greatest for value in nearest)
    what = f"stands at {angle(axis, second):.9g} degrees to axis, not at 90"
    yield Mistake(place, what, f"the nearest perpendicular direction is {offered}")


def angle(a: Vector, b: Vector) -> float:
    """Angle between two directions in degrees, 0 to 180."""
    across = cross(a, b)
    return math.degrees(math.atan2(math.sqrt(dot(across, across)), float(dot(a, b))))


def is_parallel(a: Vector, b: Vector) -> bool:
    """Whether two directions are parallel or opposite, within 1e-9 rad."""
    across = cross(a, b)
    return dot(across, across) <= TOLERANCE**2 * dot(a, a) * dot(b, b)


def is_perpendicular(a: Vector, b: Vector) -> bool:
    """Whether two directions are perpendicular, within 1e-9 rad."""
    return dot(a, b) ** 2 <= TOLERANCE**2 * dot(a, a) * dot(b, b)
