"""`Places`: which frames a model has, and in which of them its symbols are written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

SameAxes = Mapping[tuple[str, int], tuple[int, str, int]]
"""Axis -> sign and axis that stands for it."""


def stand_in(same_axes: SameAxes, frame: str, k: int) -> tuple[int, str, int]:
    """Sign, frame and number of the axis that stands for an axis in the end; itself where none does."""
    sign = 1
    while (frame, k) in same_axes:
        turn, frame, k = same_axes[frame, k]
        sign *= turn
    return sign, frame, k


@dataclass(frozen=True)
class Places:
    """Where the symbols of a model live.

    Attributes:
        rotations: rotation symbol -> (a, b): it turns components in frame b to components in frame a.
        given: rotations whose matrices are known; others are products.
        explicit: given rotations that are written out, not arguments.
        frames: vector symbol -> frame.
        stages: symbol -> definition.
        bodies: frame -> body, the outermost frame first.
        axes: frames whose axes have names.
        columns: first column and frame of each virtual displacement that is a vector.
        rows: first row and frame of each vector among the rows of the constraint.
        axis_names: frame -> names of its axes.
        vector_names: stage symbol -> name.
        whole: stages that are vectors or scalars of their own, not the sums that define them.
        is_raw: whether ``phi`` takes the rotation matrices as they are, orthonormal or not.
        constants: vector symbol -> its components, where these are numbers or scalar symbols.
        near: sets of frames; vectors are turned between frames of one set only. One set of all frames if left out.
        same_axes: (frame, k) -> sign, frame and k of an axis that is the same direction, so that it stands for it.
    """

    rotations: Mapping[Any, tuple[str, str]]
    given: tuple[Any, ...]
    explicit: Mapping[Any, Any]
    frames: Mapping[Any, str]
    stages: Mapping[Any, Any]
    bodies: Mapping[str, str]
    axes: frozenset[str]
    columns: tuple[tuple[int, str], ...]
    rows: Mapping[int, str]
    axis_names: Mapping[str, tuple[str, ...]]
    vector_names: Mapping[Any, str]
    whole: frozenset[Any] = frozenset()
    is_raw: bool = False
    constants: Mapping[Any, Any] = field(default_factory=dict)
    same_axes: SameAxes = field(default_factory=dict)
    near: tuple[frozenset[str], ...] = ()
