"""Try to move a mechanism: other consistent poses, and which infinitesimal motions can be followed.

A direction in the null space of ``phi_q`` is a motion only if a finite step along it, brought back onto the
constraints, arrives somewhere else. A shaky structure comes back to where it was.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from codegen.measure.assembly import project
from codegen.measure.constraints import Array, ConstraintSystem, Pose, Scales
from codegen.measure.gaps import turned_over
from codegen.measure.rank import null_space

POSES = 6
"""Consistent poses that are looked for beside the given one."""

STEPS = (0.4, 0.2, 0.1, 0.05)
"""Lengths of a step that are tried, of its largest component: rad, or characteristic lengths."""

_ATTEMPTS = 3 * POSES

_FRUITLESS = 3
"""Attempts without success after which a mechanism is taken not to move."""

_SEED = 1

_DIRECTIONS = 3
"""Random directions that are probed."""

_PROBE = 0.005
"""Length of a step that tells finite from infinitesimal motion."""

_STRIDE = 0.2
"""Length of a step that tells whether rows are implied."""

_LOST = 0.03
"""Part of a probing step that may be lost to the curvature of the motion."""

_FOLLOWED = 0.3
"""Part of a probing step that is left of it, from which the direction counts as followed."""

_IMPLIED = 1e-8
"""A row without dimension that stays below this while the mechanism moves is implied by the others."""


def consistent_poses(system: ConstraintSystem, start: Pose, units: Scales) -> tuple[Pose, ...]:
    """Walk to other poses of a connected mechanism, in random directions that are the same in every run.

    Returns:
        The given pose first, then up to `POSES` others; none where the mechanism does not move.
    """
    generator = np.random.default_rng(_SEED)
    found = [start]
    origin = start
    for attempt in range(_ATTEMPTS):
        if len(found) > POSES or (attempt >= _FRUITLESS and len(found) == 1):
            break
        direction = _random_direction(system, origin, units, generator)
        following = None if direction is None else _walked(system, origin, units, direction)
        if following is not None:
            found.append(following)
        origin = start if following is None else following
    return tuple(found)


def walk(system: ConstraintSystem, start: Pose, units: Scales, side: float, count: int) -> Iterator[Pose]:
    """Walk straight on from a pose: each step goes on along the one before.

    Args:
        system: a connected mechanism.
        start: on the constraints.
        units: of rows and columns.
        side: 1 or -1, to which side the first step goes.
        count: most poses; fewer where the way ends.
    """
    pose, heading = start, side * np.random.default_rng(_SEED).normal(size=system.column_count)
    for _ in range(count):
        basis = null_space(units.values(system, pose)[1])
        direction = basis @ (basis.T @ heading)
        largest = float(np.max(np.abs(direction), initial=0.0))
        following = _walked(system, pose, units, direction / largest) if largest else None
        if following is None:
            return
        heading = pose.step_to(following) / units.columns
        pose = following
        yield pose


def _random_direction(
    system: ConstraintSystem, pose: Pose, units: Scales, generator: np.random.Generator
) -> Array | None:
    """Null-space part of a random vector, largest component 1: it does not depend on the basis."""
    basis = null_space(units.values(system, pose)[1])
    direction = basis @ (basis.T @ generator.normal(size=len(basis)))
    largest = float(np.max(np.abs(direction), initial=0.0))
    return direction / largest if basis.shape[1] and largest else None


def _walked(system: ConstraintSystem, pose: Pose, units: Scales, direction: Array) -> Pose | None:
    """Take the longest step that arrives about as far away as it went; None if none does."""
    for size in STEPS:
        found = project(system, pose.moved(size * direction * units.columns), units)
        travelled = float(np.max(np.abs(pose.step_to(found.pose) / units.columns), initial=0.0))
        is_near = size / 4 <= travelled <= 2.5 * size
        if found.is_closed and is_near and not turned_over(system, found.pose):
            return found.pose
    return None


def finite_freedoms(system: ConstraintSystem, pose: Pose, units: Scales) -> int:
    """Count the independent directions in which a mechanism can be moved at a regular pose.

    Random directions have a part along every other; if they can be followed, all can. Else each is tried alone.
    """
    basis = null_space(units.values(system, pose)[1])
    count = int(basis.shape[1])
    some = _random_directions(count)
    lost = (float(np.linalg.norm(_followed(system, pose, units, basis, part) - part)) for part in some)
    if all(part <= _LOST for part in lost):
        return count
    arrivals = [_followed(system, pose, units, basis, part) for part in np.eye(count)]
    return int(np.sum(np.linalg.svd(np.array(arrivals), compute_uv=False) > _FOLLOWED))


def _random_directions(count: int) -> Array:
    """A few directions of length 1 in a null space, [k, count]."""
    some = np.random.default_rng(_SEED).normal(size=(min(_DIRECTIONS, count), count))
    return np.asarray(some / np.linalg.norm(some, axis=1, keepdims=True))


def _followed(system: ConstraintSystem, pose: Pose, units: Scales, basis: Array, part: Array) -> Array:
    """What is left, in parts of its length and in the basis, of a short step once it is back on the constraints."""
    found = project(system, pose.moved(_PROBE * (basis @ part) * units.columns), units)
    travel = pose.step_to(found.pose) / units.columns
    return np.asarray(basis.T @ travel / _PROBE) if found.is_closed else np.zeros(len(part))


def implied_rows(system: ConstraintSystem, pose: Pose, units: Scales, kept: tuple[int, ...]) -> tuple[int, ...]:
    """Say which of the other rows stay met while the mechanism moves, here and there, under the kept ones alone."""
    others = [row for row in range(system.row_count) if row not in kept]
    if not others:
        return ()
    basis = null_space(units.values(system, pose)[1])
    largest = np.zeros(len(others))
    for part in _random_directions(basis.shape[1]):
        found = project(system, pose.moved(_STRIDE * (basis @ part) * units.columns), units, rows=list(kept))
        if found.is_closed:
            largest = np.maximum(largest, np.abs(system.phi(found.pose) / units.rows)[others])
    return tuple(row for row, value in zip(others, largest, strict=True) if value <= _IMPLIED)
