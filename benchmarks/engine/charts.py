"""Curves as SVG, readable without colour, the same bytes for the same figures."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from benchmarks.engine.mechanism import FORMS
from codegen.measure.constraints import Array
from codegen.report.svg import drawn

_LINES = {"conventional": ("black", "-", "o"), "parametric": ("0.45", "--", "s")}
_QUANTITIES = {"v": "velocity of the piston, m/s", "a": "acceleration of the piston, m/s²"}


def piston_chart(columns: dict[str, Array]) -> str:
    """S1, Fig. 4: velocity and acceleration of the piston in both formulations."""

    def draw(figure: Figure) -> None:
        for axis, (part, words) in zip(figure.subplots(2, 1, sharex=True), _QUANTITIES.items(), strict=True):
            for form in FORMS:
                colour, dashes, _ = _LINES[form]
                width = 0.8 if form == "conventional" else 2.0
                axis.plot(columns["t"], columns[f"{form} {part}"], dashes, color=colour, linewidth=width, label=form)
            axis.set_ylabel(words)
            axis.spines[["top", "right"]].set_visible(False)
        axis.set_xlabel("time, s")
        axis.legend(frameon=False, loc="lower right")

    return drawn(draw, 7.5, 5.0)


def work_precision_chart(rows: list[dict[str, Any]]) -> str:
    """Error of the positions against processor time and against tolerance."""

    def draw(figure: Figure) -> None:
        left, right = figure.subplots(1, 2, sharey=True)
        for axis, key, words in ((left, "seconds", "processor time, s"), (right, "tolerance", "tolerance")):
            for form in FORMS:
                colour, dashes, sign = _LINES[form]
                chosen = [row for row in rows if row["form"] == form and "position" in row]
                places, errors = [row[key] for row in chosen], [row["position"] for row in chosen]
                axis.loglog(places, errors, dashes, marker=sign, color=colour, markerfacecolor="white", label=form)
            axis.set_xlabel(words)
            axis.grid(visible=True, color="0.9")
        left.set_ylabel("largest error of a position in 2 s, m")
        right.legend(frameon=False)

    return drawn(draw, 7.5, 3.6)
