"""What the tables of extremes share: the table itself, digits, and routines at poses."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.emit.routine import Routine
from codegen.measure.double_double import DoubleDouble
from codegen.measure.errors import number_type
from codegen.measure.judge import block_errors, by_program, true_values
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import Poses, exactly, sample_poses
from codegen.spec.request import Variant
from codegen.trade.programs import routines
from codegen.trade.specimens import blocks_of, joint_subject

POSES = 64
MOST_DIGITS = 17.0
REALS = ("double", "float")
Cell = str | float
Vectors = Mapping[str, Sequence[DoubleDouble]]


@dataclass(frozen=True, slots=True)
class ExtremeTable:
    """A table of what becomes of routines at an extreme.

    Attributes:
        name: short, for data.
        title: what it shows.
        columns: headings.
        rows: cells; the first ones are words.
        notes: sentences below it.
    """

    name: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()


def routine_of(variant: Variant, output: str) -> Routine:
    """The routine of one output alone."""
    return routines(variant, (output,))[0]


def digits(error: float, scale: float) -> float:
    """Decimal digits that are right after the point of value over scale."""
    return MOST_DIGITS if error == 0 else min(MOST_DIGITS, max(0.0, -math.log10(error / scale)))


def poses_of(routine: Routine, domain: PoseDomain, is_converged: bool = True, count: int = POSES) -> Poses:
    """Poses of a routine's joint."""
    subject = joint_subject(routine)
    arguments = routine.program.arguments
    return sample_poses(subject.joint, subject.variant, arguments, domain, count, is_converged)


def least_digits(
    routine: Routine, given: Mapping[str, NDArray[np.floating]], truth: Vectors, domain: PoseDomain
) -> float:
    """Digits of the worst block of a routine at inputs, against the exact values at these or at other inputs."""
    program = routine.straight
    judged = blocks_of(routine)
    count = next(iter(given.values())).shape[1]
    errors = block_errors(by_program(program)(given), true_values(program, truth), judged, count)
    scales = [domain.scale(block.output, block.is_rotation) for block in judged]
    return min(digits(float(np.max(error)), scale) for error, scale in zip(errors, scales, strict=True))


def digits_of_given(routine: Routine, poses: Poses, domain: PoseDomain, real: str) -> float:
    """Digits against the given inputs."""
    given = poses.given(number_type(real))
    return least_digits(routine, given, exactly(given), domain)


def digits_of_ideal(routine: Routine, poses: Poses, domain: PoseDomain, real: str) -> float:
    """Digits against ideal geometry."""
    return least_digits(routine, poses.given(number_type(real)), poses.ideal, domain)


def as_data(tables: Sequence[ExtremeTable]) -> dict[str, Any]:
    """Tables as data."""
    return {
        table.name: {
            "title": table.title,
            "rows": [dict(zip(table.columns, row, strict=True)) for row in table.rows],
            "notes": list(table.notes),
        }
        for table in tables
    }
