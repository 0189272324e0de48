"""Bar charts of operation counts, one a joint, as SVG: readable without colour, the same bytes on every machine."""

from __future__ import annotations

from typing import Any

from matplotlib.figure import Figure

from codegen.report.sheets import Document
from codegen.report.svg import drawn

_HATCHES = ("", "//", "\\\\", "xx", "--")
_WIDTH, _LINE_HEIGHT, _MARGIN = 7.5, 0.28, 0.9


def bar_chart(document: Document, joint: str) -> str:
    """Draw the counts of one joint: printed, by the paper's rules, vectors first and as emitted, both derivatives.

    Args:
        document: of Table 7.
        joint: one of its joints.

    Returns:
        An SVG document.
    """
    rows = [row for row in document["rows"] if row["joint"] == joint]
    bars = [bars_of(row, document) for row in rows]
    height = sum(len(group) for group in bars) * _LINE_HEIGHT + 2 * _MARGIN

    def draw(figure: Figure) -> None:
        axes = figure.subplots(len(rows), 1, gridspec_kw={"height_ratios": [len(group) for group in bars]})
        for axis, row, group in zip(axes, rows, bars, strict=True):
            _draw(axis, row["derivative"], group)

    return drawn(draw, _WIDTH, height)


def bars_of(row: Document, document: Document) -> list[tuple[str, float]]:
    """Label and length of each bar of one derivative."""
    bars: list[tuple[str, float]] = []
    for side in ("conventional", "parametric"):
        for key, words in (("printed", "printed"), ("rules", "paper's rules"), ("vectors_first", "vectors first")):
            if key in row:
                bars.append((f"{side}, {words}", row[key][side]))
    bars += [
        (f"emitted: {words}", row["emitted"][column]["total"])
        for column, words in document["columns"].items()
        if column in row["emitted"]
    ]
    return bars


def _draw(axis: Any, derivative: str, bars: list[tuple[str, float]]) -> None:
    labels, lengths = [label for label, _ in bars], [length for _, length in bars]
    drawn = axis.barh(range(len(bars)), lengths, color="white", edgecolor="black", linewidth=0.8)
    for rectangle, hatch in zip(drawn, _hatches(labels), strict=True):
        rectangle.set_hatch(hatch)
    axis.bar_label(drawn, labels=[f"{length:g}" for length in lengths], padding=3)
    axis.set_yticks(range(len(bars)), labels)
    axis.invert_yaxis()
    axis.set_xlabel("operations")
    axis.set_title(derivative, loc="left")
    axis.margins(x=0.12)
    axis.spines[["top", "right"]].set_visible(False)


def _hatches(labels: list[str]) -> list[str]:
    """Printed, by rules and emitted bars differ by their hatching."""
    kinds = [label.split(", ", 1)[-1] if not label.startswith("emitted") else "emitted" for label in labels]
    order = list(dict.fromkeys(kinds))
    return [_HATCHES[order.index(kind)] for kind in kinds]
