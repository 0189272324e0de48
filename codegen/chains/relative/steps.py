"""A joint of a scene as joints of one freedom: axes of its frame, one after the other, and coordinates at t = 0."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from codegen.chains.relative.pose import Pose, angle
from codegen.spec.angles import PI
from codegen.spec.placement import IDENTITY, square_root
from codegen.spec.scene import Matrix, Vector

_X, _Y, _Z = IDENTITY


@dataclass(frozen=True, slots=True)
class Step:
    """A joint of one freedom.

    Attributes:
        type: ``revolute`` or ``prismatic``.
        axis: number of the axis of the joint's frame, 0 to 2.
        sense: 1, or -1 where the joint is gone through from its second body to its first.
        coordinate: number of the coordinate of the scene's joint.
        pitch: of a screw, m/rad.
    """

    type: str
    axis: int
    sense: int
    coordinate: int
    pitch: Fraction = Fraction(0)

    @property
    def turn(self) -> Matrix:
        """Axes of the link's frame, as columns, in the joint's frame: z along the axis."""
        z = _scaled(self.sense, (_X, _Y, _Z)[self.axis])
        x = (_X, _Y, _Z)[(self.axis + 1) % 3]
        y = _scaled(self.sense, (_X, _Y, _Z)[(self.axis + 2) % 3])
        return _columns(x, y, z)


_STEPS: dict[str, tuple[tuple[str, int, int], ...]] = {
    "revolute": (("revolute", 2, 0),),
    "translational": (("prismatic", 2, 0),),
    "screw": (("screw", 2, 0),),
    "cylindrical": (("prismatic", 2, 0), ("revolute", 2, 1)),
    "universal": (("revolute", 2, 0), ("revolute", 0, 1)),
    "planar": (("prismatic", 0, 0), ("prismatic", 1, 1), ("revolute", 2, 2)),
    "ball": (("revolute", 2, 0), ("revolute", 1, 1), ("revolute", 0, 2)),
    "rigid": (),
    "free": (
        ("prismatic", 0, 0),
        ("prismatic", 1, 1),
        ("prismatic", 2, 2),
        ("revolute", 2, 3),
        ("revolute", 1, 4),
        ("revolute", 0, 5),
    ),
}
"""Type of a joint -> type, axis and coordinate of each step from its first body to its second. ``free`` is none."""


def steps(kind: str, is_reversed: bool, pitch: Fraction = Fraction(0)) -> tuple[Step, ...]:
    """The steps from the first body of a joint to its second, or back; a screw has a pitch either way."""
    found = [Step(name, axis, -1 if is_reversed else 1, number, pitch) for name, axis, number in _STEPS[kind]]
    return tuple(reversed(found) if is_reversed else found)


def coordinates(kind: str, pose: Pose, pitch: Fraction = Fraction(0)) -> tuple[Fraction, ...]:
    """The coordinates of a joint in a pose of the second marker on the first; those of a screw count its turns."""
    R, (x, y, z) = pose.R, pose.p
    about_z = angle(R[1][0], R[0][0])
    ball = about_z, -_arcsine(R), angle(R[2][1], R[2][2])
    return {
        "revolute": (about_z,),
        "translational": (z,),
        "screw": (about_z + _turns(z / pitch - about_z if pitch else Fraction(0)),),
        "cylindrical": (z, about_z),
        "universal": (about_z, angle(R[2][1], R[2][2])),
        "planar": (x, y, about_z),
        "ball": ball,
        "rigid": (),
        "free": (x, y, z, *ball),
    }[kind]


def _turns(angle: Fraction) -> Fraction:
    """The whole turns next to an angle, rad."""
    return 2 * PI * round(angle / (2 * PI))


def _arcsine(R: Matrix) -> Fraction:
    return angle(R[2][0], square_root(R[2][1] ** 2 + R[2][2] ** 2))


def _scaled(sign: int, vector: Vector) -> Vector:
    a, b, c = (sign * x for x in vector)
    return a, b, c


def _columns(x: Vector, y: Vector, z: Vector) -> Matrix:
    return tuple(zip(x, y, z, strict=True))  # type: ignore[return-value]
