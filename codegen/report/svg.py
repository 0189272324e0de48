"""Figures as SVG: text as text, the same bytes on every machine."""

from __future__ import annotations

import io
import math
import warnings
from collections.abc import Callable

import matplotlib
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, NullFormatter

_SETTINGS = {
    "svg.hashsalt": "jointgen",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 9,
    "text.parse_math": False,  # a dollar in a name is a dollar
}

_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")

_FEW = 20.0
"""Ratio of the ends of a logarithmic axis up to which twos and fives between powers of ten are labelled too."""


def drawn(draw: Callable[[Figure], None], width: float, height: float, layout: str | None = "constrained") -> str:
    """Draw a figure.

    Args:
        draw: fills it.
        width: in.
        height: in.
        layout: of matplotlib, which moves what would overlap; None where ``draw`` places all of it.

    Returns:
        An SVG document.
    """
    with matplotlib.rc_context(_SETTINGS), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph")  # the reader's font draws the text, not matplotlib's
        figure = Figure(figsize=(width, height), layout=layout)
        draw(figure)
        _label_powers(figure)
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines()) + "\n"


def _label_powers(figure: Figure) -> None:
    """Label logarithmic axes without the mathematical text of matplotlib, which would stand there as it is written."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            if axis.get_scale() == "log":
                low, high = axis.get_view_interval()
                axis.set_major_formatter(FuncFormatter(_power))
                axis.set_minor_formatter(FuncFormatter(_two_or_five) if high / low < _FEW else NullFormatter())


def _power(value: float, _: int | None) -> str:
    """Write a power of ten."""
    exponent = round(math.log10(value))
    return f"{value:g}" if abs(exponent) <= 2 else f"10{str(exponent).translate(_RAISED)}"


def _two_or_five(value: float, _: int | None) -> str:
    return f"{value:g}" if f"{value:.0e}"[0] in "25" else ""
