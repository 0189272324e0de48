"""Curves of the figures of S2, told apart by their line style."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from benchmarks.chains.variants import INERTIAS, LENGTHS, SPEEDS, chain, driven, stroke, turned
from codegen.report.svg import drawn

_LINES = ("-", "--", "-.")
_COLOURS = ("#0072b2", "#d55e00", "#009e73")
_WIDTH, _HEIGHT = 7.0, 3.2

Array = NDArray[np.float64]

Curve = tuple[str, Array, Array]
"""Label, times in s, values."""


def position() -> str:
    """Fig. 6: position of the slider of the quick return."""
    slide = chain("quick_return").index("slide")
    curves = [
        (f"ω = {name}", (run := stroke(speed)).record.t, run.record.q[:, slide]) for name, speed in SPEEDS.items()
    ]
    return _chart(curves, "position of the slider, m")


def speed() -> str:
    """Fig. 7: angular velocity of the crank of the quick return."""
    curves = [(f"J = {J} kg m²", (run := driven(J)).record.t, run.record.qd[:, 0]) for J in INERTIAS]
    return _chart(curves, "angular velocity of the crank, rad/s")


def acceleration() -> str:
    """Fig. 9: acceleration of the slider of the slider-crank."""
    slide = chain("spatial_slider_crank").index("slide")
    curves = [_labelled(length, turned(length).record.qdd[:, slide]) for length in LENGTHS]
    return _chart(curves, "acceleration of the slider, m/s²")


def torque() -> str:
    """Fig. 11: torque on the crank of the slider-crank."""
    curves = []
    for length in LENGTHS:
        tau = turned(length).record.tau
        assert tau is not None
        curves.append(_labelled(length, tau[:, 0]))
    return _chart(curves, "driving torque, N m")


def _labelled(length: Fraction, values: Array) -> Curve:
    return f"L = {float(length):.2f} m", turned(length).record.t, values


def _chart(curves: Sequence[Curve], words: str) -> str:
    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        for (label, t, values), dashes, colour in zip(curves, _LINES, _COLOURS, strict=False):
            axis.plot(t, values, dashes, color=colour, linewidth=1.2, label=label)
        axis.set_xlabel("time, s")
        axis.set_ylabel(words)
        axis.grid(visible=True, color="0.9")
        axis.spines[["top", "right"]].set_visible(False)
        axis.margins(x=0)
        figure.legend(frameon=False, loc="outside upper right", ncols=len(curves))

    return drawn(draw, _WIDTH, _HEIGHT)
