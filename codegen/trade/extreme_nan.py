"""NaN in an input: which outputs it reaches, in the Program and in compiled code."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from codegen.emit.routine import Routine
from codegen.ir.program import Program
from codegen.measure.judge import Evaluate, by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.routine_builds import NATIVE, Build, built
from codegen.trade.extreme_numbers import LINEAR
from codegen.trade.extreme_table import Cell, ExtremeTable, poses_of, routine_of
from codegen.trade.programs import builds_folder

COMPILED = (Build("gcc -O2"), Build("gcc -O3 native", flags=NATIVE))
"""Builds in which NaN is followed."""


def nans() -> ExtremeTable:
    """NaN in one entry of an input reaches exactly the outputs that depend on it, in the Program and compiled."""
    rows: list[tuple[Cell, ...]] = []
    for variant in LINEAR:
        for output in ("phi", "phi_q", "phi_q_t_lambda_q", "gamma"):
            routine = routine_of(variant, output)
            ways: list[Evaluate] = [by_program(routine.straight), *(compiled(routine, one) for one in COMPILED)]
            wrong = [sum(bool(np.any(a != b)) for a, b in nan_patterns(routine, way)) for way in ways]
            entries = sum(argument.length for argument in routine.straight.used_arguments())
            rows.append((routine.symbol, float(entries), *(float(number) for number in wrong)))
    return ExtremeTable(
        "nan",
        "NaN in one input entry at a time: entries with other outputs than those that depend on it",
        ("routine", "entries tried", "Program", *(choice.name for choice in COMPILED)),
        tuple(rows),
    )


def compiled(routine: Routine, choice: Build) -> Evaluate:
    """Evaluate by a build of the routine."""
    made = built(routine, choice, builds_folder())
    return lambda given: {name: list(rows) for name, rows in made.values(given).items()}


def nan_patterns(
    routine: Routine, run: Evaluate | None = None
) -> Iterator[tuple[NDArray[np.bool_], NDArray[np.bool_]]]:
    """For each input entry: which outputs depend on it, and which are NaN where it is.

    Args:
        routine: its Program knows what depends on what.
        run: a way to evaluate it; that of the Program by default.
    """
    program = routine.straight
    given = poses_of(routine, PoseDomain(), count=1).given(np.float64)
    way = run or by_program(program)
    for argument in program.used_arguments():
        for index in range(argument.length):
            changed = given[argument.name].copy()
            changed[index] = np.nan
            values = way(given | {argument.name: changed})
            found = np.array([bool(np.isnan(np.max(v))) for rows in values.values() for v in rows])
            yield _dependent(program, argument.name, index), found


def _dependent(program: Program, argument: str, index: int) -> NDArray[np.bool_]:
    """Which output entries an entry of an input reaches."""
    marks: list[bool] = []
    for instruction in program.instructions:
        reached = any(marks[operand] for operand in instruction.operands)
        marks.append(reached or instruction.source == (argument, index))
    return np.array([marks[value] for output in program.outputs for value in output.values])
