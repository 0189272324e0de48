"""Poses of a platform file: the attitude is checked, then a `PlatformPose` is made."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from codegen.errors import Mistake
from codegen.spec.placement import IDENTITY, dot, rotation
from codegen.spec.platform import PlatformPose
from codegen.spec.platform_file.entries import PoseEntry
from codegen.spec.pose import product
from codegen.spec.scene import Matrix, Quaternion, Vector
from codegen.spec.scene_file.text import shown

TOLERANCE = Fraction(1, 10**9)
"""Of norms and right angles: what the last digits of a file may leave."""

_WAYS = ("quaternion", "rotation", "euler")


def pose_mistakes(entry: PoseEntry) -> Iterator[Mistake]:
    """Check one pose by itself."""
    given = [way for way in _WAYS if way in entry.given]
    if len(given) > 1:
        yield Mistake(entry.place, f"has {' and '.join(given)}", "give the attitude in one way")
    if ("angles" in entry.given) != ("euler" in entry.given):
        missing = "euler" if "angles" in entry.given else "angles"
        yield Mistake(entry.place, f"has no {missing}", "give euler (the order) and angles (in rad) together")
    if entry.quaternion is not None:
        norm = dot(entry.quaternion, entry.quaternion)
        if abs(norm - 1) > 2 * TOLERANCE:
            remedy = "divide it by its norm" if norm else "the identity is [1, 0, 0, 0]"
            yield Mistake(f"{entry.place}: quaternion", f"has the squared norm {shown(norm)}", remedy)
    if entry.rotation is not None:
        yield from rotation_mistakes(entry.rotation, f"{entry.place}: rotation")


def rotation_mistakes(matrix: Matrix, place: str) -> Iterator[Mistake]:
    """Check that a matrix is a rotation within the last digits of a file."""
    gap = max(abs(dot(matrix[i], matrix[k]) - IDENTITY[i][k]) for i in range(3) for k in range(3))
    if gap > 2 * TOLERANCE:
        what = f"is not orthonormal: R R^T differs from the identity by {shown(gap)}"
        yield Mistake(place, what, "give more digits, or a quaternion")
    elif _determinant(matrix) < 0:
        yield Mistake(place, "is a reflection: its determinant is -1", "give three rows of a right-handed frame")


def make_pose(entry: PoseEntry, unit: Fraction) -> PlatformPose | None:
    """Make a pose in m; None where it cannot be read."""
    if entry.position is None or entry.wrong:
        return None
    x, y, z = entry.position
    return PlatformPose((x * unit, y * unit, z * unit), _attitude(entry))


def euler_rotation(order: str, angles: Vector) -> Matrix:
    """Rotation matrix of Euler angles, platform to base; quarter turns are exact.

    Args:
        order: of `codegen.spec.platform.EULER_ORDERS`.
        angles: rad, in its order.
    """
    turned: Quaternion = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
    for axis, angle in zip(order, angles, strict=True):
        turn = _turn("XYZ".index(axis.upper()), float(angle))
        turned = product(turned, turn) if order.isupper() else product(turn, turned)
    return rotation(turned)


def _attitude(entry: PoseEntry) -> Matrix:
    if entry.quaternion is not None and any(entry.quaternion):
        return rotation(entry.quaternion)
    if entry.rotation is not None:
        return entry.rotation
    if entry.euler is not None and entry.angles is not None:
        return euler_rotation(entry.euler, entry.angles)
    return IDENTITY


def _turn(axis: int, angle: float) -> Quaternion:
    quarters = round(angle / (math.pi / 2))
    cosine, sine = Fraction(math.cos(angle / 2)), Fraction(math.sin(angle / 2))
    if abs(angle - quarters * (math.pi / 2)) < 1e-15 * max(1.0, abs(angle)):
        cosine, sine = [(Fraction(c), Fraction(s)) for c, s in ((1, 0), (1, 1), (0, 1), (1, -1))][quarters % 4]
    parts = [cosine, Fraction(0), Fraction(0), Fraction(0)]
    parts[1 + axis] = sine
    return parts[0], parts[1], parts[2], parts[3]


def _determinant(matrix: Matrix) -> Fraction:
    a, b, c = matrix
    return dot(a, (b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]))
