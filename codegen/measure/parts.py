"""Connected parts of a mechanism: bodies that joints tie together, the ground cut. Each is analysed alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from codegen.measure.constraints import Array, ConstraintSystem, Frame, Pose, scales

_DIGITS = 9
"""Digits, of the characteristic length, to which equal parts agree."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A connected part.

    Attributes:
        system: the part as a mechanism of its own.
        bodies: positions of its bodies in the whole.
        coordinates: positions of its joint coordinates in the whole.
        joints: positions of its joints in the whole.
    """

    system: ConstraintSystem
    bodies: tuple[int, ...]
    coordinates: tuple[int, ...]
    joints: tuple[int, ...]

    def pose(self, pose: Pose) -> Pose:
        """Take the pose of the part out of that of the whole."""
        bodies, coordinates = list(self.bodies), list(self.coordinates)
        return Pose(pose.r[bodies], pose.A[bodies], pose.alpha[coordinates])

    def columns(self, body_count: int) -> list[int]:
        """Columns of the part in the Jacobian of a whole with that many bodies."""
        bodies = [6 * body + k for body in self.bodies for k in range(6)]
        return bodies + [6 * body_count + k for k in self.coordinates]


def parts(system: ConstraintSystem) -> tuple[Part, ...]:
    """Split a mechanism, in the order of its bodies; a joint between ground and ground is a part without bodies."""
    count = len(system.bodies)
    ties = [joint.bodies for joint in system.joints if None not in joint.bodies]
    i, j = (np.array([tie[k] for tie in ties], dtype=int) for k in range(2))
    graph = coo_matrix((np.ones(len(ties)), (i, j)), shape=(count, count))
    labels = connected_components(graph, directed=False)[1].tolist() if count else []
    bodies: dict[int, list[int]] = {}
    for body, label in enumerate(labels):
        bodies.setdefault(label, []).append(body)
    joints: dict[int, list[int]] = {label: [] for label in bodies}
    for position, joint in enumerate(system.joints):
        moving = [body for body in joint.bodies if body is not None]
        label = labels[moving[0]] if moving else -1 - position
        joints.setdefault(label, []).append(position)
    ranges = system.coordinate_ranges()
    return tuple(_part(system, ranges, bodies.get(label, []), joints[label]) for label in joints)


def _part(system: ConstraintSystem, ranges: Sequence[range], bodies: list[int], joints: list[int]) -> Part:
    place: dict[int | None, int | None] = {None: None} | {body: k for k, body in enumerate(bodies)}
    start = 6 * len(system.bodies)
    own = [system.joints[position] for position in joints]
    renumbered = tuple(replace(joint, bodies=(place[joint.bodies[0]], place[joint.bodies[1]])) for joint in own)
    return Part(
        ConstraintSystem(tuple(system.bodies[body] for body in bodies), renumbered),
        tuple(bodies),
        tuple(column - start for position in joints for column in ranges[position]),
        tuple(joints),
    )


def likeness(system: ConstraintSystem, pose: Pose) -> object:
    """Give a key that is equal for two parts that differ in names and by a translation only."""
    length = scales(system).length
    origin = pose.r[0] if len(pose.r) else np.zeros(3)
    joints = tuple(
        (
            *(joint.type, joint.bodies, joint.rows, joint.coordinates, joint.parameters),
            *(
                _rounded(_from(frame, origin if body is None else np.zeros(3)), length)
                for body, frame in zip(joint.bodies, joint.frames, strict=True)
            ),
        )
        for joint in system.joints
    )
    bodies = np.concatenate([(pose.r - origin).ravel() / length, pose.A.ravel(), pose.alpha])
    return len(system.bodies), joints, _rounded(bodies)


def _from(frame: Frame, origin: Array) -> Array:
    return np.concatenate([frame.s - origin, frame.C.ravel()])


def _rounded(values: Array, length: float = 1.0) -> bytes:
    scaled = np.concatenate([values[:3] / length, values[3:]])
    return (np.round(scaled, _DIGITS) + 0.0).tobytes()
