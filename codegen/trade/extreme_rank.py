"""How far the Jacobian is from losing rank: its smallest singular value over the coordinates of each joint."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.measure.double_double import DoubleDouble
from codegen.measure.draw import sobol_points
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import poses_at
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import Variant
from codegen.trade.extreme_table import Cell, ExtremeTable, routine_of
from codegen.trade.specimens import joint_subject

_GRID = 72
"""Angles over a turn; 0, half and quarter turns are among them."""

_GEOMETRIES = 4
GIMBAL = tuple(10.0**-k for k in (1, 2, 4, 8))
"""How far the middle angle of rot3 is from a quarter turn, rad."""


@dataclass(frozen=True, slots=True)
class Least:
    """The smallest singular value over all poses, and the angle where it is; that of the columns of alpha alone."""

    sigma: float
    angle: float
    of_coordinates: float


def rank_variants() -> tuple[Variant, ...]:
    """Every joint in every form and set of rows."""
    found: list[Variant] = []
    for joint in JOINTS.values():
        found.append(Variant(joint.name, "conventional", None))
        rows = ("regular", "table4") if joint.rotations else ("regular",)
        found += [Variant(joint.name, "parametric", choice) for choice in rows]
        found += [Variant(joint.name, "parametric", "quaternion")] if joint.rotations == 3 else []
    return tuple(found)


def least_singular_value(variant: Variant, pitch_angle: float = 1.2) -> Least:
    """Look over a turn of the first angle, at closed poses with unit geometry.

    Args:
        variant: of which the Jacobian is taken.
        pitch_angle: the middle angle of rot3, rad; its gimbal lock is at a quarter turn.
    """
    routine = routine_of(variant, "phi_q")
    subject = joint_subject(routine)
    arguments = routine.program.arguments
    angles = np.linspace(-math.pi, math.pi, _GRID + 1)
    points = np.repeat(sobol_points(_GEOMETRIES), len(angles), axis=0)
    grid = np.tile(angles, _GEOMETRIES)
    fixed = {0: grid, 1: np.full(len(grid), pitch_angle)} if subject.joint.rotations == 3 else {0: grid}
    poses = poses_at(subject.joint, variant, arguments, PoseDomain(), points, True, _numbers(fixed))
    given = poses.given(np.float64)
    (output,) = routine.straight.outputs
    values = by_program(routine.straight)(given)["phi_q"]
    matrices = np.zeros((len(grid), output.sparsity.nrow, output.sparsity.ncol))
    for (row, column), entry in zip(output.sparsity.entries(), values, strict=True):
        matrices[:, row, column] = entry
    sigmas = np.linalg.svd(matrices, compute_uv=False)[:, -1]
    where = int(np.argmin(sigmas))
    columns = matrices[:, :, 12:]
    own = np.linalg.svd(columns, compute_uv=False)[:, -1] if columns.shape[2] else np.array([0.0])
    return Least(float(sigmas[where]), float(grid[where]), float(np.min(own)))


def _numbers(fixed: dict[int, NDArray[np.float64]]) -> dict[int, DoubleDouble]:
    return {index: DoubleDouble.of(values) for index, values in fixed.items()}


def singular_values() -> ExtremeTable:
    """Every joint, form and set of rows."""
    rows: list[tuple[Cell, ...]] = []
    for variant in rank_variants():
        least = least_singular_value(variant)
        rows.append((variant.file_stem, least.sigma, least.angle))
    return ExtremeTable(
        "rank",
        "Smallest singular value of phi_q over a turn, unit geometry, closed joint",
        ("variant", "sigma", "at angle"),
        tuple(rows),
        ("rot3 with its middle angle at 1.2 rad; sigma = 0 is a lost row.",),
    )


def gimbal_lock() -> ExtremeTable:
    """The ball joint towards its gimbal lock, by angles and by Euler parameters."""
    rows: list[tuple[Cell, ...]] = []
    for rows_name in ("regular", "table4", "quaternion"):
        variant = Variant("ball", "parametric", rows_name)
        found = [least_singular_value(variant, math.pi / 2 - gap) for gap in GIMBAL]
        rows.append((variant.file_stem, "all columns", *(least.sigma for least in found)))
        rows.append((variant.file_stem, "columns of alpha", *(least.of_coordinates for least in found)))
    return ExtremeTable(
        "gimbal",
        "Smallest singular value of phi_q of the ball joint near a2 = pi/2",
        ("variant", "of", *(f"pi/2 - {gap:.0e}" for gap in GIMBAL)),
        tuple(rows),
        (
            "regular rows keep their rank; at gimbal lock a1 and a3 turn about one axis, and alpha is lost as a",
            "coordinate. Euler parameters go through it.",
        ),
    )
