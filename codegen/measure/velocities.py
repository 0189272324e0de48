"""Velocities nearby that satisfy the constraints."""

from __future__ import annotations

import numpy as np
import scipy.linalg

from codegen.measure.assembly import step_units
from codegen.measure.constraints import Array, ConstraintSystem, Pose, scales
from codegen.measure.parts import parts
from codegen.measure.rank import TOLERANCE
from codegen.measure.threads import one_thread


def project_velocity(
    system: ConstraintSystem,
    pose: Pose,
    velocity: Array,
    rate: Array | None = None,
    weights: Array | None = None,
) -> tuple[Array, float]:
    """Change velocities as little as possible so that ``phi_q velocity = rate``.

    Args:
        system: the mechanism.
        pose: consistent.
        velocity: [6 nb + na] in the columns of ``phi_q``.
        rate: [m] what prescribed motions ask for; 0 if left out.
        weights: see `assemble`.

    Returns:
        The velocities, and how much is left of ``phi_q velocity - rate`` (without dimension, largest): more than
        rounding where the mechanism cannot follow the prescribed motion.
    """
    found, left = velocity.copy(), 0.0
    wanted = np.zeros(system.row_count) if rate is None else rate
    ranges = system.row_ranges()
    for part in parts(system):
        columns = part.columns(len(system.bodies))
        rows = [row for position in part.joints for row in ranges[position]]
        units = scales(part.system)
        steps = step_units(units, None if weights is None else weights[columns])
        matrix = part.system.phi_q(part.pose(pose)) / units.rows[:, None] * steps
        if not matrix.size:
            continue
        own, target = velocity[columns] / steps, wanted[rows] / units.rows
        with one_thread():
            own = own + np.asarray(scipy.linalg.lstsq(matrix, target - matrix @ own, cond=TOLERANCE)[0])
        found[columns] = own * steps
        left = max(left, float(np.max(np.abs(matrix @ own - target))))
    return found, left
