"""The tree of frames: which rotation matrices are given, and the components of vectors that are given in a frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from codegen.ir.lower.polynomial import Polynomial

Component = tuple[str, int] | Polynomial
"""Entry of an argument (name, index), or a scalar."""

Components = tuple[Component, ...]
"""Three components."""

Matrix = tuple[Components, ...]
"""Three columns."""


@dataclass(frozen=True)
class FrameTree:
    """Frames joined by given rotation matrices.

    Attributes:
        rotations: (a, b) -> columns of the matrix that turns components in b to components in a.
        given: (frame, name) -> components of a given vector.
        bodies: frame -> the body it is fixed in; the first frame is the outermost.
        near: sets of frames; vectors are turned between frames of one set only. One set of all frames if left out.
    """

    rotations: Mapping[tuple[str, str], Matrix]
    given: Mapping[tuple[str, str], Components]
    bodies: Mapping[str, str]
    near: tuple[frozenset[str], ...] = ()

    @cached_property
    def frames(self) -> tuple[str, ...]:
        """All frames, the outermost first."""
        return tuple(self.bodies)

    @cached_property
    def _neighbours(self) -> dict[str, list[str]]:
        near: dict[str, list[str]] = {frame: [] for frame in self.frames}
        for a, b in self.rotations:
            near[a].append(b)
            near[b].append(a)
        return near

    def path(self, start: str, end: str) -> list[str]:
        """Frames from one to another along the tree, both included; empty where no way leads."""
        reached: dict[str, str | None] = {start: None}
        waiting = [start]
        while waiting and end not in reached:
            frame = waiting.pop(0)
            for near in self._neighbours[frame]:
                if near not in reached:
                    reached[near] = frame
                    waiting.append(near)
        if end not in reached:
            return []
        chain = [end]
        while (before := reached[chain[-1]]) is not None:
            chain.append(before)
        return chain[::-1]

    @cached_property
    def _connected(self) -> dict[str, tuple[str, ...]]:
        return {
            frame: tuple(other for other in self.frames if self._is_near(other, frame) and self.path(other, frame))
            for frame in self.frames
        }

    def _is_near(self, a: str, b: str) -> bool:
        return not self.near or a == b or any(a in frames and b in frames for frames in self.near)

    def connected(self, frame: str) -> tuple[str, ...]:
        """The near frames from which rotations lead to a frame, itself among them, in the order of `frames`."""
        return self._connected[frame]

    def outward(self, frame: str) -> list[str]:
        """The frame and those around it, up to the outermost."""
        return self.path(frame, self.frames[0])

    def matrix(self, to: str, of: str) -> Matrix | None:
        """Columns of the rotation from frame ``of`` to the neighbouring frame ``to``, where it is given."""
        if (to, of) in self.rotations:
            return self.rotations[to, of]
        columns = self.rotations.get((of, to))
        return None if columns is None else tuple(zip(*columns, strict=True))
