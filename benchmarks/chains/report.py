"""The page that shows the figures, with what the runs say in numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from benchmarks.chains.variants import INERTIAS, LENGTHS, SPEEDS, chain, driven, stroke, turned
from codegen.chains.simulate import SimulatedChain
from tests.reference.quick_return import DRIVE, crossings, cutting_work, quick_return
from tests.reference.spatial_slider_crank import spatial_slider_crank

Array = NDArray[np.float64]


def markdown() -> str:
    """Write ``chain_figures.md``."""
    return "\n".join([*_quick_return(), *_slider_crank(), *_counts()]) + "\n"


def _quick_return() -> Iterator[str]:
    yield from (
        "# The simulations of S2",
        "",
        "Written by `make figures-chain` from [quick_return.toml](../examples/chains/quick_return.toml) and",
        "[spatial_slider_crank.toml](../examples/chains/spatial_slider_crank.toml). The error is the largest",
        "difference from a solution in one coordinate from the closed-form geometry (`tests/reference`).",
        "",
        "## Quick return",
        "",
        "Fig. 6: position of the slider for two speeds of the crank, which starts at 0.44 rad.",
        "",
        "![position of the slider](chain_figures/slider_position.svg)",
        "",
    )
    rows = [
        (name, *_range(_column(stroke(speed), "slide", "q")), _stroke_error(stroke(speed)))
        for name, speed in SPEEDS.items()
    ]
    yield from _table(("ω", "least x, m", "greatest x, m", "error, m"), rows)
    yield from (
        "",
        "Fig. 7: angular velocity of the crank for three moments of inertia, with a drive of 165 521 N m and 200 000 N",
        "of cutting force while the slider moves to the left between 1.2 m and -4 m. The paper does not print the",
        "start; here it is where cutting ends, with 2π rad/s. The drive does the work of one cut in a turn, so that",
        "the speed is the same after every turn, and a heavier crank changes its speed less.",
        "",
        "![angular velocity of the crank](chain_figures/crank_speed.svg)",
        "",
    )
    rows = [(f"{J}", *_range(_column(driven(J), "crank", "qd")), _speed_error(J)) for J in INERTIAS]
    yield from _table(("J, kg m²", "least ω, rad/s", "greatest ω, rad/s", "error, rad/s"), rows)


def _slider_crank() -> Iterator[str]:
    yield from (
        "",
        "## Spatial slider-crank",
        "",
        "Fig. 9: acceleration of the slider for three lengths of the rod, crank at 2π rad/s.",
        "",
        "![acceleration of the slider](chain_figures/slider_acceleration.svg)",
        "",
        "It peaks where the crank points along the offset (0.1, 0.12) of the slide, at",
        "`d r ω² / sqrt(L² - (d + r)²)`; the crank would lock there with a rod of 0.2362 m.",
        "",
    )
    peaks = [(f"{float(L):.2f}", *_peak(L), _acceleration_error(L)) for L in LENGTHS]
    yield from _table(("L, m", "peak, m/s²", "at, s", "formula, m/s²", "error, m/s²"), peaks)
    yield from (
        "",
        "Fig. 10: the mechanism at four times, rod of 0.3 m.",
        "",
        "![the slider-crank at four times](chain_figures/pictures.svg)",
        "",
        "Fig. 11: torque on the crank.",
        "",
        "![torque on the crank](chain_figures/driving_torque.svg)",
        "",
    )
    rows = [(f"{float(L):.2f}", *_range(_effort(turned(L))), _torque_error(L)) for L in LENGTHS]
    yield from _table(("L, m", "least torque, N m", "greatest torque, N m", "error, N m"), rows)


def _counts() -> Iterator[str]:
    yield from (
        "",
        "## Coordinates and constraints (Table 4)",
        "",
        "Absolute coordinates after the paper, whose numbers are those with the ground as a body: 6 bodies in the",
        "plane with 3 coordinates each, 2 rows for each of 7 joints and 3 for the ground; 4 bodies in space with 7",
        "coordinates each, 17 rows of joints, 4 norms of Euler parameters and 6 rows for the ground. Relative",
        "coordinates as the chains have them; of the 12 rows of the quick return's two cuts 6 are structurally zero.",
        "",
    )
    printed = {"quick_return": ("18", "17", "7", "6"), "spatial_slider_crank": ("28", "27", "7", "6")}
    rows = []
    for name, run in (
        ("quick_return", stroke(next(iter(SPEEDS.values())))),
        ("spatial_slider_crank", turned(LENGTHS[0])),
    ):
        own = f"{len(chain(name).links)}", f"{len(run.mechanism.part.rows)}"
        rows.append((name.replace("_", " "), *printed[name], *own))
    head = (
        "",
        "absolute coordinates",
        "constraints",
        "relative, printed",
        "constraints",
        "relative, here",
        "constraints",
    )
    yield from _table(head, rows)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> Iterator[str]:
    yield f"| {' | '.join(head)} |"
    yield "|---" * len(head) + "|"
    yield from (f"| {' | '.join(row)} |" for row in rows)


def _column(run: SimulatedChain, link: str, name: str) -> Array:
    values: Array = getattr(run.record, name)
    return values[:, run.mechanism.chain.index(link)]


def _effort(run: SimulatedChain) -> Array:
    assert run.record.tau is not None
    return run.record.tau[:, 0]


def _range(values: Array) -> tuple[str, str]:
    return f"{np.min(values):.4g}", f"{np.max(values):.4g}"


def _below(errors: Array) -> str:
    """An upper bound, a power of ten: rounding differs between machines."""
    return f"< 1e{math.ceil(math.log10(max(float(np.max(np.abs(errors))), 1e-15)) + 0.3)}"


def _stroke_error(run: SimulatedChain) -> str:
    x = [quick_return().output("x", q, 1.0)[0] for q in run.record.q[:, 0]]
    return _below(_column(run, "slide", "q") - np.array(x))


def _speed_error(J: int) -> str:
    run, (_, ends) = driven(J), crossings()
    q = run.record.q[:, 0]
    truth = quick_return(J).speed_by_energy(ends, run.record.qd[0, 0], q, DRIVE * (q - ends) + cutting_work(ends, q))
    return _below(run.record.qd[:, 0] - truth)


def _angles(length: Fraction) -> Array:
    return np.asarray(turned(length).record.q[:, 0] + np.pi / 2)


def _peak(length: Fraction) -> tuple[str, str, str]:
    values = _column(turned(length), "slide", "qdd")
    d, r, L = math.hypot(0.1, 0.12), 0.08, float(length)
    formula = d * r * (2 * math.pi) ** 2 / math.sqrt(L**2 - (d + r) ** 2)
    return f"{np.max(values):.4g}", f"{turned(length).record.t[int(np.argmax(values))]:.3f}", f"{formula:.4g}"


def _acceleration_error(length: Fraction) -> str:
    truth = spatial_slider_crank(length).output("x", _angles(length), 2 * np.pi)[2]
    return _below(_column(turned(length), "slide", "qdd") - truth)


def _torque_error(length: Fraction) -> str:
    truth = spatial_slider_crank(length).effort(_angles(length), 2 * np.pi, 0.0)
    return _below(_effort(turned(length)) - truth)
