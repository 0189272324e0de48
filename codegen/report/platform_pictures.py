"""Ellipsoids of a platform at home, drawn on the mechanism: outlines seen from the side and from above."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.platforms.attitudes import Array
from codegen.platforms.programs import program
from codegen.report.svg import drawn
from codegen.spec.platform import Platform, WantedIndices

_VIEWS = (("from the side", (0, 2), "x", "z"), ("from above", (0, 1), "x", "y"))
_STYLES = (("all leg speeds of norm 1", "#0072b2", "-"), ("without the other motion", "#d55e00", "--"))
_SHARE = 0.45
"""Part of the size of the picture that the greatest semi-axis takes."""


def ellipsoids_picture(platform: Platform) -> str:
    """Draw the legs at home with the outlines of the ellipsoids of v (left) and of w (right), each to its own scale."""
    factors = home_factors(platform)
    joints = _joints(platform)

    def draw(figure: Figure) -> None:
        axes = figure.subplots(2, 2)
        for row, (words, places, horizontal, vertical) in enumerate(_VIEWS):
            for column, (motion, blocks) in enumerate((("v", (0, 1)), ("w", (2, 3)))):
                axis = axes[row, column]
                _legs(axis, joints, places)
                _outlines(axis, joints, [factors[block] for block in blocks], places)
                axis.set_title(f"{motion}, {words}", loc="left")
                axis.set_xlabel(f"{horizontal} in m")
                axis.set_ylabel(f"{vertical} in m")
                axis.set_aspect("equal", adjustable="datalim")
        handles, labels = axes[0, 0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2, frameon=False)

    return drawn(draw, 8.0, 7.0)


def home_factors(platform: Platform) -> list[Array]:
    """Factors F [3, 3] of the ellipsoids ``{F u: |u| <= 1}`` of sigma, beta, alpha and gamma at home."""
    plain = Platform(platform.name, platform.base, platform.joints, platform.home, (), WantedIndices())
    found = program(plain, ("ellipsoids",))
    o = [np.float64(x) for x in platform.home.position]
    turned = [np.float64(platform.home.rotation[i][k]) for k in range(3) for i in range(3)]
    with np.errstate(divide="ignore", invalid="ignore"):  # at a singular home semi-axes have no end
        values = evaluate(found, {"o": o, "R": turned}, numpy_domain())["ellipsoids"]
    dense = np.zeros((3, 12))
    for (row, column), value in zip(found.outputs[0].sparsity.entries(), values, strict=True):
        dense[row, column] = value
    return [dense[:, 3 * k : 3 * k + 3] for k in range(4)]


def _joints(platform: Platform) -> tuple[Array, Array, Array]:
    """Joints on the base and on the platform [3, 6] and the origin [3], in base axes."""
    base, joints = (np.array(points, dtype=float).T for points in (platform.base, platform.joints))
    o = np.array(platform.home.position, dtype=float)
    return base, np.array(platform.home.rotation, dtype=float) @ joints + o[:, None], o


def _legs(axis: Any, joints: tuple[Array, Array, Array], places: tuple[int, int]) -> None:
    i, k = places
    base, top, _ = joints
    for leg in range(base.shape[1]):
        axis.plot([base[i, leg], top[i, leg]], [base[k, leg], top[k, leg]], color="#666666", linewidth=1)
    for points in (base, top):
        closed = [*range(points.shape[1]), 0]
        axis.plot(points[i, closed], points[k, closed], color="black", linewidth=0.8, marker="o", markersize=3)


def _outlines(axis: Any, joints: tuple[Array, Array, Array], factors: list[Array], places: tuple[int, int]) -> None:
    """The shadow of ``{F u}`` on a plane is the ellipse ``{G u}`` with the two rows G of F."""
    base, top, o = joints
    size = np.ptp(np.hstack([base, top]), axis=1).max()
    greatest = max(np.linalg.norm(factor, 2) for factor in factors)
    scale = _SHARE * size / greatest if np.isfinite(greatest) and greatest > 0 else 0.0
    turns = np.linspace(0, 2 * np.pi, 121)
    for factor, (words, colour, style) in zip(factors, _STYLES, strict=True):
        axes, lengths, _ = np.linalg.svd(factor[list(places), :], full_matrices=False)
        outline = o[list(places), None] + scale * (axes * lengths) @ np.array([np.cos(turns), np.sin(turns)])
        axis.plot(outline[0], outline[1], color=colour, linestyle=style, linewidth=1.4, label=words)
