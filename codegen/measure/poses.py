"""Poses of one joint over a domain: Sobol points, on the constraint or in mid-iteration, in twice the precision.

They are ideal: attitudes are rotations and joints are closed to 1e-31. What a routine is given is rounded from them.
The sequence is scrambled with a fixed seed, so that every run sees the same poses.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from codegen.ir.program import Argument
from codegen.measure.double_double import PI, DoubleDouble
from codegen.measure.pose_domain import LARGEST_PITCH, LARGEST_START, LEAST_PITCH, MOST_TURNS, PoseDomain
from codegen.passes.given_trigonometry import SINES_COSINES
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

Vector = list[DoubleDouble]
Matrix = list[list[DoubleDouble]]
"""Rows of entries."""
Points = NDArray[np.float64]

SEED = 20
_COLUMNS = 80
"""Dimensions of the sequence; a pose takes some 60."""

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
        count = len(self.ideal["r_i"][0].high)
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


def sobol_points(count: int) -> Points:
    """Points [poses, dimensions] of the unit cube, the same in every run."""
    from scipy.stats import qmc

    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="The balance properties")
        return np.asarray(qmc.Sobol(_COLUMNS, scramble=True, rng=SEED).random(count))


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
    draw = _Sequence(points)
    lengths = {argument.name: argument.length for argument in arguments}
    r_i = draw.vector(3, domain.r)
    A_i = _attitude(draw)
    (s_i, C_i), (s_j, C_j) = (_joint_frame(draw, domain.s) for _ in range(2))
    parameters = _screw_parameters(draw) if joint.is_screw else []
    alpha, offset, H = _relative(joint, variant, domain, draw, parameters, fixed or {})
    A_j = _times(_times(_times(A_i, C_i), H), _transposed(C_j))
    arm = _plus(s_i, _apply(C_i, offset))
    r_j = _minus(_plus(r_i, _apply(A_i, arm)), _apply(A_j, s_j))
    step, turn = draw.vector(3, domain.misfit), draw.vector(3, domain.misfit)
    slip = draw.vector(len(alpha), domain.misfit)
    if not is_converged:
        r_j, A_j, alpha = _plus(r_j, step), _times(A_j, _small_rotation(turn)), _plus(alpha, slip)
    far = [DoubleDouble.exact(Fraction(domain.distance) * part) for part in DIRECTION]
    geometry = [*s_i, *_packed(C_i), *s_j, *_packed(C_j), *parameters]
    ideal = {
        "r_i": _plus(r_i, far),
        "A_i": _packed(A_i),
        "r_j": _plus(r_j, far),
        "A_j": _packed(A_j),
        "alpha": alpha,
        "geometry": geometry,
        "velocity": draw.vector(lengths.get("velocity", 0), domain.velocity),
        "lambda": draw.vector(lengths.get("lambda", 0), domain.multiplier),
    }
    ideal[SINES_COSINES] = [part for angle in alpha for part in angle.sine_and_cosine()]
    bodies = {"A_i": A_i, "A_j": A_j} if domain.drift else {}
    return Poses(ideal, {name: _packed(_drifted(A, domain.drift, draw)) for name, A in bodies.items()})


class _Sequence:
    """The columns of points, taken one after the other."""

    def __init__(self, points: Points) -> None:
        self._points = points
        self._next = 0
        self.zero = DoubleDouble.of(np.zeros(len(points)))

    def unit(self) -> DoubleDouble:
        """Numbers in [0, 1)."""
        self._next += 1
        return DoubleDouble.of(self._points[:, self._next - 1])

    def within(self, low: float, high: float) -> DoubleDouble:
        """Doubles in an interval."""
        return DoubleDouble.of(low + (high - low) * self.unit().high)

    def whole(self, largest: int) -> DoubleDouble:
        """Integers from ``-largest`` to ``largest``."""
        return DoubleDouble.of(np.floor(self.unit().high * (2 * largest + 1)) - largest)

    def vector(self, length: int, bound: float) -> Vector:
        """Entries in ``[-bound, bound]``."""
        return [self.within(-bound, bound) for _ in range(length)]


def _attitude(draw: _Sequence) -> Matrix:
    """Rotations, evenly over all attitudes (Shoemake)."""
    return _rotation(_unit_quaternion(draw))


def _unit_quaternion(draw: _Sequence) -> Vector:
    share, first, second = draw.unit(), draw.unit(), draw.unit()
    turn = DoubleDouble.exact(2 * PI)
    one = DoubleDouble.of(1.0)
    s, c = (turn * first).sine_and_cosine()
    sine, cosine = (turn * second).sine_and_cosine()
    small, large = (one - share).sqrt(), share.sqrt()
    return [small * s, small * c, large * sine, large * cosine]


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


def _rotation(q: Vector) -> Matrix:
    """Rotation of a unit quaternion (w, x, y, z)."""
    w, x, y, z = q
    two, one = DoubleDouble.of(2.0), DoubleDouble.of(1.0)
    return [
        [one - two * (y * y + z * z), two * (x * y - w * z), two * (x * z + w * y)],
        [two * (x * y + w * z), one - two * (x * x + z * z), two * (y * z - w * x)],
        [two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y)],
    ]


def _small_rotation(v: Vector) -> Matrix:
    """Rotation by about the vector ``v``: that of the quaternion (1, v / 2), of norm 1."""
    half = DoubleDouble.of(0.5)
    q = [DoubleDouble.of(np.ones_like(v[0].high)), *(half * part for part in v)]
    square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]
    norm = square.sqrt()
    return _rotation([part / norm for part in q])


def _joint_frame(draw: _Sequence, size: float) -> tuple[Vector, Matrix]:
    return draw.vector(3, size / 3**0.5), _attitude(draw)


def _relative(
    joint: JointType,
    variant: Variant,
    domain: PoseDomain,
    draw: _Sequence,
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
        q = _turns_in_sequence(angles) if fixed else _unit_quaternion(draw)
        return [*shifts, *q], offset, _rotation(q)
    return [*shifts, *angles], offset, H


def _screw_parameters(draw: _Sequence) -> Vector:
    pitch, start = draw.within(LEAST_PITCH, LARGEST_PITCH), draw.within(-LARGEST_START, LARGEST_START)
    return [pitch, start, draw.whole(MOST_TURNS)]


def _advance(angle: DoubleDouble, parameters: Vector) -> DoubleDouble:
    pitch, start, turns = parameters
    return pitch * (angle + DoubleDouble.exact(2 * PI) * turns + start)


def _about(axis: int, sine_cosine: tuple[DoubleDouble, DoubleDouble]) -> Matrix:
    s, c = sine_cosine
    zero, one = DoubleDouble.of(np.zeros_like(s.high)), DoubleDouble.of(np.ones_like(s.high))
    a, b = (axis + 1) % 3, (axis + 2) % 3
    matrix = [[one if row == column else zero for column in range(3)] for row in range(3)]
    matrix[a][a], matrix[a][b], matrix[b][a], matrix[b][b] = c, -s, s, c
    return matrix


def _relative_rotation(
    joint: JointType, variant: Variant, turns: Sequence[tuple[DoubleDouble, DoubleDouble]], zero: DoubleDouble
) -> Matrix:
    """H; the cross of the conventional universal joint has the axes ``h_i`` and ``h_j``."""
    if joint.rotations == 2 and variant.form == "conventional":
        quarter = (DoubleDouble.of(np.ones_like(zero.high)), zero)
        return _times(_times(_about(2, turns[0]), _about(0, quarter)), _about(2, turns[1]))
    axes = {0: (), 1: (2,), 2: (2, 0), 3: (2, 1, 0)}[joint.rotations]
    H = _about(2, (zero, DoubleDouble.of(np.ones_like(zero.high))))
    for axis, turn in zip(axes, turns, strict=True):
        H = _times(H, _about(axis, turn))
    return H


def _drifted(A: Matrix, drift: float, draw: _Sequence) -> Matrix:
    return [[entry + draw.within(-drift, drift) for entry in row] for row in A]


def _times(A: Matrix, B: Matrix) -> Matrix:
    return [[row[0] * B[0][k] + row[1] * B[1][k] + row[2] * B[2][k] for k in range(3)] for row in A]


def _apply(A: Matrix, v: Vector) -> Vector:
    return [row[0] * v[0] + row[1] * v[1] + row[2] * v[2] for row in A]


def _transposed(A: Matrix) -> Matrix:
    return [[A[row][column] for row in range(3)] for column in range(3)]


def _packed(A: Matrix) -> Vector:
    return [A[row][column] for column in range(3) for row in range(3)]


def _plus(a: Vector, b: Vector) -> Vector:
    return [x + y for x, y in zip(a, b, strict=True)]


def _minus(a: Vector, b: Vector) -> Vector:
    return [x - y for x, y in zip(a, b, strict=True)]
