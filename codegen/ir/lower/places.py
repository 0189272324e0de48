"""`Places`: which frames a model has, and in which of them its symbols are written."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any


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
        whole: stages that are vectors of their own, not the sums that define them.
        is_raw: whether ``phi`` takes the rotation matrices as they are, orthonormal or not.
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
