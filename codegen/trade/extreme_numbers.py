"""Very large and very small multipliers and lengths, and NaN: what becomes of the values of the routines."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from codegen.emit.routine import Routine
from codegen.ir.program import Program
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.spec.request import Variant
from codegen.trade.extreme_table import Cell, ExtremeTable, poses_of, routine_of

EXPONENTS = (-1060, -1030, -996, -500, 500, 996)
"""Powers of two: 2^-996 is 1.5e-300, 2^996 is 6.7e299; below 2^-1022 numbers are denormal."""

LINEAR = (
    Variant("revolute", "conventional", None),
    Variant("ball", "parametric", "regular"),
    Variant("revolute", "parametric", "table4", "substituted"),
)
_FEW = 8


def multipliers() -> ExtremeTable:
    """The second derivative is linear in lambda: scaled by a power of two it has the same bits."""
    rows: list[tuple[Cell, ...]] = []
    for variant in LINEAR:
        for output in ("phi_q_t_lambda_q", "phi_q_t_lambda"):
            routine = routine_of(variant, output)
            rows.append((routine.symbol, *(scaling_error(routine, exponent) for exponent in EXPONENTS)))
    return ExtremeTable(
        "multipliers",
        "Largest error of outputs linear in lambda, in units of the least denormal number or of the last place",
        ("routine", *(f"lambda 2^{exponent}" for exponent in EXPONENTS)),
        tuple(rows),
        (
            "Against the value at lambda of order 1, scaled. 0: the same bits. Where lambda is denormal,",
            "what is lost is a few times 2^-1074.",
        ),
    )


def scaling_error(routine: Routine, exponent: int) -> float:
    """Error of an output at ``2^exponent lambda``, over the distance of numbers of its size."""
    domain = PoseDomain()
    given = poses_of(routine, domain, count=_FEW).given(np.float64)
    # As many bits as a denormal multiplier has room for, so that what is scaled is exact.
    given["lambda"] = np.round(given["lambda"] * 2**10) / 2**10
    run = by_program(routine.straight)
    (name,) = (output.name for output in routine.program.outputs)
    expected = np.ldexp(np.array(run(given)[name]), exponent)
    found = np.array(run(given | {"lambda": np.ldexp(given["lambda"], exponent)})[name])
    return float(np.max(np.abs(found - expected) / np.spacing(np.abs(expected)), initial=0.0))


def nans() -> ExtremeTable:
    """NaN in one entry of an input reaches exactly the outputs that depend on it."""
    rows: list[tuple[Cell, ...]] = []
    for variant in LINEAR:
        for output in ("phi", "phi_q", "phi_q_t_lambda_q", "gamma"):
            routine = routine_of(variant, output)
            entries, wrong = 0, 0
            for expected, found in nan_patterns(routine):
                entries += 1
                wrong += int(np.any(expected != found))
            rows.append((routine.symbol, float(entries), float(wrong)))
    return ExtremeTable(
        "nan",
        "NaN in one input entry at a time",
        ("routine", "entries tried", "with other outputs than those that depend on it"),
        tuple(rows),
    )


def nan_patterns(routine: Routine) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.bool_]]]:
    """For each input entry: which outputs depend on it, and which are NaN where it is."""
    program = routine.straight
    given = poses_of(routine, PoseDomain(), count=1).given(np.float64)
    run = by_program(program)
    for argument in program.used_arguments():
        for index in range(argument.length):
            changed = given[argument.name].copy()
            changed[index] = np.nan
            values = run(given | {argument.name: changed})
            found = np.array([bool(np.isnan(np.max(v))) for rows in values.values() for v in rows])
            yield _dependent(program, argument.name, index), found


def _dependent(program: Program, argument: str, index: int) -> NDArray[np.bool_]:
    """Which output entries an entry of an input reaches."""
    marks: list[bool] = []
    for instruction in program.instructions:
        reached = any(marks[operand] for operand in instruction.operands)
        marks.append(reached or instruction.source == (argument, index))
    return np.array([marks[value] for output in program.outputs for value in output.values])
