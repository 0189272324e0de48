"""Bring a mechanism together: the pose nearby that satisfies the constraints.

A damped Gauss-Newton method. Each step is the least change, in the given weights, that closes the linearised
constraints; rotations move on SO(3). The damping falls with the square of the gap, so that the end is quadratic also
where rows are redundant. It ends when both the residual and the step are small: one alone may end at no solution.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from codegen.measure.constraints import Array, ConstraintSystem, Pose, Scales, scales
from codegen.measure.gaps import Gap, gaps, turned_over
from codegen.measure.parts import parts
from codegen.measure.threads import one_thread

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

_OPEN = 1e-3
"""Of a part that does not close, joints are open that are open by this part of the largest gap."""


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
    iterations = 0
    opened: set[str] = set()
    for part in parts(system):
        own = None if weights is None else weights[part.columns(len(system.bodies))]
        units = scales(part.system)
        with one_thread():
            found = project(part.system, part.pose(pose), units, own)
        bodies, coordinates = list(part.bodies), list(part.coordinates)
        r[bodies], A[bodies], alpha[coordinates] = found.pose.r, found.pose.A, found.pose.alpha
        iterations = max(iterations, found.iterations)
        opened |= _open_joints(part.system, found, units)
    pose_found = Pose(r, A, alpha)
    after = gaps(system, pose_found)
    named = tuple(gap for gap in after if gap.joint in opened)
    return Assembly(pose_found, not named, iterations, gaps(system, pose), after, named)


def _open_joints(system: ConstraintSystem, found: Projection, units: Scales) -> set[str]:
    """Name the joints of a part that are open; none where it is closed and nothing is turned over."""
    if found.is_closed and not turned_over(system, found.pose):
        return set()
    sizes = {gap.joint: gap.length / units.length + gap.angle for gap in gaps(system, found.pose)}
    return {joint for joint, size in sizes.items() if size >= _OPEN * max(sizes.values())}


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
    columns = step_units(units, weights)
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


def step_units(units: Scales, weights: Array | None) -> Array:
    """Give the units [6 nb + na] in which the change is least: one over the root of the weights.

    On the whole they are as large as the default ones, which are those of the columns.
    """
    if weights is None or not len(weights):
        return units.columns
    own = 1 / np.sqrt(weights)
    return np.asarray(own * np.exp(np.mean(np.log(units.columns / own))))


def _damped_step(phi_q: Array, phi: Array, damping: float) -> Array:
    """Least ``step`` with ``phi_q step = - phi``, damped: ``- phi_q^T (phi_q phi_q^T + damping I)^-1 phi``, by QR."""
    if not phi_q.size:
        return np.zeros(phi_q.shape[1])
    Q, R = np.linalg.qr(np.vstack([phi_q.T, np.sqrt(damping) * np.eye(len(phi_q))]))
    return np.asarray(-Q[: phi_q.shape[1]] @ scipy.linalg.solve_triangular(R, phi, trans="T"))


def _clamped(step: Array, units: Scales) -> Array:
    largest = float(np.max(np.abs(step / units.columns), initial=0.0))
    return step if largest <= LARGEST_STEP else step * (LARGEST_STEP / largest)
