"""Figures as SVG: text as text, the same bytes on every machine."""

from __future__ import annotations

import io
import warnings
from collections.abc import Callable

import matplotlib
from matplotlib.figure import Figure

_SETTINGS = {
    "svg.hashsalt": "jointgen",
    "svg.fonttype": "none",
    "font.family": "sans-serif",
    "font.size": 9,
    "text.parse_math": False,  # a dollar in a name is a dollar
}


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
        buffer = io.StringIO()
        figure.savefig(buffer, format="svg", metadata={"Date": None, "Creator": None})
    return "\n".join(line.rstrip() for line in buffer.getvalue().splitlines()) + "\n"
