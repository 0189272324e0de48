"""Poses in exact rational arithmetic, and mass properties that are moved and put together by them.

Quaternions are of any length here, so that quarter turns and what is made of them stay small integers; a square root is
taken only where a scene asks for one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.placement import cross, dot, length, rotation, times, transposed
from codegen.spec.scene import ZERO_VECTOR, Matrix, Quaternion, Vector

_BITS = 2000
"""A number that is written with more is rounded to `_PLACES`: it comes from a long chain of turns by doubles."""

_PLACES: int = 10**40


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a frame is in another one.

    Attributes:
        position: [3] m, its origin.
        quaternion: w x y z of any length but 0, from its axes to those of the other.
    """

    position: Vector = ZERO_VECTOR
    quaternion: Quaternion = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))

    @property
    def attitude(self) -> Matrix:
        """[3, 3] rotation matrix, exactly orthonormal."""
        return rotation(self.quaternion)

    def point(self, local: Vector) -> Vector:
        """A point of this frame, in the other."""
        return plus(self.position, times(self.attitude, local))


@dataclass(frozen=True, slots=True)
class MassProperties:
    """Mass in kg, centre of mass [3] in m, inertia [3, 3] in kg m^2 about the centre of mass; in one frame."""

    mass: Fraction
    centre: Vector
    inertia: Matrix


def plus(a: Vector, b: Vector) -> Vector:
    """Sum of vectors."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scaled(a: Vector, factor: Fraction) -> Vector:
    """A vector times a number."""
    return (a[0] * factor, a[1] * factor, a[2] * factor)


def product(a: Quaternion, b: Quaternion) -> Quaternion:
    """The turn by ``b``, then by ``a``."""
    v, w = a[1:], b[1:]
    x, y, z = plus(plus(scaled(w, a[0]), scaled(v, b[0])), cross(v, w))
    return (a[0] * b[0] - dot(v, w), x, y, z)


def composed(outer: Pose, inner: Pose) -> Pose:
    """``inner``, given in the frame of ``outer``, in the frame that ``outer`` is given in."""
    quaternion = product(outer.quaternion, inner.quaternion)
    position = outer.point(inner.position)
    if max(x.denominator.bit_length() + x.numerator.bit_length() for x in (*quaternion, *position)) < _BITS:
        return Pose(position, quaternion)
    w, x, y, z = map(_rounded, normalised(quaternion))
    a, b, c = map(_rounded, position)
    return Pose((a, b, c), (w, x, y, z))


def seen_from(frame: Pose, other: Pose) -> Pose:
    """``other`` in the frame ``frame``; both given in a third one."""
    w, x, y, z = frame.quaternion
    back = Pose(ZERO_VECTOR, (w, -x, -y, -z))
    return composed(back, Pose(plus(other.position, scaled(frame.position, Fraction(-1))), other.quaternion))


def normalised(quaternion: Quaternion) -> Quaternion:
    """The quaternion of norm 1, to 40 digits; the first component that is not 0 is positive."""
    size = length(quaternion)
    if next(x for x in quaternion if x) < 0:
        size = -size
    w, x, y, z = (component / size for component in quaternion)
    return (w, x, y, z)


def squared_up(quaternion: Quaternion, tolerance: Fraction) -> Quaternion:
    """A quaternion made of quarter turns where it is nearly: components nearly 0 or nearly as large as the largest."""
    largest = max(quaternion, key=abs)
    ratios = [component / largest for component in quaternion]
    if all(abs(ratio - round(ratio)) <= tolerance for ratio in ratios) and sum(map(abs, map(round, ratios))) != 3:
        ratios = [Fraction(round(ratio)) for ratio in ratios]
        return (ratios[0], ratios[1], ratios[2], ratios[3])
    return quaternion


def from_rpy(angles: Sequence[Fraction], tolerance: Fraction) -> Quaternion:
    """Quaternion of roll, pitch and yaw in rad: turns about the fixed x, y and z, in this order.

    An angle within ``tolerance`` of a multiple of a right angle is one; cosines of others are doubles.
    """
    result: Quaternion = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
    for axis, angle in enumerate(angles, start=1):
        cosine, sine = _half(float(angle), float(tolerance))
        turn = [cosine, Fraction(0), Fraction(0), Fraction(0)]
        turn[axis] = sine
        result = product((turn[0], turn[1], turn[2], turn[3]), result)
    return result


def moved(masses: MassProperties, pose: Pose) -> MassProperties:
    """Mass properties, given in a frame, in the frame that its pose is given in."""
    return MassProperties(masses.mass, pose.point(masses.centre), turned(masses.inertia, pose.attitude))


def turned(matrix: Matrix, attitude: Matrix) -> Matrix:
    """``R M R^T``."""
    first, second, third = (times(attitude, row) for row in matrix)
    a, b, c = (times(attitude, column) for column in transposed((first, second, third)))
    return transposed((a, b, c))


def together(parts: Iterable[MassProperties]) -> MassProperties:
    """Mass properties of rigidly connected parts, all in one frame; the parallel-axis theorem, exact."""
    parts = tuple(parts)
    mass = sum((part.mass for part in parts), Fraction(0))
    if len(parts) == 1 or not mass:
        return parts[0] if parts else MassProperties(mass, ZERO_VECTOR, (ZERO_VECTOR,) * 3)
    centre = ZERO_VECTOR
    for part in parts:
        centre = plus(centre, scaled(part.centre, part.mass / mass))
    rows = [ZERO_VECTOR, ZERO_VECTOR, ZERO_VECTOR]
    for part in parts:
        offset = plus(part.centre, scaled(centre, Fraction(-1)))
        for k in range(3):
            steiner = scaled(offset, -part.mass * offset[k])
            diagonal = [Fraction(0)] * 3
            diagonal[k] = part.mass * dot(offset, offset)
            rows[k] = plus(plus(rows[k], part.inertia[k]), plus(steiner, (diagonal[0], diagonal[1], diagonal[2])))
    return MassProperties(mass, centre, (rows[0], rows[1], rows[2]))


def is_inertia(matrix: Matrix) -> bool:
    """Whether a symmetric matrix is the inertia of a body.

    It is positive definite, and no principal value is above the sum of the two others; that admits a part in 1e-9, for
    the digits that files leave out.
    """
    trace = matrix[0][0] + matrix[1][1] + matrix[2][2]
    if not all(minor > 0 for minor in _minors(matrix)):
        return False
    half = trace * (Fraction(1, 2) + Fraction(1, 10**9))
    rows = [[half * (i == k) - matrix[i][k] for k in range(3)] for i in range(3)]
    return all(minor >= 0 for minor in _minors(rows))


def _minors(matrix: Sequence[Sequence[Fraction]]) -> list[Fraction]:
    a, b, c = matrix
    minors = [matrix[k][k] for k in range(3)]
    minors += [matrix[i][i] * matrix[k][k] - matrix[i][k] * matrix[k][i] for i, k in ((0, 1), (0, 2), (1, 2))]
    return [*minors, dot(a, cross((b[0], b[1], b[2]), (c[0], c[1], c[2])))]


def _half(angle: float, tolerance: float) -> tuple[Fraction, Fraction]:
    quarters = round(angle / (math.pi / 2))
    if abs(angle - quarters * (math.pi / 2)) <= tolerance:
        cosine, sine = ((1, 0), (1, 1), (0, 1), (1, -1))[quarters % 4]
        return Fraction(cosine), Fraction(sine)
    return Fraction(math.cos(angle / 2)), Fraction(math.sin(angle / 2))


def _rounded(value: Fraction) -> Fraction:
    return Fraction(round(value * _PLACES), _PLACES)
