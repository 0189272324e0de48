"""Fig. 10: the spatial slider-crank at four times, seen from aside and above."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.chains.variants import LENGTHS, turned
from codegen.report.svg import drawn

Array = NDArray[np.float64]

TIMES = (0.0, 0.3, 0.6, 0.8)
"""s."""

_AZIMUTH, _ELEVATION = np.radians(40.0), np.radians(25.0)
_PIVOT = np.array([0.0, 0.1, 0.12])
_BEARING = np.array([0.04, 0.0, 0.0])
_BOX = np.array([0.02, 0.015, 0.015])
"""Half the sides of the slider, m."""


def pictures() -> str:
    """Draw crank, rod and slider with the crank's circle and the slide."""
    record = turned(LENGTHS[-1]).record

    def draw(figure: Figure) -> None:
        axes = figure.subplots(2, 2, sharex=True, sharey=True)
        for axis, t in zip(axes.ravel(), TIMES, strict=True):
            k = int(np.argmin(np.abs(record.t - t)))
            _draw(axis, record.frames[k])
            axis.set_title(f"t = {t:.1f} s", loc="left")

    return drawn(draw, 7.0, 5.2)


def _draw(axis: Any, frames: Array) -> None:
    """Frames of links: 1 is the crank's pin, 4 the far end of the rod."""
    pin, end = frames[1, :, 3], frames[4, :, 3]
    turns = np.linspace(0.0, 2 * np.pi, 73)
    circle = _PIVOT + 0.08 * np.stack([0 * turns, np.sin(turns), np.cos(turns)], axis=1)
    _line(axis, circle, "0.7", 0.8)
    _line(axis, np.array([[0.0, 0, 0], [0.32, 0, 0]]), "0.5", 0.8, "--")
    _line(axis, np.array([_PIVOT - _BEARING, _PIVOT + _BEARING]), "0.5", 1.2)
    _line(axis, np.array([_PIVOT, pin]), "#0072b2", 3.0)
    _line(axis, np.array([pin, end]), "#d55e00", 2.0)
    for corners in _edges(end):
        _line(axis, corners, "#009e73", 1.0)
    axis.set_aspect("equal")
    axis.axis("off")


def _edges(centre: Array) -> list[Array]:
    """The edges of the slider."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    pairs = [(a, b) for k, a in enumerate(signs) for b in signs[k + 1 :] if np.sum(a != b) == 1]
    return [np.array([centre + _BOX * a, centre + _BOX * b]) for a, b in pairs]


def _line(axis: Any, points: Array, colour: str, width: float, dashes: str = "-") -> None:
    """A line in space, along x to the right, y into the page and z upwards."""
    right = np.array([np.cos(_AZIMUTH), np.sin(_AZIMUTH), 0.0])
    out = np.array([np.sin(_AZIMUTH) * np.cos(_ELEVATION), -np.cos(_AZIMUTH) * np.cos(_ELEVATION), np.sin(_ELEVATION)])
    up = np.cross(out, right)
    axis.plot(points @ right, points @ up, dashes, color=colour, linewidth=width, solid_capstyle="round")
