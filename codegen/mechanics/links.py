"""Constant rotations between frames of a scene, joined where a frame between them is none of its own."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Link:
    """A rotation between two frames: ``matrix`` turns components in ``end`` to components in ``start``."""

    name: str
    start: str
    end: str
    matrix: Any

    @property
    def reversed(self) -> Link:
        """The same rotation the other way."""
        return Link(self.name, self.end, self.start, self.matrix.T)


def contracted(links: list[Link], passed: set[str], name: str) -> list[Link]:
    """Join links that meet in a frame that is none of its own, under a name, and drop those that end there."""
    for frame in sorted(passed):
        meeting = [link if link.end == frame else link.reversed for link in links if frame in (link.start, link.end)]
        links = [link for link in links if frame not in (link.start, link.end)]
        if len(meeting) == 2:
            first, second = meeting[0], meeting[1].reversed
            links.append(Link(name, first.start, second.end, first.matrix * second.matrix))
    return links


def aligned_axes(matrix: Any) -> dict[int, tuple[int, int]]:
    """The columns of a rotation that are axes: k -> sign and number of the axis."""
    found = {}
    for k in range(3):
        axes = [(int(entry), i) for i, entry in enumerate(matrix.col(k)) if abs(entry) == 1]
        if axes and sum(1 for entry in matrix.col(k) if entry != 0) == 1:
            found[k] = axes[0]
    return found
