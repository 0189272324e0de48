"""Poses of one joint over a domain: Sobol points, on the constraint or in mid-iteration, in twice the precision.

They are ideal: attitudes are rotations and joints are closed to 1e-31. What a routine is given is rounded from them.
The sequence is scrambled with a fixed seed, so that every run sees the same poses.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from codegen.ir.program import Argument
from codegen.measure.double_double import PI, DoubleDouble
from codegen.measure.draw import Draw, Points, any_attitude, drifted, sobol_points, unit_quaternion
from codegen.measure.ideal_rotations import (
    Matrix,
    Vector,
    about,
    apply,
    minus,
    packed,
    plus,
    rotation,
    small_rotation,
    times,
    transposed,
)
from codegen.measure.pose_domain import LARGEST_PITCH, LARGEST_START, LEAST_PITCH, MOST_TURNS, PoseDomain
from codegen.passes.given_trigonometry import SINES_COSINES
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

DIRECTION = (Fraction(9, 25), Fraction(12, 25), Fraction(4, 5))
"""Where the bodies are if they are far from the origin: a unit vector."""


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Inputs of many poses.

    Attributes:
        ideal: argument -> its entries, column-major, each an array over the poses.
        drifted: what is given in their place, before it is rounded: attitudes that are no rotations.
    """

    ideal: dict[str, Vector]
    drifted: dict[str, Vector] = field(default_factory=dict)

    def given(self, real: type[np.floating]) -> dict[str, NDArray[np.floating]]:
        """Round to a number type: argument -> [length, poses]."""
        count = next(len(entries[0].high) for entries in self.ideal.values() if entries)
        return {
            name: np.array([entry.high.astype(real) + entry.low.astype(real) for entry in entries]).reshape(-1, count)
            for name, entries in (self.ideal | self.drifted).items()
        }


def exactly(given: dict[str, NDArray[np.floating]]) -> dict[str, Vector]:
    """Take rounded inputs for exact."""
    return {name: [in_pairs(row) for row in rows] for name, rows in given.items()}


def in_pairs(values: NDArray[np.floating]) -> DoubleDouble:
    """Take numbers of any type of at most 106 bits, exactly."""
    high = values.astype(np.float64)
    return DoubleDouble(high, (values - high.astype(values.dtype)).astype(np.float64))


def sample_poses(
    joint: JointType,
    variant: Variant,
    arguments: Sequence[Argument],
    domain: PoseDomain,
    count: int,
    is_converged: bool,
) -> Poses:
    """Draw poses; see `poses_at`."""
    return poses_at(joint, variant, arguments, domain, sobol_points(count), is_converged)


def poses_at(
    joint: JointType,
    variant: Variant,
    arguments: Sequence[Argument],
    domain: PoseDomain,
    points: Points,
    is_converged: bool,
    fixed: Mapping[int, DoubleDouble] | None = None,
) -> Poses:
    """Make poses of points of the unit cube.

    Args:
        joint: its type.
        variant: form and rows.
        arguments: of the routine; their lengths say how many multipliers and velocities there are.
        domain: bounds.
        points: [poses, dimensions]; see `sobol_points`.
        is_converged: whether the constraint is met; else it is off by the domain's misfit.
        fixed: angles of the joint, by their number, that are not drawn.
    """
    draw = Draw(points)
    lengths = {argument.name: argument.length for argument in arguments}
    r_i = draw.vector(3, domain.r)
    A_i = any_attitude(draw)
    (s_i, C_i), (s_j, C_j) = (_joint_frame(draw, domain.s) for _ in range(2))
    parameters = _screw_parameters(draw) if joint.is_screw else []
    alpha, offset, H = _relative(joint, variant, domain, draw, parameters, fixed or {})
    A_j = times(times(times(A_i, C_i), H), transposed(C_j))
    arm = plus(s_i, apply(C_i, offset))
    r_j = minus(plus(r_i, apply(A_i, arm)), apply(A_j, s_j))
    step, turn = draw.vector(3, domain.misfit), draw.vector(3, domain.misfit)
    slip = draw.vector(len(alpha), domain.misfit)
    if not is_converged:
        r_j, A_j, alpha = plus(r_j, step), times(A_j, small_rotation(turn)), plus(alpha, slip)
    far = [DoubleDouble.exact(Fraction(domain.distance) * part) for part in DIRECTION]
    geometry = [*s_i, *packed(C_i), *s_j, *packed(C_j), *parameters]
    ideal = {
        "r_i": plus(r_i, far),
        "A_i": packed(A_i),
        "r_j": plus(r_j, far),
        "A_j": packed(A_j),
        "alpha": alpha,
        "geometry": geometry,
        "velocity": draw.vector(lengths.get("velocity", 0), domain.velocity),
        "lambda": draw.vector(lengths.get("lambda", 0), domain.multiplier),
    }
    ideal[SINES_COSINES] = [part for angle in alpha for part in angle.sine_and_cosine()]
    bodies = {"A_i": A_i, "A_j": A_j} if domain.drift else {}
    return Poses(ideal, {name: packed(drifted(A, domain.drift, draw)) for name, A in bodies.items()})


def _turns_in_sequence(angles: Vector) -> Vector:
    """Unit quaternion of ``Rz(a1) Ry(a2) Rx(a3)``."""
    half = DoubleDouble.of(0.5)
    (s1, c1), (s2, c2), (s3, c3) = ((half * angle).sine_and_cosine() for angle in angles)
    return [
        c1 * c2 * c3 + s1 * s2 * s3,
        c1 * c2 * s3 - s1 * s2 * c3,
        c1 * s2 * c3 + s1 * c2 * s3,
        s1 * c2 * c3 - c1 * s2 * s3,
    ]


def _joint_frame(draw: Draw, size: float) -> tuple[Vector, Matrix]:
    return draw.vector(3, size / 3**0.5), any_attitude(draw)


def _relative(
    joint: JointType,
    variant: Variant,
    domain: PoseDomain,
    draw: Draw,
    parameters: Vector,
    fixed: Mapping[int, DoubleDouble],
) -> tuple[Vector, Vector, Matrix]:
    """Coordinates of the joint, ``C_i^T d'`` and H (S1 Table 3)."""
    zero = draw.zero
    shifts = [] if joint.is_screw else draw.vector(joint.translations, domain.d)
    angles = draw.vector(joint.rotations, domain.angle)
    if joint.rotations == 3:
        angles[1] = DoubleDouble.of(angles[1].high * (domain.pitch_angle / domain.angle))
    angles = [fixed.get(k, angle) for k, angle in enumerate(angles)]
    H = _relative_rotation(joint, variant, [angle.sine_and_cosine() for angle in angles], zero)
    offset = {0: [], 1: [zero, zero], 2: [], 3: []}[joint.translations] + shifts
    if joint.is_screw:
        offset = [zero, zero, _advance(angles[0], parameters)]
    offset = (offset + [zero] * 3)[:3]
    if variant.rows == "quaternion":
        q = _turns_in_sequence(angles) if fixed else unit_quaternion(draw)
        return [*shifts, *q], offset, rotation(q)
    return [*shifts, *angles], offset, H


def _screw_parameters(draw: Draw) -> Vector:
    pitch, start = draw.within(LEAST_PITCH, LARGEST_PITCH), draw.within(-LARGEST_START, LARGEST_START)
    return [pitch, start, draw.whole(MOST_TURNS)]


def _advance(angle: DoubleDouble, parameters: Vector) -> DoubleDouble:
    pitch, start, turns = parameters
    return pitch * (angle + DoubleDouble.exact(2 * PI) * turns + start)


def _relative_rotation(
    joint: JointType, variant: Variant, turns: Sequence[tuple[DoubleDouble, DoubleDouble]], zero: DoubleDouble
) -> Matrix:
    """H; the cross of the conventional universal joint has the axes ``h_i`` and ``h_j``."""
    if joint.rotations == 2 and variant.form == "conventional":
        quarter = (DoubleDouble.of(np.ones_like(zero.high)), zero)
        return times(times(about(2, turns[0]), about(0, quarter)), about(2, turns[1]))
    axes = {0: (), 1: (2,), 2: (2, 0), 3: (2, 1, 0)}[joint.rotations]
    H = about(2, (zero, DoubleDouble.of(np.ones_like(zero.high))))
    for axis, turn in zip(axes, turns, strict=True):
        H = times(H, about(axis, turn))
    return H
