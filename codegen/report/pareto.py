"""The Pareto front of time and error, a joint a picture."""

from __future__ import annotations

from itertools import product

from matplotlib.figure import Figure

from codegen.report.sheets import Document
from codegen.report.svg import drawn

_MARKERS = tuple(product(("none", "black", "0.7"), "osD^v<>P"))
"""Filling and shape, readable without colour."""

_WIDTH, _HEIGHT = 7.5, 4.5


def pareto(document: Document, joint: str) -> str:
    """Draw all candidates of a joint: time across, largest scene error up, the front as a line.

    Args:
        document: of :mod:`codegen.trade.accuracy`.
        joint: one of its joints.

    Returns:
        An SVG document.
    """
    pairs = zip(document["candidates"], document["advice"]["candidates"], strict=True)
    points = [(c["routine"], c["build"], a["nanoseconds"], c["error"]) for c, a in pairs if c["joint"] == joint]
    fronts = {tuple(key) for key in document["advice"]["fronts"][joint]}

    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        for (filling, shape), build in zip(_MARKERS, dict.fromkeys(build for _, build, _, _ in points), strict=False):
            own = [(x, y) for _, name, x, y in points if name == build]
            axis.plot(*zip(*own, strict=True), shape, color="black", markerfacecolor=filling, label=build)
        line = sorted((x, y) for routine, build, x, y in points if (routine, build) in fronts)
        axis.step(*zip(*line, strict=True), where="post", color="black", linewidth=0.8, label="front")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlabel("ns for one joint")
        axis.set_ylabel("largest error / scale")
        axis.set_title(f"{joint}, {document['output']}", loc="left")
        axis.spines[["top", "right"]].set_visible(False)
        axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)

    return drawn(draw, _WIDTH, _HEIGHT)
