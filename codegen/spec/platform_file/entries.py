"""The keys of a platform file, each with its kind, unit, meaning and default."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.platform import ATTITUDES, EULER_ORDERS, LEGS, QUANTITIES, UNITS, VARIANTS
from codegen.spec.scene import Matrix, Quaternion, Vector
from codegen.spec.scene_file.entry import Entry, key, table_of, tables
from codegen.spec.scene_file.values import QUATERNION, TEXT, Kind, choice, number, several, vector, whole

_UNIT = "the unit of the file"

Points = tuple[tuple[Fraction, ...], ...]
"""Three rows, one column a point."""


def _points() -> Kind[Points]:
    """Three rows of equal length."""
    return whole(several(whole(several(number(_UNIT), None, "leg")), 3, "row"))


@dataclass(frozen=True, slots=True)
class PoseEntry(Entry):
    """A pose of the platform: its origin, and its attitude in one of three ways."""

    position: Vector | None = key(vector(_UNIT), "origin of the platform in base axes", is_required=True)
    quaternion: Quaternion | None = key(QUATERNION, "attitude, platform to base: w x y z, of norm 1")
    rotation: Matrix | None = key(
        whole(several(vector(), 3, "row")), "instead: rotation matrix, platform to base, three rows"
    )
    euler: str | None = key(
        choice(EULER_ORDERS),
        "instead: order of Euler angles; capital letters turn about axes of the platform, small ones about axes of the "
        "base",
    )
    angles: Vector | None = key(vector("rad"), "with euler: the angles in rad, in its order")


@dataclass(frozen=True, slots=True)
class IndicesEntry(Entry):
    """What is generated."""

    quantities: tuple[str, ...] = key(whole(several(choice(QUANTITIES), None)), "what is evaluated", ())
    variant: str = key(choice(tuple(VARIANTS)), "how the indices are evaluated", "robust")
    attitude: str = key(choice(ATTITUDES), "how routines take the attitude", "matrix")


@dataclass(frozen=True, slots=True)
class PlatformEntry(Entry):
    """A platform on six legs."""

    name: str | None = key(TEXT, "name of the routines, a C identifier of at most 40 signs", is_required=True)
    unit: str = key(choice(tuple(UNITS)), "unit of all lengths in the file; routines take and give m", "m")
    base: Points | None = key(
        _points(), f"joints of the {LEGS} legs on the base, base axes: rows x, y, z, one column a leg", is_required=True
    )
    platform: Points | None = key(
        _points(), f"joints of the {LEGS} legs on the platform, platform axes: rows x, y, z", is_required=True
    )
    home: PoseEntry | None = key(table_of(PoseEntry), "pose that grids and pictures start from", is_required=True)
    poses: tuple[PoseEntry, ...] = key(tables(PoseEntry), "further poses", ())
    output: IndicesEntry | None = key(table_of(IndicesEntry), "what is generated")


KINDS_OF_TABLES: tuple[type[Entry], ...] = (PlatformEntry, PoseEntry, IndicesEntry)
"""All tables, the file itself first."""
