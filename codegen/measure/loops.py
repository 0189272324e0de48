"""Closed loops of a mechanism, and the group in which the joints of a loop move.

All joints of a planar loop have parallel axes: its motion is in the group of plane motions, of dimension 3, and closing
the loop takes 3 conditions of 6. The other 3 rows are redundant whatever the dimensions are.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from codegen.measure.constraints import Array, ConstraintSystem, Pose
from codegen.measure.freedoms import placed, twists

_INDEPENDENT = 1e-6
"""Twists of length 1 are independent beyond this."""

_NAMES = {
    (1, 0): "one axis",
    (1, 1): "translation along one line",
    (2, 1): "one axis, along and about",
    (2, 2): "translations in a plane",
    (3, 0): "spherical motion",
    (3, 2): "plane motion",
    (3, 3): "translations",
    (4, 3): "translations and one axis of rotation",
}
"""Groups by their dimension and that of their translations."""


@dataclass(frozen=True, slots=True)
class Group:
    """A group of motions: its dimension, and its name where it has one."""

    dimension: int
    name: str


def loops(system: ConstraintSystem) -> tuple[tuple[int, ...], ...]:
    """Find independent loops of a connected mechanism, each as positions of its joints, in the order of the joints."""
    parents = _spanning_tree(system)
    tree = {joint for parent in parents.values() if parent for joint in parent[:1]}
    found = []
    for position, joint in enumerate(system.joints):
        if position not in tree:
            i, j = (_path(parents, body) for body in joint.bodies)
            found.append(tuple(sorted({position} | (i ^ j))))
    return tuple(found)


_Parents = dict[int | None, tuple[int, int | None] | None]
"""Body -> joint that leads to it and body it comes from; None at the root."""


def _spanning_tree(system: ConstraintSystem) -> _Parents:
    neighbours: dict[int | None, list[tuple[int, int | None]]] = {}
    for position, joint in enumerate(system.joints):
        i, j = joint.bodies
        neighbours.setdefault(i, []).append((position, j))
        neighbours.setdefault(j, []).append((position, i))
    root = None if None in neighbours else 0
    parents: _Parents = {root: None}
    queue: deque[int | None] = deque([root])
    while queue:
        body = queue.popleft()
        for position, other in neighbours.get(body, []):
            if other not in parents:
                parents[other] = (position, body)
                queue.append(other)
    return parents


def _path(parents: _Parents, body: int | None) -> set[int]:
    """Joints from a body to the root."""
    found: set[int] = set()
    step = parents[body]
    while step is not None:
        found.add(step[0])
        step = parents[step[1]]
    return found


def group(system: ConstraintSystem, pose: Pose, joints: Sequence[int], length: float) -> Group:
    """Find the smallest group that holds the motions of some joints: the algebra that their twists generate.

    Args:
        system: the mechanism.
        pose: a general one.
        joints: their positions.
        length: unit of length, m.
    """
    origin = placed(system.joints[joints[0]], pose).point
    own = [twists(system.joints[position], pose, origin, length) for position in joints]
    basis = _basis(np.vstack(own))
    while True:
        products = [_commutator(a, b) for a, b in combinations(basis, 2)]
        larger = _basis(np.vstack([basis, *products]))
        if len(larger) == len(basis):
            break
        basis = larger
    turning = int(np.sum(np.linalg.svd(basis[:, :3], compute_uv=False) > _INDEPENDENT)) if len(basis) else 0
    return Group(len(basis), _NAMES.get((len(basis), len(basis) - turning), ""))


def _commutator(a: Array, b: Array) -> Array:
    return np.concatenate([np.cross(a[:3], b[:3]), np.cross(a[:3], b[3:]) + np.cross(a[3:], b[:3])])


def _basis(vectors: Array) -> Array:
    """Orthonormal basis [d, 6] of the span of some twists."""
    if not len(vectors):
        return vectors
    _, sigma, rows = np.linalg.svd(vectors, full_matrices=False)
    return np.asarray(rows[sigma > _INDEPENDENT * max(sigma[0], 1e-300)])
