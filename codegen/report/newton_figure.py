"""Residuals of Newton's method, step after step."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from codegen.report.svg import drawn

_STYLES = ("-", "--", "-.", ":")
_MARKERS = "os^x"
_WIDTH, _HEIGHT = 6.0, 3.6
_LEAST = 1e-17


def newton_figure(residuals: Mapping[str, Sequence[float]]) -> str:
    """Draw the residual over the iteration.

    Args:
        residuals: name of the second derivative -> sizes.

    Returns:
        An SVG document.
    """

    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        for (name, sizes), style, marker in zip(residuals.items(), _STYLES, _MARKERS, strict=True):
            heights = [max(size, _LEAST) for size in sizes]
            axis.semilogy(heights, style, marker=marker, color="black", markersize=4, linewidth=0.9, label=name)
        axis.set_xlabel("iteration")
        axis.set_ylabel("residual")
        axis.spines[["top", "right"]].set_visible(False)
        axis.legend(frameon=False)

    return drawn(draw, _WIDTH, _HEIGHT)
