"""Bodies of a scene file: mass properties and the pose at t = 0 are checked, then a `Body` is made."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

import numpy

from codegen.errors import Mistake
from codegen.spec.placement import IDENTITY, dot, length, rotation, transposed
from codegen.spec.scene import KINEMATIC_QUANTITIES, ZERO_VECTOR, Body, Matrix, Quaternion, Vector
from codegen.spec.scene_file.entries import BodyEntry
from codegen.spec.scene_file.text import shown, shown_vector

TOLERANCE = Fraction(1, 10**9)
"""Of norms, angles and symmetry: what the last digits of a file may leave."""

_NO_INERTIA: Matrix = (ZERO_VECTOR, ZERO_VECTOR, ZERO_VECTOR)


@dataclass(frozen=True, slots=True)
class Pose:
    """Where a body is at t = 0: position of its centre of mass [3] m, world, and attitude [3, 3], body to world."""

    position: Vector
    attitude: Matrix


GROUND_POSE = Pose(ZERO_VECTOR, IDENTITY)


def pose_of(entry: BodyEntry) -> Pose | None:
    """The pose of a body; None where it cannot be read."""
    if {"position", "quaternion"} & entry.wrong or not any(entry.quaternion):
        return None
    return Pose(entry.position, rotation(entry.quaternion))


def body_mistakes(entry: BodyEntry, needs_mass: bool) -> Iterator[Mistake]:
    """Check one body by itself."""
    yield from _quaternion_mistakes(entry.quaternion, f"{entry.place}: quaternion")
    for key in ("mass", "inertia") if needs_mass else ():
        if key not in entry.given:
            unit = {"mass": "kg", "inertia": "kg m^2"}[key]
            remedy = f"give {key} in {unit}, or ask for kinematic quantities only ({', '.join(KINEMATIC_QUANTITIES)})"
            yield Mistake(entry.place, f"has no {key}", f"{remedy} under [output]")
    if entry.mass is not None and entry.mass <= 0:
        yield Mistake(f"{entry.place}: mass", f"is {shown(entry.mass)} kg", "give a mass above 0 kg")
    if entry.inertia is not None:
        yield from inertia_mistakes(entry.inertia, f"{entry.place}: inertia")


def make_body(entry: BodyEntry) -> Body:
    """Make a body of an entry without mistakes."""
    return Body(
        entry.name or "",
        entry.mass or Fraction(0),
        symmetric(entry.inertia or _NO_INERTIA),
        entry.position,
        entry.quaternion,
        entry.velocity,
        entry.angular_velocity,
    )


def _quaternion_mistakes(quaternion: Quaternion, place: str) -> Iterator[Mistake]:
    squared = dot(quaternion, quaternion)
    if not squared:
        yield Mistake(place, "has norm 0", "give a unit quaternion w x y z; [1, 0, 0, 0] for no rotation")
    elif not (1 - TOLERANCE) ** 2 <= squared <= (1 + TOLERANCE) ** 2:
        norm = length(quaternion)
        remedy = f"normalised it is {shown_vector(value / norm for value in quaternion)}"
        yield Mistake(place, f"has norm {float(norm):.12g}, not 1", remedy)


def symmetric(matrix: Matrix) -> Matrix:
    """The mean of a matrix and its transpose."""
    rows = zip(matrix, transposed(matrix), strict=True)
    return tuple(tuple((x + y) / 2 for x, y in zip(a, b, strict=True)) for a, b in rows)  # type: ignore[return-value]


def inertia_mistakes(matrix: Matrix, place: str) -> Iterator[Mistake]:
    """Check that an inertia, [3, 3] kg m^2 about the mass centre, is that of a body."""
    yield from definite_mistakes(matrix, place) or triangle_mistakes(matrix, place)


def definite_mistakes(matrix: Matrix, place: str, slack: Fraction = Fraction(0)) -> list[Mistake]:
    """Check that a matrix is symmetric and that its principal values are above 0, but for this part of their sum."""
    size = max(abs(value) for row in matrix for value in row)
    apart = max(abs(matrix[i][k] - matrix[k][i]) for i in range(3) for k in range(i))
    if apart > TOLERANCE * size:
        what = f"is not symmetric: two entries differ by {shown(apart)} kg m^2"
        return [Mistake(place, what, "give equal entries on both sides of the diagonal")]
    matrix = symmetric(matrix)
    if _is_positive(_on_diagonal(slack * _trace(matrix), matrix, 1)):
        return []
    values = f"principal values {_principal(matrix)} kg m^2"
    if slack:
        return [
            Mistake(place, f"has a negative principal value: {values}", "give principal values of 0 kg m^2 or more")
        ]
    return [Mistake(place, f"is not positive definite: {values}", "give principal values above 0 kg m^2")]


def triangle_mistakes(matrix: Matrix, place: str) -> list[Mistake]:
    """Check that no principal value is above the sum of the others."""
    matrix = symmetric(matrix)
    if _is_positive(_on_diagonal(_trace(matrix) / 2 * (1 + TOLERANCE), matrix, -1)):
        return []
    what = f"belongs to no body: principal values {_principal(matrix)} kg m^2"
    remedy = "no principal value of a body exceeds the sum of the others; check the axes and the reference point"
    return [Mistake(place, what, remedy)]


def _trace(matrix: Matrix) -> Fraction:
    return sum((matrix[k][k] for k in range(3)), Fraction(0))


def _on_diagonal(value: Fraction, matrix: Matrix, sign: int) -> Matrix:
    """``value I + sign matrix``: less the matrix it tells the triangle inequality, if the value is half the trace."""
    return tuple(  # type: ignore[return-value]
        tuple(value * IDENTITY[i][k] + sign * matrix[i][k] for k in range(3)) for i in range(3)
    )


def _is_positive(matrix: Matrix) -> bool:
    """Whether a symmetric matrix is positive definite, by its leading minors."""
    (a, b, c), (_, d, e), (_, _, f) = matrix
    second = a * d - b * b
    return a > 0 and second > 0 and second * f + b * c * e * 2 - a * e * e - d * c * c > 0


def _principal(matrix: Matrix) -> str:
    values = numpy.linalg.eigvalsh(numpy.array(matrix, dtype=float))
    return ", ".join(f"{value:.6g}" for value in values)
