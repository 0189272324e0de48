"""The digits that each way loses on the way into a singular configuration: error over the condition number."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from benchmarks.platforms.candidates import Array
from codegen.report.svg import drawn
from tests.velocity.found import EPS, found
from tests.velocity.geometries import SEMI_REGULAR
from tests.velocity.test_accuracy import approach, truths
from tests.velocity.truth import Truth, error

WAYS = {"literal": ("^", "0.5"), "robust": ("o", "black")}
"""Variant -> marker and colour."""

_DISTANCES = [10.0**-k * s for k in range(1, 10) for s in (1, 1.5, 2.2, 3.2, 4.7, 6.8)]
"""rad from Fichter's configuration."""

_FLOOR = 1e-17


def loss_figure() -> str:
    """Draw the error of D of sigma over kappa, one mark a pose, and the slopes 1 and 2; an SVG document."""
    poses = approach(SEMI_REGULAR, _DISTANCES)
    expected = truths(SEMI_REGULAR, poses, "double")
    kappas = np.array([truth.kappa for truth in expected])
    wrong = {way: _errors(way, poses, expected) for way in WAYS}

    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        for way, (marker, colour) in WAYS.items():
            axis.loglog(kappas, wrong[way], marker, color=colour, markersize=3, label=way)
        _slopes(axis, kappas)
        axis.set_xlabel("condition number kappa")
        axis.set_ylabel("relative error of D of sigma")
        axis.spines[["top", "right"]].set_visible(False)
        axis.legend(frameon=False)

    return drawn(draw, 6.0, 3.6)


def _errors(variant: str, poses: list[tuple[Array, Array]], expected: list[Truth]) -> Array:
    D = found(SEMI_REGULAR.platform(variant), ("D", "C"), poses)["D"][0]
    return np.array([min(max(error(value, truth.D[0]), _FLOOR), 1.0) for value, truth in zip(D, expected, strict=True)])


def _slopes(axis: Axes, kappas: Array) -> None:
    ends = np.array([kappas.min(), kappas.max()])
    for power, label, place in ((1, "eps kappa", (3e7, 6e-8)), (2, "eps kappa^2", (2e4, 2e-6))):
        axis.loglog(ends, EPS["double"] * ends**power, "-", color="0.8", linewidth=0.8, zorder=0)
        axis.annotate(label, place, ha="right")
    axis.set_ylim(_FLOOR / 2, 3)
