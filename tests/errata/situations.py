"""Poses at which the equations of S1 are judged: general joint frames, every number drawn once and for all.

The paper writes f'_i for a vector in body axes and f_i = A_i f'_i for the same vector in world axes.  Here s.f_i is
the primed vector and s.A_i @ s.f_i the other one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from random import Random

import numpy as np

from tests.reference.constraints import Geometry, Pose, alpha_size, pair
from tests.reference.derivatives import substitute
from tests.reference.rotations import from_euler_parameters
from tests.reference.scalars import Array

SEEDS = (1, 2, 3, 4, 5)
SMALLEST_ANGLE, LARGEST_ANGLE = 0.4, 2.7  # rad: away from 0 and pi, where Table 4 loses rank
LARGEST_PITCH_ANGLE = 1.2  # rad: rot3 loses a coordinate at pi / 2


@dataclass(frozen=True, slots=True, eq=False)
class Situation:
    """A pose with its joint and multipliers: lam_dot2 of Eq. (9), lam_trn [3] of (25), lam_rot [3] of (36)."""

    joint: str
    pose: Pose
    geometry: Geometry
    lam_dot2: float
    lam_trn: Array
    lam_rot: Array

    @property
    def A_i(self) -> Array:
        return self.pose.A_i

    @property
    def A_j(self) -> Array:
        return self.pose.A_j

    @property
    def C_i(self) -> Array:
        return self.geometry.C_i

    @property
    def C_j(self) -> Array:
        return self.geometry.C_j

    @property
    def s_i(self) -> Array:
        return self.geometry.s_i

    @property
    def s_j(self) -> Array:
        return self.geometry.s_j

    @property
    def f_i(self) -> Array:
        return self.C_i[:, 0]

    @property
    def g_i(self) -> Array:
        return self.C_i[:, 1]

    @property
    def h_i(self) -> Array:
        return self.C_i[:, 2]

    @property
    def f_j(self) -> Array:
        return self.C_j[:, 0]

    @property
    def g_j(self) -> Array:
        return self.C_j[:, 1]

    @property
    def h_j(self) -> Array:
        return self.C_j[:, 2]

    @property
    def offset(self) -> float:
        """alpha_1 of the cylindrical joint, m."""
        return float(self.pose.alpha[0])

    @property
    def angle(self) -> float:
        """The coordinate of rot1, rad: alpha_2 of the cylindrical joint; in every joint the last coordinate."""
        return float(self.pose.alpha[-1])


def numbers(random: Random, *shape: int) -> Array:
    """Uniform in [-1, 1]; `Random.random` promises the same stream on every machine and version."""
    return np.array([2 * random.random() - 1 for _ in range(int(np.prod(shape)))]).reshape(shape)


def rotation(random: Random) -> Array:
    """A general rotation [3x3]."""
    e = numbers(random, 4)
    return np.asarray(from_euler_parameters(e / np.linalg.norm(e)))


def coordinates(joint: str, random: Random) -> Array:
    """alpha [n]: lengths, then angles of either sign that are near neither 0 nor pi."""
    size = alpha_size(joint, "parametric")
    alpha = numbers(random, size)
    rotations = 1 if joint == "screw" else pair(joint)[1]
    for k in range(size - rotations, size):
        alpha[k] = np.sign(alpha[k]) * (SMALLEST_ANGLE + (LARGEST_ANGLE - SMALLEST_ANGLE) * abs(alpha[k]))
    if pair(joint)[1] == 3:
        alpha[-2] *= LARGEST_PITCH_ANGLE / LARGEST_ANGLE
    return alpha


def draw(joint: str, seed: int, *, consistent: bool = True) -> Situation:
    """One situation of a joint, on its constraint manifold or, with consistent=False, anywhere."""
    random = Random(seed)
    s_i, s_j = numbers(random, 3), numbers(random, 3)
    screw = (0.2, 0.3, 1.0) if joint == "screw" else (0.0, 0.0, 0.0)
    geometry = Geometry(s_i, rotation(random), s_j, rotation(random), *screw)
    pose = Pose(numbers(random, 3), rotation(random), numbers(random, 3), rotation(random), coordinates(joint, random))
    if consistent:
        pose = substitute(joint, "table4", pose, geometry)
    return Situation(joint, pose, geometry, float(numbers(random, 1)[0]), numbers(random, 3), numbers(random, 3))


@cache
def on_manifold(joint: str = "cylindrical") -> tuple[Situation, ...]:
    """Situations with phi = 0."""
    return tuple(draw(joint, seed) for seed in SEEDS)


@cache
def off_manifold(joint: str = "cylindrical") -> tuple[Situation, ...]:
    """Situations with phi of the order of 1."""
    return tuple(draw(joint, seed, consistent=False) for seed in SEEDS)


def with_alpha(s: Situation, alpha: Array) -> Situation:
    """The same bodies with body j put where these coordinates want it."""
    pose = replace(s.pose, alpha=np.asarray(alpha, dtype=float))
    return replace(s, pose=substitute(s.joint, "table4", pose, s.geometry))


@cache
def without_offset() -> tuple[Situation, ...]:
    """Cylindrical joint at alpha_1 = 0."""
    return tuple(with_alpha(s, np.array([0.0, s.angle])) for s in on_manifold())


@cache
def without_lever() -> tuple[Situation, ...]:
    """Cylindrical joint with s_i = 0."""
    centred = [replace(s, geometry=replace(s.geometry, s_i=np.zeros(3))) for s in on_manifold()]
    return tuple(with_alpha(s, s.pose.alpha) for s in centred)
