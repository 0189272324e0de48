"""Legs of a platform file: their joints, and their lengths in the poses of the file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations

from codegen.errors import Mistake
from codegen.spec.placement import cross, dot, times
from codegen.spec.platform import LEGS, PlatformPose
from codegen.spec.platform_file.entries import Points
from codegen.spec.scene import Vector

_NONE = Fraction(1, 10**24)
"""A squared length below this part of the squared size is none."""


def points_mistakes(points: Points, place: str) -> Iterator[Mistake]:
    """Check that there is one point for each leg, and that they do not all lie on a line."""
    sizes = [len(row) for row in points]
    if len(set(sizes)) > 1:
        yield Mistake(place, f"has rows of {', '.join(map(str, sizes))} numbers", f"give three rows of {LEGS}")
    elif sizes[0] != LEGS:
        words = "fewer than six" if sizes[0] < LEGS else "more than six"
        remedy = f"give three rows of {LEGS}: one column a leg"
        yield Mistake(place, f"has {sizes[0]} legs, {words}", remedy)
    elif _is_on_a_line(columns(points)):
        what = "has all its joints on one line, so that every pose is singular"
        yield Mistake(place, what, "correct the coordinates")


def leg_mistakes(base: Sequence[Vector], joints: Sequence[Vector], place: str) -> Iterator[Mistake]:
    """Check that no two legs are the same leg; they may share one of their joints."""
    for i, k in combinations(range(len(base)), 2):
        if base[i] == base[k] and joints[i] == joints[k]:
            what = f"legs {i + 1} and {k + 1} have coincident joints at both ends"
            yield Mistake(place, what, "move one of their joints")


def length_mistakes(
    base: Sequence[Vector], joints: Sequence[Vector], pose: PlatformPose, place: str
) -> Iterator[Mistake]:
    """Check that no leg has length zero in a pose."""
    size = max(dot(point, point) for point in (*base, *joints, pose.position))
    for number, (point, joint) in enumerate(zip(base, joints, strict=True), 1):
        turned = times(pose.rotation, joint)
        leg = tuple(t + (o - b) for t, o, b in zip(turned, pose.position, point, strict=True))
        if dot(leg, leg) <= _NONE * size:
            yield Mistake(place, f"leg {number} has length zero", "move the platform, or a joint of the leg")


def columns(points: Points) -> tuple[Vector, ...]:
    """The points of three rows."""
    return tuple(zip(*points, strict=True))


def _is_on_a_line(points: Sequence[Vector]) -> bool:
    first, *others = points
    differences = [_difference(point, first) for point in others]
    longest = max(differences, key=lambda d: dot(d, d))
    return not any(any(cross(longest, d)) for d in differences)


def _difference(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]
