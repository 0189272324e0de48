"""What acts on the coordinates of a joint, one for each degree of freedom: forces, springs, dampers, drives, stops."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from codegen.errors import Mistake
from codegen.spec.scene import COORDINATE_UNITS, Coordinate, Drive, Limit
from codegen.spec.scene_file.entries import DriveEntry, JointEntry, LimitEntry
from codegen.spec.scene_file.text import shown

_LOADS = ("torque", "stiffness", "damping", "rest", "drive", "limit")

_NOTHING = ((), (Fraction(0),))
"""What acts on no coordinate, however many there are: a single 0 is one for each."""


def coordinate_mistakes(entry: JointEntry) -> Iterator[Mistake]:
    """Check what acts on the coordinates of a joint of known type."""
    given = [key for key in _LOADS if key in entry.given and getattr(entry, key) not in _NOTHING]
    units = COORDINATE_UNITS[entry.type or ""]
    for key in given:
        yield from _count_mistakes(key, len(getattr(entry, key)), units, entry)
    for key in ("stiffness", "damping"):
        for value in getattr(entry, key):
            if value is not None and value < 0:
                yield Mistake(f"{entry.place}: {key}", f"is {shown(value)}", "give 0 or more")
    for drive in entry.drive:
        if drive is not None:
            yield from _drive_mistakes(drive)
    for limit in entry.limit:
        if limit is not None:
            yield from limit_mistakes(limit)
    if any(coordinate.rest and not coordinate.stiffness for coordinate in make_coordinates(entry)):
        yield Mistake(
            f"{entry.place}: rest", "there is no spring on this coordinate", "give stiffness, or leave rest out"
        )
    if entry.form == "conventional" and any(coordinate.is_loaded for coordinate in make_coordinates(entry)):
        what = "acts on the joint coordinate, which the conventional form does not have"
        yield Mistake(f"{entry.place}: {', '.join(given)}", what, "use form auto or parametric")


def make_coordinates(entry: JointEntry) -> tuple[Coordinate, ...]:
    """Make the coordinates of a joint without mistakes, as many as it has degrees of freedom."""
    return _coordinates(entry, len(COORDINATE_UNITS[entry.type or ""]))


def _count_mistakes(key: str, count: int, units: tuple[str, ...], entry: JointEntry) -> Iterator[Mistake]:
    place = f"{entry.place}: {key}"
    if not units:
        yield Mistake(place, f"a {entry.type} joint has no coordinate", f"leave {key} out")
    elif count != len(units):
        freedoms = "1 degree of freedom" if len(units) == 1 else f"{len(units)} degrees of freedom"
        what = f"has {count} {'entry' if count == 1 else 'entries'} for {freedoms}"
        none = ", {} for none" if key in ("drive", "limit") else ""
        yield Mistake(place, what, f"give one for each of the coordinates, in {', '.join(units)}{none}")


def _drive_mistakes(drive: DriveEntry) -> Iterator[Mistake]:
    """Check that a sine is whole."""
    if drive.amplitude and not drive.frequency and "frequency" not in drive.wrong:
        yield Mistake(f"{drive.place}: amplitude", "there is no frequency", "give frequency in rad/s, not 0")
    for key in ("frequency", "phase"):
        if getattr(drive, key) and not drive.amplitude and "amplitude" not in drive.wrong:
            yield Mistake(f"{drive.place}: {key}", "there is no amplitude", f"give amplitude, or leave {key} out")


def limit_mistakes(limit: LimitEntry) -> Iterator[Mistake]:
    """Check soft stops."""
    if not {"lower", "upper"} & limit.given:
        yield Mistake(limit.place, "has neither lower nor upper", "give at least one of them")
    if limit.lower is not None and limit.upper is not None and limit.lower >= limit.upper:
        what = f"lower, {shown(limit.lower)}, is not below upper, {shown(limit.upper)}"
        yield Mistake(limit.place, what, "give lower < upper")
    if limit.stiffness is not None and limit.stiffness <= 0:
        yield Mistake(f"{limit.place}: stiffness", f"is {shown(limit.stiffness)}", "give a stiffness above 0")
    if limit.damping < 0:
        yield Mistake(f"{limit.place}: damping", f"is {shown(limit.damping)}", "give 0 or more")


def _coordinates(entry: JointEntry, freedoms: int) -> tuple[Coordinate, ...]:
    return tuple(
        Coordinate(
            torque=_value(entry.torque, k),
            stiffness=_value(entry.stiffness, k),
            damping=_value(entry.damping, k),
            rest=_value(entry.rest, k),
            drive=_drive(entry.drive[k] if k < len(entry.drive) else None),
            limit=_limit(entry.limit[k] if k < len(entry.limit) else None),
        )
        for k in range(freedoms)
    )


def _value(values: tuple[Fraction | None, ...], k: int) -> Fraction:
    return (values[k] if k < len(values) else None) or Fraction(0)


def _drive(entry: DriveEntry | None) -> Drive | None:
    if entry is None:
        return None
    none = Fraction(0)
    return Drive(entry.position or none, entry.speed or none, entry.amplitude, entry.frequency, entry.phase)


def _limit(entry: LimitEntry | None) -> Limit | None:
    return None if entry is None else make_limit(entry)


def make_limit(entry: LimitEntry) -> Limit:
    """Make soft stops of an entry without mistakes."""
    return Limit(entry.lower, entry.upper, entry.stiffness or Fraction(0), entry.damping)
