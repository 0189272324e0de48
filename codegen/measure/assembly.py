"""Bring a mechanism together: the pose nearby, and the velocities nearby, that satisfy the constraints.

A damped Gauss-Newton method. Each step is the least change, in the given weights, that closes the linearised
constraints; rotations move on SO(3). The damping falls with the square of the gap, so that the end is quadratic also
where rows are redundant. It ends when both the residual and the step are small: one alone may end at no solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from codegen.measure.constraints import Array, ConstraintSystem, JointConstraint, Pose, Scales, scales
from codegen.measure.parts import parts
from codegen.measure.rank import TOLERANCE

LARGEST_STEP = 0.5
"""Of any angle in rad, and of any length in characteristic lengths."""

RESIDUAL = 1e-12
"""Constraints without dimension are met below this, times the distance from the origin where that is large."""

SETTLED = 1e-9
"""A step without dimension below this is none."""

_FLOOR = 1e-14
"""Least damping: directions that rounding alone moves stay where they are."""

_ITERATIONS = 100

_STUCK = 0.9
"""A step that is settled and leaves more than this part of the residual leads nowhere."""

_LARGEST_DAMPING = 1e12

_ALIGNED = ("revolute", "translational", "screw", "cylindrical", "planar", "rigid")
"""Joints whose axes h on both bodies point the same way; their rows are met too where they point opposite ways."""


@dataclass(frozen=True, slots=True)
class Gap:
    """How far a joint is open: ``length`` in m, ``angle`` in rad."""

    joint: str
    length: float
    angle: float

    def __str__(self) -> str:
        return f'joint "{self.joint}": open by {1e3 * self.length:.4g} mm and {np.degrees(self.angle):.4g} degrees'


@dataclass(frozen=True, slots=True, eq=False)
class Projection:
    """Result of one projection.

    Attributes:
        pose: the last pose, with the least residual found.
        iterations: steps tried.
        is_closed: whether the constraints are met there.
    """

    pose: Pose
    iterations: int
    is_closed: bool


@dataclass(frozen=True, slots=True, eq=False)
class Assembly:
    """A mechanism brought together, or as near as it comes.

    Attributes:
        pose: the pose; the given one, bit for bit, where it meets the constraints.
        is_closed: whether all joints are closed and none is turned over.
        iterations: steps tried, of the part that took most.
        before: gaps of all joints in the given pose.
        after: gaps of all joints in the pose found.
        open_joints: those of ``after`` that are not closed.
    """

    pose: Pose
    is_closed: bool
    iterations: int
    before: tuple[Gap, ...]
    after: tuple[Gap, ...]
    open_joints: tuple[Gap, ...]


def assemble(system: ConstraintSystem, pose: Pose, weights: Array | None = None) -> Assembly:
    """Find the pose nearby in which all joints are closed.

    Args:
        system: the mechanism.
        pose: where to start.
        weights: [6 nb + na] of the squares of the changes, such as masses and principal moments of inertia; by default
            an angle weighs as much as a displacement by its lever, the characteristic length.
    """
    r, A, alpha = pose.r.copy(), pose.A.copy(), pose.alpha.copy()
    iterations, opened = 0, []
    for part in parts(system):
        own = None if weights is None else weights[part.columns(len(system.bodies))]
        start = part.pose(pose)
        units = scales(part.system)
        found = project(part.system, start, units, own)
        bodies, coordinates = list(part.bodies), list(part.coordinates)
        r[bodies], A[bodies], alpha[coordinates] = found.pose.r, found.pose.A, found.pose.alpha
        iterations = max(iterations, found.iterations)
        is_open = not found.is_closed or bool(turned_over(part.system, found.pose))
        least = 10 * tolerance(found.pose, units)
        opened += [gap.joint for gap in gaps(part.system, found.pose) if is_open and not _closes(gap, units, least)]
    pose_found = Pose(r, A, alpha)
    after = gaps(system, pose_found)
    named = tuple(gap for gap in after if gap.joint in opened)
    return Assembly(pose_found, not named, iterations, gaps(system, pose), after, named)


def _closes(gap: Gap, units: Scales, least: float) -> bool:
    return gap.length <= least * units.length and gap.angle <= least


def gaps(system: ConstraintSystem, pose: Pose) -> tuple[Gap, ...]:
    """Measure how far each joint is open; a joint that is turned over by half a turn is open by that angle."""
    phi = system.phi(pose)
    over = turned_over(system, pose)
    found = []
    for joint, rows in zip(system.joints, system.row_ranges(), strict=True):
        own = phi[rows.start : rows.stop]
        is_length = np.array([row.unit == "m" for row in joint.rows], dtype=bool)
        sine = min(1.0, float(np.linalg.norm(own[~is_length])))
        angle = float(np.arcsin(sine))
        length = float(np.linalg.norm(own[is_length]))
        found.append(Gap(joint.name, length, np.pi - angle if joint.name in over else angle))
    return tuple(found)


def turned_over(system: ConstraintSystem, pose: Pose) -> tuple[str, ...]:
    """Name the joints whose axes point opposite ways: a spurious root of their rows."""
    return tuple(joint.name for joint in system.joints if _is_turned_over(joint, pose))


def _is_turned_over(joint: JointConstraint, pose: Pose) -> bool:
    axes = [pose.body(body)[1] @ frame.C[:, 2] for body, frame in zip(joint.bodies, joint.frames, strict=True)]
    return joint.type in _ALIGNED and float(axes[0] @ axes[1]) < 0


def tolerance(pose: Pose, units: Scales) -> float:
    """Give the residual that counts as none; positions far from the origin round more coarsely."""
    return RESIDUAL * (1 + float(np.max(np.abs(pose.r), initial=0.0)) / units.length)


def project(
    system: ConstraintSystem,
    pose: Pose,
    units: Scales,
    weights: Array | None = None,
    rows: list[int] | None = None,
) -> Projection:
    """Move a connected mechanism onto its constraints.

    Args:
        system: the mechanism.
        pose: where to start; it is given back as it is if it meets the constraints.
        units: see `codegen.measure.constraints.scales`.
        weights: see `assemble`.
        rows: the rows to meet; all of them if left out.
    """
    chosen = list(range(system.row_count)) if rows is None else rows
    columns = _step_units(units, weights)
    factor = 1.0
    phi, phi_q = _scaled(system, pose, units, columns, chosen)
    for iteration in range(_ITERATIONS):
        size = float(np.linalg.norm(phi))
        step = _clamped(_damped_step(phi_q, phi, factor * max(size**2, _FLOOR)) * columns, units)
        is_settled = float(np.max(np.abs(step / units.columns), initial=0.0)) <= SETTLED
        is_met = size <= tolerance(pose, units)
        if (is_settled and is_met) or factor > _LARGEST_DAMPING:
            return Projection(pose, iteration, is_met)
        trial = pose.moved(step)
        values = _scaled(system, trial, units, columns, chosen)
        left = float(np.linalg.norm(values[0]))
        if is_settled and left > _STUCK * size:
            return Projection(pose, iteration, is_met)
        if is_met or left < size:
            pose, (phi, phi_q) = trial, values
            factor = max(1.0, factor / 10)
        else:
            factor *= 10
    return Projection(pose, _ITERATIONS, float(np.linalg.norm(phi)) <= tolerance(pose, units))


def _scaled(
    system: ConstraintSystem, pose: Pose, units: Scales, columns: Array, rows: list[int]
) -> tuple[Array, Array]:
    phi, phi_q = system.values(pose)
    return (phi / units.rows)[rows], (phi_q / units.rows[:, None] * columns)[rows]


def _step_units(units: Scales, weights: Array | None) -> Array:
    """Units in which the change is least: one over the root of the weights, as large as the default on the whole."""
    if weights is None or not len(weights):
        return units.columns
    own = 1 / np.sqrt(weights)
    return np.asarray(own * np.exp(np.mean(np.log(units.columns / own))))


def _damped_step(phi_q: Array, phi: Array, damping: float) -> Array:
    """Least ``step`` with ``phi_q step = - phi``, damped: singular values s act as s + damping / s."""
    if not phi_q.size:
        return np.zeros(phi_q.shape[1])
    U, sigma, Vt = scipy.linalg.svd(phi_q, full_matrices=False)
    return np.asarray(-Vt.T @ (sigma / (sigma**2 + damping) * (U.T @ phi)))


def _clamped(step: Array, units: Scales) -> Array:
    largest = float(np.max(np.abs(step / units.columns), initial=0.0))
    return step if largest <= LARGEST_STEP else step * (LARGEST_STEP / largest)


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
        steps = _step_units(units, None if weights is None else weights[columns])
        matrix = part.system.phi_q(part.pose(pose)) / units.rows[:, None] * steps
        if not matrix.size:
            continue
        own, target = velocity[columns] / steps, wanted[rows] / units.rows
        own = own + np.asarray(scipy.linalg.lstsq(matrix, target - matrix @ own, cond=TOLERANCE)[0])
        found[columns] = own * steps
        left = max(left, float(np.max(np.abs(matrix @ own - target))))
    return found, left
