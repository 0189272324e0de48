"""Very large and very small multipliers and lengths, and NaN: what becomes of the values of the routines."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from codegen.emit.routine import Routine
from codegen.measure.errors import number_type
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.spec.request import Variant
from codegen.trade.extreme_table import REALS, Cell, ExtremeTable, poses_of, routine_of
from codegen.trade.specimens import blocks_of

Inputs = dict[str, NDArray[np.floating]]

EXPONENTS = {"double": (-1060, -1030, -996, -500, 500, 996), "float": (-140, -130, -100, -50, 50, 100)}
"""Powers of two: 2^-996 is 1.5e-300, 2^996 is 6.7e299; below 2^-1022, and 2^-126 in float, numbers are denormal."""

LINEAR = (
    Variant("revolute", "conventional", None),
    Variant("ball", "parametric", "regular"),
    Variant("revolute", "parametric", "table4", "substituted"),
)
_HEADINGS = ("far denormal", "denormal", "tiny", "small", "large", "huge")
_BITS = {"double": 10, "float": 5}
"""Of the numbers to be scaled: as many as a denormal one has room for, so that scaling is exact."""

_FEW = 8
_LENGTHS = (("r_i", range(3)), ("r_j", range(3)), ("geometry", (0, 1, 2, 12, 13, 14)))
"""What has the unit of a length: positions and attachments."""


def multipliers() -> ExtremeTable:
    """The second derivative is linear in lambda: scaled by a power of two it has the same bits."""
    rows: list[tuple[Cell, ...]] = []
    for variant in LINEAR:
        for output in ("phi_q_t_lambda_q", "phi_q_t_lambda"):
            routine = routine_of(variant, output)
            rows += [(routine.symbol, real, *_errors(routine, real, multiplied)) for real in REALS]
    return ExtremeTable(
        "multipliers",
        "Largest error of outputs linear in lambda, in units of the least denormal number or of the last place",
        ("routine", "numbers", *_HEADINGS),
        tuple(rows),
        (
            "Against the value at lambda of order 1, scaled. 0: the same bits. Where lambda is denormal,",
            "what is lost is a few times the least number.",
            *_scales(),
        ),
    )


def lengths() -> ExtremeTable:
    """Translational rows are linear in positions and attachments: a mechanism of any size has the same bits."""
    rows: list[tuple[Cell, ...]] = []
    for variant in LINEAR:
        routine = routine_of(variant, "phi")
        rows += [(routine.symbol, real, *_errors(routine, real, stretched)) for real in REALS]
    return ExtremeTable(
        "lengths",
        "Largest error of the translational rows of phi, in units of the least denormal number or of the last place",
        ("routine", "numbers", *_HEADINGS),
        tuple(rows),
        ("All lengths scaled, against the value at lengths of order 1.", *_scales()),
    )


def _scales() -> Iterator[str]:
    for real, exponents in EXPONENTS.items():
        yield f"{real}: 2 to the power of {', '.join(str(exponent) for exponent in exponents)}."


Change = Callable[[Inputs, int], Inputs]
"""Scales some inputs by a power of two."""


def multiplied(given: Inputs, exponent: int) -> Inputs:
    """Multipliers scaled."""
    return given | {"lambda": np.ldexp(given["lambda"], exponent)}


def stretched(given: Inputs, exponent: int) -> Inputs:
    """Lengths scaled, without joint coordinates: those of `LINEAR` are angles."""
    found = dict(given)
    for name, entries in _LENGTHS:
        found[name] = given[name].copy()
        found[name][list(entries)] = np.ldexp(given[name][list(entries)], exponent)
    return found


def _errors(routine: Routine, real: str, change: Change) -> Iterator[float]:
    return (scaling_error(routine, exponent, real, change) for exponent in EXPONENTS[real])


def scaling_error(routine: Routine, exponent: int, real: str = "double", change: Change = multiplied) -> float:
    """Error of the outputs that are linear in what is scaled by ``2^exponent``, over the distance of such numbers."""
    given = poses_of(routine, PoseDomain(), count=_FEW).given(number_type(real))
    coarse = {"lambda", *(name for name, _ in _LENGTHS)} if change is stretched else {"lambda"}
    bits = 2.0 ** _BITS[real]
    given |= {name: (np.round(given[name] * bits) / bits).astype(number_type(real)) for name in coarse & set(given)}
    run = by_program(routine.straight)
    (name,) = (output.name for output in routine.program.outputs)
    blocks = [block for block in blocks_of(routine) if change is multiplied or not block.is_rotation]
    linear = [k for block in blocks for k in block.entries]
    with np.errstate(under="ignore"):
        expected = np.ldexp(np.array(run(given)[name])[linear], exponent)
        found = np.array(run(change(given, exponent))[name])[linear]
    return float(np.max(np.abs(found - expected) / np.spacing(np.abs(expected)), initial=0.0))
