"""The keys of a chain file, each with its kind, unit, meaning and default: what is read and what the schema says."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.chain import BASE, BASES, CHAIN_QUANTITIES, JOINT_TYPES
from codegen.spec.chain_file.angle import ANGLE
from codegen.spec.chain_file.joint_type import JOINT_TYPE
from codegen.spec.scene import ZERO_VECTOR, Matrix, Vector
from codegen.spec.scene_file.entries import LimitEntry
from codegen.spec.scene_file.entry import Entry, key, table_of, tables
from codegen.spec.scene_file.values import FLAG, TEXT, choice, inertia, number, or_zero, pair, several, vector, whole

_NONE = Fraction(0)
_AXES = ("effector", "world")
_DIRECTIONS = ("either", "growing", "falling")


@dataclass(frozen=True, slots=True)
class RowEntry(Entry):
    """The six constants that place a frame on a link (S2 Table 1)."""

    psi: Fraction = key(or_zero(ANGLE), "about z of the link, from its x to the common normal, in rad", _NONE)
    c: Fraction = key(or_zero(number("m")), "along z of the link, from its x to the common normal, in m", _NONE)
    alpha: Fraction = key(
        or_zero(ANGLE), "about the common normal, from z of the link to z of the frame, in rad", _NONE
    )
    a: Fraction = key(
        or_zero(number("m")), "along the common normal, from z of the link to z of the frame, in m", _NONE
    )
    theta: Fraction = key(or_zero(ANGLE), "about z of the frame, from the common normal to its x, in rad", _NONE)
    d: Fraction = key(or_zero(number("m")), "along z of the frame, from the common normal to its x, in m", _NONE)


@dataclass(frozen=True, slots=True)
class LinkEntry(RowEntry):
    """A link with its inner joint; the joint's coordinate, theta or d, has its value at t = 0 in the row.

    Of a screw the coordinate is theta, and d moves with it.
    """

    name: str | None = key(TEXT, f'a text of 1 to 60 signs, unique among the links, not "{BASE}"', is_required=True)
    parent: str | None = key(TEXT, f'name of a link above in the file, or "{BASE}"', is_required=True)
    type: str | None = key(JOINT_TYPE, f"one of {', '.join(JOINT_TYPES)}", is_required=True)
    pitch: Fraction = key(number("m/rad"), "screw: advance in m/rad, not 0; negative for a left-hand thread", _NONE)
    mass: Fraction = key(number("kg"), "mass in kg; 0 for a massless link", _NONE)
    centre: Vector = key(or_zero(vector("m")), "centre of mass in m from the origin of the link, its axes", ZERO_VECTOR)
    inertia: Matrix | None = key(
        or_zero(inertia()),
        "inertia in kg m^2 about the centre of mass, axes of the link: three principal values or three rows of three",
    )
    rotor: Fraction = key(
        number("kg m^2 or kg"), "inertia of a drive as the coordinate feels it, gear ratio squared times its own", _NONE
    )
    effective: bool = key(
        FLAG, "whether the inertia is not that of one body: moments in a plane, identified ones, with a drive's", False
    )
    prefer: Fraction | None = key(
        ANGLE, "value of a dependent coordinate in rad or m from which the loops are closed, to choose the branch"
    )


@dataclass(frozen=True, slots=True)
class FrameEntry(RowEntry):
    """A frame on a link."""

    link: str | None = key(TEXT, f'name of a link, or "{BASE}"', is_required=True)


@dataclass(frozen=True, slots=True)
class CutEntry(Entry):
    """A cut link: two frames that coincide when the loop is closed."""

    name: str | None = key(TEXT, "a text of 1 to 60 signs, unique among the cuts", is_required=True)
    base: FrameEntry | None = key(table_of(FrameEntry), "frame C, on the side nearer the base", is_required=True)
    far: FrameEntry | None = key(table_of(FrameEntry), "frame R, on the far side", is_required=True)


@dataclass(frozen=True, slots=True)
class EffectorEntry(FrameEntry):
    """An end effector: a frame on a link, and a constant wrench there."""

    name: str | None = key(TEXT, "a text of 1 to 60 signs, unique among the effectors", is_required=True)
    force: Vector = key(vector("N"), "constant force on the chain in N, axes of the effector", ZERO_VECTOR)
    moment: Vector = key(vector("N m"), "constant moment on the chain in N m, likewise", ZERO_VECTOR)


@dataclass(frozen=True, slots=True)
class HarmonicEntry(Entry):
    """A motion: mean + speed t + amplitude sin(frequency t + phase)."""

    mean: Fraction = key(ANGLE, "mean in rad or m", _NONE)
    amplitude: Fraction | None = key(ANGLE, "amplitude in rad or m", is_required=True)
    frequency: Fraction | None = key(ANGLE, "angular frequency in rad/s", is_required=True)
    phase: Fraction = key(ANGLE, "phase in rad", _NONE)
    speed: Fraction = key(ANGLE, "rate of the mean in rad/s or m/s", _NONE)


@dataclass(frozen=True, slots=True)
class IndependentEntry(Entry):
    """An independent coordinate with its motion, or with its position and speed at t = 0."""

    joint: str | None = key(TEXT, "name of the link whose coordinate it is", is_required=True)
    polynomial: tuple[Fraction, ...] = key(
        whole(several(ANGLE, None, "coefficient")), "motion: coefficients of 1, t, t^2, ... in rad or m", ()
    )
    harmonic: HarmonicEntry | None = key(table_of(HarmonicEntry), "motion: a sine")
    table: str | None = key(TEXT, "motion: name of a CSV file of t in s and the coordinate in rad or m")
    position: Fraction | None = key(ANGLE, "value at t = 0 in rad or m, for forward dynamics")
    speed: Fraction | None = key(ANGLE, "rate at t = 0 in rad/s or m/s, for forward dynamics")
    driven: bool = key(FLAG, "whether the motion is prescribed in forward dynamics too", False)


@dataclass(frozen=True, slots=True)
class ConditionEntry(Entry):
    """When a force acts: the range of a coordinate and the direction in which it moves."""

    joint: str | None = key(TEXT, "name of the link whose coordinate is asked", is_required=True)
    lower: Fraction | None = key(ANGLE, "least value in rad or m")
    upper: Fraction | None = key(ANGLE, "greatest value in rad or m")
    direction: str = key(choice(_DIRECTIONS), f"one of {', '.join(_DIRECTIONS)}", "either")

    @property
    def sign(self) -> int:
        """1 while the coordinate grows, -1 while it falls, 0 for either."""
        return {"either": 0, "growing": 1, "falling": -1}[self.direction]


@dataclass(frozen=True, slots=True)
class ForceEntry(Entry):
    """A force on a coordinate, or a wrench at an effector; always, or under a condition."""

    joint: str | None = key(TEXT, "name of the link on whose coordinate it acts")
    constant: Fraction = key(number("N or N m"), "joint: constant part in N or N m", _NONE)
    stiffness: Fraction = key(number("N/m or N m/rad"), "joint: spring in N/m or N m/rad", _NONE)
    damping: Fraction = key(number("N s/m or N m s/rad"), "joint: damper in N s/m or N m s/rad", _NONE)
    rest: Fraction = key(ANGLE, "joint: value in rad or m at which the spring is free", _NONE)
    effector: str | None = key(TEXT, "name of the effector at which it acts")
    force: Vector = key(vector("N"), "effector: force on the chain in N, axes of the effector", ZERO_VECTOR)
    moment: Vector = key(vector("N m"), "effector: moment on the chain in N m, likewise", ZERO_VECTOR)
    axes: str = key(
        choice(_AXES), "effector: axes of force and moment: effector, or world, those of frame 0", "effector"
    )
    when: ConditionEntry | None = key(table_of(ConditionEntry), "condition under which it acts")


@dataclass(frozen=True, slots=True)
class SpringEntry(Entry):
    """A spring and damper between the origins of two effectors."""

    effectors: tuple[str, str] | None = key(
        pair(TEXT), "names of the two effectors between which it acts", is_required=True
    )
    stiffness: Fraction = key(number("N/m"), "stiffness in N/m", _NONE)
    damping: Fraction = key(number("N s/m"), "damping in N s/m", _NONE)
    length: Fraction = key(number("m"), "length in m at which it is free", _NONE)


@dataclass(frozen=True, slots=True)
class StopEntry(LimitEntry):
    """Soft stops of a coordinate: a spring and damper beyond its bounds."""

    lower: Fraction | None = key(ANGLE, "bound in rad or m below which they act")
    upper: Fraction | None = key(ANGLE, "bound in rad or m above which they act")
    joint: str | None = key(TEXT, "name of the link on whose coordinate they act", is_required=True)


@dataclass(frozen=True, slots=True)
class QuantitiesEntry(Entry):
    """What is generated; everything that the chain has if it is left out."""

    quantities: tuple[str, ...] = key(whole(several(choice(CHAIN_QUANTITIES), None)), "what is evaluated", ())


@dataclass(frozen=True, slots=True)
class ChainEntry(Entry):
    """A complex kinematic chain."""

    name: str | None = key(TEXT, "name of the routines, a C identifier of at most 40 signs", is_required=True)
    gravity: Vector = key(vector("m/s^2"), "acceleration of gravity in m/s^2, axes of the base", ZERO_VECTOR)
    base: str = key(choice(BASES), "moving: pose, velocity and acceleration of the base are inputs", "fixed")
    assemble: bool = key(FLAG, "whether the coordinates in the rows are guesses and cuts may be open with them", False)
    link: tuple[LinkEntry, ...] = key(tables(LinkEntry, 1), "links, parents before children", (), is_required=True)
    cut: tuple[CutEntry, ...] = key(tables(CutEntry), "cut links", ())
    effector: tuple[EffectorEntry, ...] = key(tables(EffectorEntry), "end effectors", ())
    independent: tuple[IndependentEntry, ...] = key(tables(IndependentEntry), "independent coordinates", ())
    force: tuple[ForceEntry, ...] = key(tables(ForceEntry), "forces", ())
    spring: tuple[SpringEntry, ...] = key(tables(SpringEntry), "springs between effectors", ())
    stop: tuple[StopEntry, ...] = key(tables(StopEntry), "soft stops of coordinates", ())
    output: QuantitiesEntry | None = key(table_of(QuantitiesEntry), "what is generated")


def kinds_of_tables() -> Iterator[type[Entry]]:
    """All tables, the file itself first."""
    yield from (ChainEntry, LinkEntry, FrameEntry, CutEntry, EffectorEntry, HarmonicEntry, IndependentEntry)
    yield from (ConditionEntry, ForceEntry, SpringEntry, StopEntry, QuantitiesEntry)
