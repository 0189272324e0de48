"""A run as small multiples over one time axis, as SVG: bodies, then joints with coordinates, efforts and reactions.

Columns are quantities, rows are bodies and joints. Components differ by colour and by line style, so that a print
without colour tells them apart.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from numpy.typing import NDArray

from codegen.report.motion_rows import CHAINS, STILL, Panel, Row, body_rows, joint_rows
from codegen.report.svg import drawn
from codegen.simulate.trajectory import Array, Trajectory
from codegen.spec.scene import Scene

MOST = 8
"""Bodies that are drawn, and rows of joints; a note tells of the others."""

_BINS = 600
"""A curve is drawn by its extremes in as many pieces: more than a screen or a print can tell apart."""

_LINES = (("#0072b2", "-"), ("#d55e00", "--"), ("#009e73", "-."))
_PANEL_WIDTH, _PANEL_HEIGHT, _LEFT, _TOP, _BOTTOM = 2.7, 1.25, 1.5, 1.0, 0.8


def plot(trajectory: Trajectory, title: str, scene: Scene | None = None) -> str:
    """Draw a run.

    Args:
        trajectory: finite.
        title: above all panels.
        scene: of the trajectory; without it the coordinates of joints have "m or rad" as their unit.

    Returns:
        An SVG document; the id of a curve's group is its column in ``trajectory.csv``, of a rate ``JOINT.alphadot1``...
    """
    bodies, joints = body_rows(trajectory), joint_rows(trajectory, scene)
    blocks = [rows[:MOST] for rows in (bodies, joints) if rows]
    notes = list(_notes(trajectory, bodies, joints))
    columns = max((len(_headings(block)) for block in blocks), default=2)
    height = _TOP + _BOTTOM + 0.16 * len(notes) + _PANEL_HEIGHT * (sum(map(len, blocks)) + 0.4 * (len(blocks) - 1))
    width = _LEFT + _PANEL_WIDTH * columns

    def draw(figure: Figure) -> None:
        figure.suptitle(title, x=0.1 / width, y=1 - 0.1 / height, ha="left", va="top", fontsize=11)
        figure.text(0.1 / width, 0.1 / height, "\n".join(notes), ha="left", va="bottom", fontsize=8)
        styles = {
            style for block in blocks for row in block for panel in row.panels.values() for _, style, _ in panel.curves
        }
        _legend(figure, 1 - 0.32 / height, sorted(styles))
        if blocks:
            bottom = (_BOTTOM - 0.2 + 0.16 * len(notes)) / height
            edges = {"left": _LEFT / width, "bottom": bottom, "right": 1 - 0.15 / width, "top": 1 - _TOP / height}
            ratios = [1.0] * len(blocks[0]) + ([0.4] + [1.0] * len(blocks[1]) if len(blocks) > 1 else [])
            grid = figure.add_gridspec(len(ratios), columns, height_ratios=ratios, wspace=0.32, hspace=0.22, **edges)
            _draw_blocks(figure, grid, trajectory.t, blocks)

    return drawn(draw, width, height, layout=None)


def _notes(trajectory: Trajectory, bodies: list[Row], joints: list[Row]) -> Iterator[str]:
    if bodies:
        yield "Positions, velocities and accelerations of centres of mass: world axes; angular ones: body axes."
    if trajectory.reaction:
        yield "Reactions: on the second body of a joint, at its point, world axes."
    at_rest = len(trajectory.bodies) - len(bodies)
    yield f"Drawn is what moves{f'; {at_rest} of {len(trajectory.bodies)} bodies do not' if at_rest else ''}."
    if len(bodies) > MOST:
        yield f"The first {MOST} of {len(bodies)} moving bodies; trajectory.csv has all."
    if len(joints) > MOST:
        yield f"The first {MOST} of {len(joints)} rows of joints; trajectory.csv has all."


def _headings(block: list[Row]) -> list[str]:
    return [heading for chain in CHAINS for heading in chain if any(heading in row.panels for row in block)]


def _sizes(block: list[Row], duration: float) -> dict[str, float]:
    """Size of each quantity: the largest of all rows, or what its integral needs to come about."""
    sizes: dict[str, float] = {}
    for chain in CHAINS:
        needed = 0.0
        for heading in chain:
            panels = [row.panels[heading] for row in block if heading in row.panels]
            largest = max((float(np.max(np.abs(c[2]))) for panel in panels for c in panel.curves), default=0.0)
            sizes[heading] = max(largest, needed)
            needed = sizes[heading] / duration if duration else 0.0
    return sizes


def _draw_blocks(figure: Figure, grid: Any, t: Array, blocks: list[list[Row]]) -> None:
    """Draw the panels; a line that is left empty parts bodies from joints."""
    first = None
    line = 0
    for block in blocks:
        headings, sizes = _headings(block), _sizes(block, float(t[-1] - t[0]))
        for number, row in enumerate(block):
            for column, heading in enumerate(headings):
                if heading in row.panels:
                    axis = figure.add_subplot(grid[line, column], sharex=first)
                    first = first or axis
                    is_last = all(heading not in below.panels for below in block[number + 1 :])
                    _draw_panel(axis, t, row.panels[heading], sizes[heading], is_last)
                    if all(heading not in above.panels for above in block[:number]):
                        axis.set_title(heading, loc="left", fontsize=9)
            _label(figure, grid[line, 0], row.name)
            line += 1
        line += 1
    if first is not None and t[-1] > t[0]:
        first.set_xlim(t[0], t[-1])


def _draw_panel(axis: Any, t: Array, panel: Panel, size: float, is_last: bool) -> None:
    for name, style, values in panel.curves:
        color, dashes = _LINES[style]
        kept = thinned(values)
        (line,) = axis.plot(t[kept], values[kept], color=color, linestyle=dashes, linewidth=1.1)
        line.set_gid(name)
    low = min(float(np.min(values)) for _, _, values in panel.curves)
    high = max(float(np.max(values)) for _, _, values in panel.curves)
    if high - low < STILL * size:  # a constant, and not the last digits of one
        axis.set_ylim(low - 0.1 * size, high + 0.1 * size)
    axis.set_ylabel(panel.unit, fontsize=8, labelpad=2)
    axis.tick_params(labelsize=7, labelbottom=is_last)
    axis.grid(color="#dddddd", linewidth=0.5)
    axis.spines[["top", "right"]].set_visible(False)
    if is_last:
        axis.set_xlabel("t in s", fontsize=8, labelpad=1)


def _label(figure: Figure, cell: Any, name: str) -> None:
    """Write the name of a row left of its panels."""
    box = cell.get_position(figure)
    x, y = box.x0 - (_LEFT - 0.1) / figure.get_figwidth(), (box.y0 + box.y1) / 2
    figure.text(x, y, textwrap.fill(name, 15), ha="left", va="center", fontweight="bold", fontsize=8)


def _legend(figure: Figure, y: float, styles: Sequence[int]) -> None:
    """Tell components apart, where there are several."""
    words = ("x, or the joint's 1st coordinate", "y, or the 2nd", "z, or the 3rd")
    if len(styles) < 2:
        return
    lines = [Line2D([], [], color=_LINES[k][0], linestyle=_LINES[k][1], linewidth=1.4) for k in styles]
    names = [words[k] for k in styles]
    figure.legend(lines, names, loc="upper left", bbox_to_anchor=(0, y), ncols=3, frameon=False, fontsize=8)


def thinned(values: Array) -> NDArray[np.intp]:
    """Numbers of the values that draw the same curve: all, or the ends and the extremes of each of `_BINS` pieces."""
    count = len(values)
    if count <= 2 * _BINS:
        return np.arange(count, dtype=np.intp)
    pieces = np.array_split(np.arange(count), _BINS)
    extremes = [piece[find(values[piece])] for piece in pieces for find in (np.argmin, np.argmax)]
    return np.unique(np.array([0, *extremes, count - 1], dtype=np.intp))
