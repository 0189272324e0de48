"""The two chains of S2 with other lengths, inertias and speeds, and their runs."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

from codegen.chains.read import read
from codegen.chains.simulate import Settings, SimulatedChain, simulated
from codegen.spec.angles import PI
from codegen.spec.chain import Chain, Link
from codegen.spec.chain_motions import Polynomial

_FOLDER = Path(__file__).parents[2] / "examples" / "chains"

SPEEDS = {"2π rad/s": 2 * PI, "4π rad/s": 4 * PI}
"""Of the quick return's crank, Fig. 6."""

INERTIAS = (1000, 2000, 3000)
"""Of the quick return's crank, kg m^2, Fig. 7."""

LENGTHS = (Fraction("0.24"), Fraction("0.27"), Fraction("0.30"))
"""Of the slider-crank's rod, m, Fig. 9 and 11."""


@cache
def chain(name: str) -> Chain:
    """A chain of the examples."""
    return read(_FOLDER / f"{name}.toml")[0]


@cache
def stroke(speed: Fraction) -> SimulatedChain:
    """Kinematics of the quick return at a speed of its crank, over 1 s."""
    given = chain("quick_return")
    crank = given.independents[0]
    assert isinstance(crank.motion, Polynomial)
    turned = replace(crank, motion=Polynomial((crank.motion.coefficients[0], speed)))
    return simulated(replace(given, independents=(turned,)), {}, Settings("kinematics", 1.0, 400))


@cache
def driven(inertia: int, duration: float = 2.0) -> SimulatedChain:
    """Forward dynamics of the quick return with an inertia of its crank, from where cutting ends."""
    given = chain("quick_return")
    links = tuple(_with_inertia(link, inertia) if link.name == "crank" else link for link in given.links)
    return simulated(replace(given, links=links), {}, Settings("forward", duration, 400, 1e-10))


@cache
def turned(length: Fraction) -> SimulatedChain:
    """Inverse dynamics of the slider-crank with a length of its rod, over a turn."""
    given = chain("spatial_slider_crank")
    links = tuple(_with_length(link, length) for link in given.links)
    return simulated(replace(given, links=links, assemble=True), {}, Settings("inverse", 1.0, 400))


def _with_inertia(link: Link, inertia: int) -> Link:
    moments = tuple(tuple(Fraction(inertia) if i == k else Fraction(0) for k in range(3)) for i in range(3))
    return replace(link, inertia=moments)  # type: ignore[arg-type]


def _with_length(link: Link, length: Fraction) -> Link:
    if link.name == "pin":
        return replace(link, row=replace(link.row, c=length))
    return replace(link, centre=(Fraction(0), Fraction(0), length / 2)) if link.name == "rod" else link
