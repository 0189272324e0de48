"""What a run gives: the motion of the bodies and joints at the output times."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Trajectory:
    """A motion at [n] times.

    Attributes:
        bodies: names.
        t: [n] s.
        r: [n, nb, 3] m, centre of mass, world.
        q: [n, nb, 4] attitude, w x y z, of norm 1.
        v: [n, nb, 3] m/s, world.
        w: [n, nb, 3] rad/s, body axes.
        a: [n, nb, 3] m/s^2, world.
        al: [n, nb, 3] rad/s^2, rate of the components of ``w``.
        alpha: joint -> [n, k] joint coordinates, m or rad.
        alphadot: joint -> [n, k] their rates.
        effort: driven joint -> [n, drives] N or N m, along the coordinate.
        reaction: joint -> [n, 6] force N and moment N m on body j at the joint's point on body j, world axes.
    """

    bodies: tuple[str, ...]
    t: Array
    r: Array
    q: Array
    v: Array
    w: Array
    a: Array
    al: Array
    alpha: Mapping[str, Array]
    alphadot: Mapping[str, Array]
    effort: Mapping[str, Array]
    reaction: Mapping[str, Array]


def columns(trajectory: Trajectory) -> Iterator[tuple[str, Array]]:
    """Name and values of every column of ``trajectory.csv``, in its order."""
    yield "t", trajectory.t
    groups = (("r", "xyz"), ("q", "wxyz"), ("v", "xyz"), ("w", "xyz"), ("a", "xyz"), ("al", "xyz"))
    for k, body in enumerate(trajectory.bodies):
        for name, axes in groups:
            values = getattr(trajectory, name)
            yield from ((f"{body}.{name}{axis}", values[:, k, i]) for i, axis in enumerate(axes))
    for joint, values in trajectory.alpha.items():
        yield from ((f"{joint}.alpha{i + 1}", values[:, i]) for i in range(values.shape[1]))
    for joint, values in trajectory.effort.items():
        names = [""] if values.shape[1] == 1 else [str(i + 1) for i in range(values.shape[1])]
        yield from ((f"{joint}.effort{name}", values[:, i]) for i, name in enumerate(names))
    for joint, values in trajectory.reaction.items():
        words = ("fx", "fy", "fz", "mx", "my", "mz")
        yield from ((f"{joint}.{word}", values[:, i]) for i, word in enumerate(words))


def as_csv(trajectory: Trajectory) -> str:
    """Write ``trajectory.csv``: 17 digits, one line a time."""
    named = list(columns(trajectory))
    text = io.StringIO(newline="")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([name for name, _ in named])
    for line in zip(*(values.tolist() for _, values in named), strict=True):
        writer.writerow([f"{value:.17g}" for value in line])
    return text.getvalue()
