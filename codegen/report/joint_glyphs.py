"""How a joint is drawn: polylines in its frame ``[f g h]``, with its point as origin and lengths in glyphs."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

_SIDES = 20


@dataclass(frozen=True, slots=True)
class Stroke:
    """A polyline.

    Attributes:
        side: 0 where it is fixed on body i, 1 where it is fixed on body j.
        points: of the joint frame on that body.
        is_filled: whether it bounds an area.
    """

    side: int
    points: tuple[tuple[float, float, float], ...]
    is_filled: bool = False


def _line(side: int, axis: int, half: float) -> Stroke:
    start, end = ((*(0.0,) * axis, sign * half, *(0.0,) * (2 - axis)) for sign in (-1, 1))
    return Stroke(side, (start, end))  # type: ignore[arg-type]


def _circle(side: int, radius: float) -> Stroke:
    angles = [2 * math.pi * k / _SIDES for k in range(_SIDES + 1)]
    return Stroke(side, tuple((radius * math.cos(a), radius * math.sin(a), 0.0) for a in angles))


def _helix(side: int, radius: float, half: float, turns: int) -> Stroke:
    steps = 12 * turns
    angles = [2 * math.pi * turns * k / steps for k in range(steps + 1)]
    points = ((radius * math.cos(a), radius * math.sin(a), half * (2 * k / steps - 1)) for k, a in enumerate(angles))
    return Stroke(side, tuple(points))


def _box(side: int, across: float, along: float) -> tuple[Stroke, Stroke]:
    """Rectangles along h, one in the plane of f and one in that of g: one of them is seen from any side."""
    corners = [(x * across, z * along) for x, z in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))]
    by_f, by_g = tuple((x, 0.0, z) for x, z in corners), tuple((0.0, y, z) for y, z in corners)
    return Stroke(side, by_f, is_filled=True), Stroke(side, by_g, is_filled=True)


def _square(side: int, half: float) -> Stroke:
    """A square in the plane of f and g."""
    corners = ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1))
    return Stroke(side, tuple((x * half, y * half, 0.0) for x, y in corners), is_filled=True)


GLYPHS: Mapping[str, tuple[Stroke, ...]] = {
    "revolute": (_line(0, 2, 1.0), _circle(1, 0.5)),
    "translational": (_line(0, 2, 4.0), *_box(1, 0.4, 0.8)),
    "screw": (_line(0, 2, 3.0), _helix(1, 0.5, 1.0, 3)),
    "cylindrical": (_line(0, 2, 3.0), _circle(1, 0.5), *_box(1, 0.4, 0.8)),
    "universal": (_line(0, 2, 1.0), _line(1, 0, 1.0)),
    "planar": (_square(0, 1.5), _line(1, 2, 0.5)),
    "ball": (),
    "rigid": (*_box(0, 0.4, 0.4), _square(0, 0.4)),
}
"""Strokes of each joint type; the player draws a dot for a joint without strokes. ``h`` is the axis, the slide or the
normal of the joint; the axes of a universal joint's cross are ``h_i`` and ``f_j``."""
