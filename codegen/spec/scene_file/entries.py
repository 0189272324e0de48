"""The keys of a scene file, each with its kind, unit, meaning and default: what is read and what the schema says.

An entry is what stands in the file, read but not yet checked against other entries. Keys that are wrong or left out
have their default; `Entry.given` tells which were there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.request import DERIVATIVES
from codegen.spec.scene import (
    GROUND,
    MOTIONS,
    SCENE_FORMS,
    SCENE_JOINTS,
    SCENE_QUANTITIES,
    ZERO_VECTOR,
    Matrix,
    Quaternion,
    Vector,
)
from codegen.spec.scene_file.entry import Entry, key, load, table_of, tables
from codegen.spec.scene_file.values import (
    FLAG,
    QUATERNION,
    TEXT,
    choice,
    count,
    each,
    inertia,
    number,
    pair,
    several,
    vector,
    whole,
)

MOST_COPIES = 10_000
"""Copies of a mechanism that a file may ask for."""

_ROWS = ("regular", "table4")
_UNTURNED: Quaternion = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
_NONE = Fraction(0)


@dataclass(frozen=True, slots=True)
class BodyEntry(Entry):
    """A rigid body."""

    name: str | None = key(TEXT, f'a text of 1 to 60 signs, unique among the bodies, not "{GROUND}"', is_required=True)
    mass: Fraction | None = key(number("kg"), "mass in kg; needed unless only kinematic quantities are asked for")
    inertia: Matrix | None = key(
        inertia(),
        "inertia in kg m^2 about the centre of mass, body axes: three principal values or three rows of three; needed "
        "like the mass",
    )
    position: Vector = key(vector("m"), "centre of mass at t = 0 in m, world axes", ZERO_VECTOR)
    quaternion: Quaternion = key(QUATERNION, "attitude at t = 0, body to world: w x y z, of norm 1", _UNTURNED)
    velocity: Vector = key(vector("m/s"), "velocity of the centre of mass at t = 0 in m/s, world axes", ZERO_VECTOR)
    angular_velocity: Vector = key(vector("rad/s"), "angular velocity at t = 0 in rad/s, body axes", ZERO_VECTOR)


@dataclass(frozen=True, slots=True)
class DriveEntry(Entry):
    """A prescribed motion of a joint coordinate: position + speed t + amplitude sin(frequency t + phase)."""

    position: Fraction | None = key(number(), "coordinate at t = 0, but for the sine, in m or rad", is_required=True)
    speed: Fraction | None = key(
        number(), "rate of the coordinate, but for the sine, in m/s or rad/s", is_required=True
    )
    amplitude: Fraction = key(number(), "amplitude of a sine in m or rad", _NONE)
    frequency: Fraction = key(number("rad/s"), "angular frequency of the sine in rad/s", _NONE)
    phase: Fraction = key(number("rad"), "phase of the sine in rad", _NONE)


@dataclass(frozen=True, slots=True)
class LimitEntry(Entry):
    """Soft stops of a joint coordinate."""

    lower: Fraction | None = key(number(), "coordinate in m or rad below which the stop acts")
    upper: Fraction | None = key(number(), "coordinate in m or rad above which the stop acts")
    stiffness: Fraction | None = key(number(), "stiffness of the stop in N/m or N m/rad", is_required=True)
    damping: Fraction = key(number(), "damping of the stop in N s/m or N m s/rad", _NONE)


@dataclass(frozen=True, slots=True)
class JointEntry(Entry):
    """A joint between two bodies, placed by world vectors at t = 0 or by vectors in the axes of both bodies."""

    name: str | None = key(TEXT, "a text of 1 to 60 signs, unique among the joints", is_required=True)
    type: str | None = key(choice(SCENE_JOINTS), f"one of {', '.join(SCENE_JOINTS)}", is_required=True)
    bodies: tuple[str, str] | None = key(
        pair(TEXT), f'names of the first and the second body; one of them may be "{GROUND}"', is_required=True
    )
    point: Vector | None = key(vector("m"), "origin of the joint at t = 0 in m, world axes")
    axis: Vector | None = key(
        vector(),
        "axis h of the joint at t = 0, world axes, any length; planar: the normal; universal: in the first body",
    )
    axis2: Vector | None = key(
        vector(), "universal only: second axis f at t = 0, world axes, fixed in the second body, perpendicular to axis"
    )
    points: tuple[Vector, Vector] | None = key(
        pair(vector("m")),
        "instead of point: origin of the joint on the first and the second body in m, body axes from the centre of "
        "mass; ground: world",
    )
    axes: tuple[Vector, Vector] | None = key(
        pair(vector()),
        "instead of axis: axis h in the axes of the first and of the second body; universal: h of the first body, f of "
        "the second",
    )
    pitch: Fraction | None = key(number("m/rad"), "screw only: advance in m/rad")
    form: str = key(choice(SCENE_FORMS), "how the joint is formulated", "auto")
    torque: tuple[Fraction | None, ...] = key(each(number()), "constant generalised force in N or N m", (_NONE,))
    stiffness: tuple[Fraction | None, ...] = key(each(number()), "spring in N/m or N m/rad", (_NONE,))
    damping: tuple[Fraction | None, ...] = key(each(number()), "damper in N s/m or N m s/rad", (_NONE,))
    rest: tuple[Fraction | None, ...] = key(each(number()), "coordinate in m or rad where the spring is free", (_NONE,))
    drive: tuple[DriveEntry | None, ...] = key(each(load(DriveEntry)), "prescribed motion", ())
    limit: tuple[LimitEntry | None, ...] = key(each(load(LimitEntry)), "soft stops", ())


@dataclass(frozen=True, slots=True)
class SpringEntry(Entry):
    """A spring and damper between two points."""

    bodies: tuple[str, str] | None = key(pair(TEXT), f'names; one of them may be "{GROUND}"', is_required=True)
    points: tuple[Vector, Vector] | None = key(
        pair(vector("m")), "its ends in m, body axes from the centre of mass; ground: world", is_required=True
    )
    stiffness: Fraction = key(number("N/m"), "stiffness in N/m", _NONE)
    damping: Fraction = key(number("N s/m"), "damping in N s/m", _NONE)
    length: Fraction = key(number("m"), "length in m at which it is free", _NONE)


@dataclass(frozen=True, slots=True)
class TorqueEntry(Entry):
    """A constant torque on a body."""

    body: str | None = key(TEXT, "name of the body", is_required=True)
    vector: Vector | None = key(vector("N m"), "torque in N m, world axes", is_required=True)


@dataclass(frozen=True, slots=True)
class ForceEntry(Entry):
    """A constant force on a body."""

    body: str | None = key(TEXT, "name of the body", is_required=True)
    point: Vector = key(vector("m"), "where it acts in m, body axes from the centre of mass", ZERO_VECTOR)
    vector: Vector | None = key(vector("N"), "force in N, world axes", is_required=True)


@dataclass(frozen=True, slots=True)
class CopiesEntry(Entry):
    """The whole mechanism several times, side by side."""

    count: int = key(count(MOST_COPIES), "number of mechanisms", 1)
    offset: Vector = key(vector("m"), "from one mechanism to the next in m, world axes", ZERO_VECTOR)


@dataclass(frozen=True, slots=True)
class OutputEntry(Entry):
    """What is generated; everything if it is left out."""

    quantities: tuple[str, ...] = key(whole(several(choice(SCENE_QUANTITIES), None)), "what is evaluated", ())
    rows: str = key(choice(_ROWS), "rows of the rotational constraint of parametric joints", "regular")
    derivative: str = key(choice(DERIVATIVES), "derivative of parametric joints", "exact")


@dataclass(frozen=True, slots=True)
class SceneEntry(Entry):
    """A mechanism."""

    name: str | None = key(TEXT, "name of the routines, a C identifier of at most 40 signs", is_required=True)
    gravity: Vector = key(vector("m/s^2"), "acceleration of gravity in m/s^2, world axes", ZERO_VECTOR)
    motion: str = key(choice(MOTIONS), "planar: reduced to the plane across the joint axes", "spatial")
    assemble: bool = key(FLAG, "whether the pose at t = 0 is a guess and joints may be open in it", False)
    copies: CopiesEntry | None = key(table_of(CopiesEntry), "the mechanism several times")
    body: tuple[BodyEntry, ...] = key(tables(BodyEntry, 1), "bodies", (), is_required=True)
    joint: tuple[JointEntry, ...] = key(tables(JointEntry), "joints", ())
    spring: tuple[SpringEntry, ...] = key(tables(SpringEntry), "springs and dampers between points", ())
    torque: tuple[TorqueEntry, ...] = key(tables(TorqueEntry), "constant torques on bodies", ())
    force: tuple[ForceEntry, ...] = key(tables(ForceEntry), "constant forces on bodies", ())
    output: OutputEntry | None = key(table_of(OutputEntry), "what is generated")


def kinds_of_tables() -> Iterator[type[Entry]]:
    """All tables, the file itself first."""
    yield from (SceneEntry, CopiesEntry, BodyEntry, JointEntry, DriveEntry, LimitEntry)
    yield from (SpringEntry, TorqueEntry, ForceEntry, OutputEntry)
