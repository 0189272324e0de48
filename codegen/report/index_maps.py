"""Maps of condition numbers over two axes of a grid, on a logarithmic scale, with the contour of singular poses."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure

from codegen.platforms.attitudes import Array
from codegen.platforms.run import Table
from codegen.report.svg import drawn

_BLOCKS = ("sigma: v", "beta: v, no rotation", "alpha: w", "gamma: w, no translation")
_CEILING = 1000.0
"""Greatest condition number that the colours tell apart."""

_FLOOR = 10.0
"""Least end of the colours: maps of well-conditioned platforms do not show their rounding."""

_NEAR = 100.0
"""Condition number of the contour around singular poses."""

_MOST = 400
"""Values of an axis that are drawn."""

_UNITS = {"x": "m", "y": "m", "z": "m", "roll": "rad", "pitch": "rad", "yaw": "rad"}


def index_maps(table: Table) -> str | None:
    """Draw C of the four blocks over the first two axes of a grid that have several values; None if there are not two.

    Further axes are cut in the middle of their values, which the title says; of a long axis every second, or third, ...
    value is drawn.
    """
    long = [k for k, axis in enumerate(table.poses.axes) if len(axis) > 1][:2]
    if len(long) < 2 or "C_sigma" not in table.columns:
        return None
    sizes = [len(axis) for axis in table.poses.axes]
    shown = [slice(None, None, -(-size // _MOST)) for size in sizes]
    slices = tuple(shown[k] if k in long else size // 2 for k, size in enumerate(sizes))
    maps = [np.array(table.column(f"C_{words.partition(':')[0]}").reshape(sizes)[slices]) for words in _BLOCKS]
    names = [table.poses.names[k] for k in long]
    ends = [table.poses.axes[k][shown[k]] for k in long]

    at = {table.poses.names[k]: axis[len(axis) // 2] for k, axis in enumerate(table.poses.axes) if k not in long}
    where = ", ".join(f"{name} {value:.4g} {_UNITS[name]}" for name, value in at.items())

    greatest = max(float(np.max(values, where=np.isfinite(values), initial=1.0)) for values in maps)
    end = min(max(greatest, _FLOOR), _CEILING)

    def draw(figure: Figure) -> None:
        if where:
            figure.suptitle(f"At {where}", x=0.02, ha="left", fontsize=10)
        axes = figure.subplots(2, 2, sharex=True, sharey=True)
        for axis, values, words in zip(axes.ravel(), maps, _BLOCKS, strict=True):
            image = _map(axis, ends, values, end)
            axis.set_title(f"C {words}", loc="left")
        for k, axis in enumerate(axes.ravel()):
            if k >= 2:
                axis.set_xlabel(f"{names[0]} in {_UNITS[names[0]]}")
            if k % 2 == 0:
                axis.set_ylabel(f"{names[1]} in {_UNITS[names[1]]}")
        line = f" (line: {_NEAR:g}, close to singular poses)" if end > _NEAR else ""
        figure.colorbar(image, ax=axes, label=f"condition number{line}")

    return drawn(draw, 8.0, 6.5)


def _map(axis: Any, ends: list[Array], values: Array, end: float) -> Any:
    shown = np.clip(values.T, 1.0, _CEILING)
    image = axis.pcolormesh(ends[0], ends[1], shown, norm=LogNorm(1.0, end), cmap="viridis", rasterized=True)
    finite = np.where(np.isfinite(shown), shown, _CEILING)
    if finite.min() < _NEAR < finite.max():
        axis.contour(ends[0], ends[1], finite, levels=[_NEAR], colors="white", linewidths=1.2)
    return image
