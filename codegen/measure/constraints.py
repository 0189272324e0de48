"""The constraints of a mechanism as numbers: joints that evaluate themselves, bodies in a pose, connected parts.

Input: joints with their routines and joint frames. Output: ``phi`` and ``phi_q`` of the whole at a pose. Columns: for
each body ``delta r`` (world, m) and ``delta pi`` (body axes, rad), SPEC S0, then the joint coordinates (m or rad).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from codegen.measure.attitudes import turned, turns

Array = NDArray[np.float64]

Evaluate = Callable[[Array, Array, Array, Array, Array], tuple[Array, Array]]
"""``(r_i, A_i, r_j, A_j, alpha)`` to ``phi`` [m] and ``phi_q`` [m, 12 + n]: ``delta r_i`` world, ``delta pi_i`` body
axes, ``delta r_j``, ``delta pi_j``, ``delta alpha``. The ground has ``r = 0`` and ``A = I``."""


@dataclass(frozen=True, slots=True)
class Row:
    """A constraint row.

    Attributes:
        name: for readers, such as ``x of the point`` or ``f_i . h_j``.
        unit: ``m`` or ``1``.
    """

    name: str
    unit: str


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A joint frame on a body: ``s`` [3] m and ``C = [f g h]`` [3, 3], body axes."""

    s: Array
    C: Array


@dataclass(frozen=True, slots=True, eq=False)
class JointConstraint:
    """A joint that can be evaluated.

    Attributes:
        name: unique in the mechanism.
        type: one of `codegen.spec.scene.SCENE_JOINTS`.
        bodies: positions of body i and body j in the mechanism; None is the ground.
        rows: of ``phi``.
        coordinates: units of the joint coordinates, ``m`` or ``rad``; none in the conventional form.
        frames: on body i and on body j, as `codegen.spec.scene.Joint` has them.
        evaluate: the routine.
        parameters: whatever else the routine depends on; two joints that agree in all but name, bodies and ``evaluate``
            are taken for equal.
    """

    name: str
    type: str
    bodies: tuple[int | None, int | None]
    rows: tuple[Row, ...]
    coordinates: tuple[str, ...]
    frames: tuple[Frame, Frame]
    evaluate: Evaluate
    parameters: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A pose of all bodies.

    Attributes:
        r: [nb, 3] m, world.
        A: [nb, 3, 3] body to world.
        alpha: [na] joint coordinates in the order of the joints, m or rad.
    """

    r: Array
    A: Array
    alpha: Array

    def body(self, index: int | None) -> tuple[Array, Array]:
        """Give ``r`` and ``A`` of a body; None is the ground."""
        return (np.zeros(3), np.eye(3)) if index is None else (self.r[index], self.A[index])

    def moved(self, step: Array) -> Pose:
        """Take a step [6 nb + na] in the columns of ``phi_q``; rotations by the exponential map."""
        bodies = step[: 6 * len(self.r)].reshape(-1, 6)
        alpha = self.alpha + step[6 * len(self.r) :]
        return Pose(self.r + bodies[:, :3], turned(self.A, bodies[:, 3:]), alpha)

    def step_to(self, other: Pose) -> Array:
        """Give the step [6 nb + na] that leads to another pose: the inverse of `moved`."""
        bodies = np.hstack([other.r - self.r, turns(self.A, other.A)])
        return np.concatenate([bodies.ravel(), other.alpha - self.alpha])


@dataclass(frozen=True, slots=True, eq=False)
class ConstraintSystem:
    """A mechanism, or a connected part of one: names of the bodies that move, and the joints."""

    bodies: tuple[str, ...]
    joints: tuple[JointConstraint, ...]

    @property
    def row_count(self) -> int:
        """Number of rows."""
        return sum(len(joint.rows) for joint in self.joints)

    @property
    def column_count(self) -> int:
        """Number of columns, 6 a body and one a joint coordinate."""
        return 6 * len(self.bodies) + sum(len(joint.coordinates) for joint in self.joints)

    def row_labels(self) -> tuple[tuple[str, str], ...]:
        """Give joint and name of each row."""
        return tuple((joint.name, row.name) for joint in self.joints for row in joint.rows)

    def row_ranges(self) -> tuple[range, ...]:
        """Give the rows of each joint."""
        return _ranges([len(joint.rows) for joint in self.joints], 0)

    def coordinate_ranges(self) -> tuple[range, ...]:
        """Give the columns of each joint's coordinates."""
        return _ranges([len(joint.coordinates) for joint in self.joints], 6 * len(self.bodies))

    def values(self, pose: Pose) -> tuple[Array, Array]:
        """Evaluate ``phi`` [m] and ``phi_q`` [m, 6 nb + na]."""
        phi = np.zeros(self.row_count)
        phi_q = np.zeros((self.row_count, self.column_count))
        columns = self.coordinate_ranges()
        for joint, rows, alphas in zip(self.joints, self.row_ranges(), columns, strict=True):
            own, block = self._joint_values(joint, alphas, pose)
            phi[rows.start : rows.stop] = own
            for body, part in zip(joint.bodies, (block[:, :6], block[:, 6:12]), strict=True):
                if body is not None:
                    phi_q[rows.start : rows.stop, 6 * body : 6 * body + 6] += part
            phi_q[rows.start : rows.stop, alphas.start : alphas.stop] = block[:, 12:]
        return phi, phi_q

    def phi(self, pose: Pose) -> Array:
        """Evaluate the constraints, [m]."""
        columns = self.coordinate_ranges()
        own = [self._joint_values(joint, part, pose)[0] for joint, part in zip(self.joints, columns, strict=True)]
        return np.concatenate(own) if own else np.zeros(0)

    def phi_q(self, pose: Pose) -> Array:
        """Evaluate the Jacobian, [m, 6 nb + na]."""
        return self.values(pose)[1]

    def _joint_values(self, joint: JointConstraint, columns: range, pose: Pose) -> tuple[Array, Array]:
        start = 6 * len(self.bodies)
        i, j = joint.bodies
        return joint.evaluate(*pose.body(i), *pose.body(j), pose.alpha[columns.start - start : columns.stop - start])


def _ranges(counts: Sequence[int], start: int) -> tuple[range, ...]:
    ends = np.cumsum([start, *counts]).tolist()
    return tuple(range(a, b) for a, b in pairwise(ends))


@dataclass(frozen=True, slots=True, eq=False)
class Scales:
    """Units in which metres and radians compare: lengths by the characteristic length of the mechanism.

    Attributes:
        length: m.
        rows: [m] unit of each row.
        columns: [6 nb + na] unit of each column.
    """

    length: float
    rows: Array
    columns: Array

    def values(self, system: ConstraintSystem, pose: Pose) -> tuple[Array, Array]:
        """Evaluate ``phi`` and ``phi_q`` without dimension."""
        phi, phi_q = system.values(pose)
        return phi / self.rows, phi_q / self.rows[:, None] * self.columns


def scales(system: ConstraintSystem) -> Scales:
    """Choose the units of a mechanism; see `characteristic_length`."""
    length = characteristic_length(system)
    units = [row.unit for joint in system.joints for row in joint.rows]
    body = [length] * 3 + [1.0] * 3
    coordinates = [length if unit == "m" else 1.0 for joint in system.joints for unit in joint.coordinates]
    rows = np.array([length if unit == "m" else 1.0 for unit in units])
    return Scales(length, rows, np.array(body * len(system.bodies) + coordinates))


def characteristic_length(system: ConstraintSystem) -> float:
    """Mean distance of the joints from the reference points of their bodies, m.

    Where all of them are 0 the largest distance between joints on the ground is taken, and 1 m where that is 0 too.
    """
    ends = [(body, frame.s) for joint in system.joints for body, frame in zip(joint.bodies, joint.frames, strict=True)]
    arms = [float(np.linalg.norm(s)) for body, s in ends if body is not None]
    long = [arm for arm in arms if arm > 1e-6 * max(arms)]
    if long:
        return float(np.mean(long))
    fixed = [s for body, s in ends if body is None]
    spread = max((float(np.linalg.norm(s - fixed[0])) for s in fixed), default=0.0)
    return spread or 1.0
