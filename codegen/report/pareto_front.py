"""The trade of semi-regular hexagons at home: none has C_sigma C_gamma below 2."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from codegen.platforms.hexagons import conditions, hexagons
from codegen.report.svg import drawn

_DESIGNS = 1500
_GREATEST = 10.0


def pareto_picture() -> str:
    """Draw C of sigma and gamma of many designs, and the front."""
    generator = np.random.default_rng(8)
    top, delta = generator.uniform(0.1, 1.0, _DESIGNS), generator.uniform(0.05, np.pi - 0.05, _DESIGNS)
    found = conditions(*hexagons(top, delta), generator.uniform(0.1, 3.0, _DESIGNS))
    front = np.linspace(1.0, 2.0, 60)

    def draw(figure: Figure) -> None:
        axis = figure.subplots()
        axis.plot(found[0], found[3], ".", color="#0072b2", markersize=2.5, label="semi-regular hexagons at home")
        axis.plot(front, 2 / front, color="#d55e00", linewidth=1.6, label="C sigma · C gamma = 2")
        axis.set_xscale("log")
        axis.set_yscale("log")
        axis.set_xlim(0.95, _GREATEST)
        axis.set_ylim(0.95, _GREATEST)
        axis.set_xlabel("C sigma: translation")
        axis.set_ylabel("C gamma: rotation")
        axis.set_title("Designs of radius 1, platform radius, angle and height at random", loc="left")
        axis.legend(frameon=False)

    return drawn(draw, 6.0, 5.0)
