"""Planar mechanisms in a plane anywhere in space, with poses that close exactly.

A parallelogram of two cranks and a coupler, with a slider in a guide that a rod of the crank's length drives, and a pad
that lies on the ground. At the angle theta of the cranks the rod stands at -theta and the slider at ``2 l cos theta``.
Bodies lie at different heights along the normal, and each has axes of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction as F
from typing import Any

import numpy as np

from codegen.spec.scene import GROUND, Body, Force, Joint, Marker, Quaternion, Scene, Spring, Torque, Vector
from tests.lower.numbers import Numbers, skew

from .mechanisms import as_matrix

L, WIDTH = F(1, 2), F(3, 4)
HEIGHTS = {"crank": F(1, 4), "coupler": F(1, 2), "rocker": F(-1, 4), "rod": F(1, 3), "slider": F(0), "pad": F(1, 5)}
START = (F(3, 5), F(4, 5))
"""Cosine and sine of half the angle of the crank at t = 0."""

ORIGIN = np.array([F(1, 3), F(-2), F(1, 7)], dtype=object)
"""Of the mechanism in the world."""

UPRIGHT: Quaternion = (F(1), F(0), F(0), F(0))
SKEW: Quaternion = (F(2, 5), F(1, 5), F(2, 5), F(4, 5))
AXES = {
    "along z": UPRIGHT,
    "along x": (F(1, 2), F(1, 2), F(1, 2), F(1, 2)),
    "along y": (F(1, 2), F(-1, 2), F(-1, 2), F(-1, 2)),
    "against z": (F(0), F(1), F(0), F(0)),
    "skew": SKEW,
}
"""Normal of the plane -> attitude of the plane in the world."""


def matrix(quaternion: Quaternion) -> Numbers:
    """Rotation of a unit quaternion."""
    w, *vector = quaternion
    tilde = skew(vector)
    return np.eye(3, dtype=object) * F(1) + 2 * w * tilde + 2 * tilde @ tilde


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Of two quaternions."""
    (p, *u), (q, *v) = a, b
    x, y, z = p * np.array(v) + q * np.array(u) + skew(u) @ np.array(v)
    return (p * q - np.dot(u, v), x, y, z)


@dataclass(frozen=True)
class Linkage:
    """The mechanism in a plane, with bodies whose axes are turned against it.

    Attributes:
        plane: attitude of the plane.
        own: attitude of the plane seen from each body, at the angle 0.
    """

    plane: Quaternion
    own: dict[str, Quaternion]

    def flat_pose(self, half: Sequence[F]) -> dict[str, tuple[Numbers, Quaternion]]:
        """Position in the plane and turn of each body, by cosine and sine of half the angle of the crank."""
        c, s = half[0] ** 2 - half[1] ** 2, 2 * half[0] * half[1]
        turn, back = (half[0], F(0), F(0), half[1]), (half[0], F(0), F(0), -half[1])
        places = {
            "crank": ((L * c / 2, L * s / 2), turn),
            "coupler": ((L * c + WIDTH / 2, L * s), UPRIGHT),
            "rocker": ((WIDTH + L * c / 3, L * s / 3), turn),
            "rod": ((L * c * F(3, 2), L * s / 2), back),
            "slider": ((2 * L * c, F(0)), UPRIGHT),
            "pad": ((c, s), (half[1], F(0), F(0), half[0])),
        }
        return {name: (np.array([*xy, HEIGHTS[name]], dtype=object), q) for name, (xy, q) in places.items()}

    def pose(self, half: Sequence[F]) -> dict[str, tuple[Numbers, Quaternion]]:
        """Position and attitude of each body in the world."""
        plane = matrix(self.plane)
        return {
            name: (ORIGIN + plane @ r, product(self.plane, product(q, self.own[name])))
            for name, (r, q) in self.flat_pose(half).items()
        }

    def scene(self) -> Scene:
        """The mechanism as it stands at t = 0."""
        pose = self.pose(START)
        bodies = tuple(
            Body(name, F(1), as_matrix(np.diag([F(1), F(2), F(4)])), _three(r), q) for name, (r, q) in pose.items()
        )
        c, s = START[0] ** 2 - START[1] ** 2, 2 * START[0] * START[1]
        joints = (
            self._joint("main", "revolute", (GROUND, "crank"), (0, 0, 0), 0),
            self._joint("far main", "revolute", ("rocker", GROUND), (WIDTH, 0, F(1, 2)), 0),
            self._joint("pin", "revolute", ("crank", "coupler"), (L * c, L * s, 1), 1),
            self._joint("far pin", "revolute", ("coupler", "rocker"), (WIDTH + L * c, L * s, 0), 2),
            self._joint("big end", "revolute", ("rod", "crank"), (L * c, L * s, 0), 0),
            self._joint("small end", "revolute", ("rod", "slider"), (2 * L * c, 0, F(2, 5)), 3),
            self._joint("guide", "translational", (GROUND, "slider"), (2 * L * c, 0, F(1, 5)), 4),
            self._joint("floor", "planar", ("pad", GROUND), (1, 1, 1), 0),
        )
        spring = Spring((GROUND, "slider"), ((F(1), F(2), F(3)), (F(0), F(1, 4), F(1, 4))), F(1), F(0), F(1))
        gravity = _three(matrix(self.plane) @ np.array([F(1), F(-2), F(3)], dtype=object))
        load = Torque("rod", (F(1), F(2), F(3)))
        push = Force("coupler", (F(3), F(-1), F(2)), (F(1, 2), F(1, 3), F(1, 5)))
        return Scene("linkage", gravity, bodies, joints, (spring,), (load,), forces=(push,))

    def _joint(self, name: str, type_: str, bodies: tuple[str, str], point: Sequence[Any], turn: int) -> Joint:
        plane = matrix(self.plane)
        turned = matrix((F(4, 5), F(0), F(0), F(3, 5))) if turn % 2 else np.eye(3, dtype=object) * F(1)
        axes = plane @ (
            np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]], dtype=object) if turn == 4 else np.eye(3, dtype=object)
        )
        pose = self.pose(START) | {GROUND: (np.zeros(3, dtype=object), UPRIGHT)}
        markers = []
        for body in bodies:
            r, q = pose[body]
            A = matrix(q)
            s = A.T @ (ORIGIN + plane @ np.array(point, dtype=object) - r)
            markers.append(Marker(_three(s), as_matrix(A.T @ axes @ turned)))
        return Joint(name, type_, bodies, *markers)


def _three(values: Any) -> Vector:
    x, y, z = (F(value) for value in values)
    return x, y, z


def linkage(plane: str, is_skew: bool) -> Linkage:
    """Give the mechanism in one of `AXES`, its bodies with axes along the plane's, or askew."""
    turns = [UPRIGHT, AXES["along x"], AXES["along y"], AXES["against z"], (F(1, 2), F(1, 2), F(-1, 2), F(1, 2))]
    names = list(HEIGHTS)
    own = {name: SKEW if is_skew else turns[k % len(turns)] for k, name in enumerate(names)}
    return Linkage(AXES[plane], own)
