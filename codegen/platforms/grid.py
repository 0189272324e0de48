"""Poses of a sweep: a grid in words (``x=-0.3:0.3:61,yaw=-20deg:20deg:41``), or a file of numbers."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from functools import reduce
from itertools import islice
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.platforms.attitudes import Array, argument_name, attitude_array
from codegen.platforms.csv_table import table_of_csv
from codegen.platforms.headings import heading_mistakes
from codegen.platforms.spool import pieces
from codegen.spec.placement import IDENTITY
from codegen.spec.platform import Platform

TRANSLATIONS = ("x", "y", "z")
ROTATIONS = ("roll", "pitch", "yaw")

_TURNS = "ZYX"
"""Yaw, pitch and roll as an Euler order."""

_MOST = 10**10
"""Poses that a grid may have."""

_TOLERANCE = 1e-6
"""Departure from the norm 1, or from R R' = I, of an attitude in a file."""


@dataclass(frozen=True)
class Poses:
    """Poses that are made piece by piece.

    Attributes:
        count: how many.
        names: of the columns that tell a pose in the results.
        axes: of a grid, the values along each axis, the last one the fastest.
        table: of a file, [poses, columns]; mapped where it is one of numbers already.
    """

    count: int
    names: tuple[str, ...]
    axes: tuple[Array, ...] = ()
    table: Array | None = None

    def columns(self, first: int, last: int) -> Array:
        """The told numbers [columns, poses] of some poses."""
        if self.table is not None:
            return np.ascontiguousarray(self.table[first:last].T, dtype=np.float64)
        sizes = [len(axis) for axis in self.axes]
        places = np.unravel_index(np.arange(first, last), sizes)
        return np.array([axis[place] for axis, place in zip(self.axes, places, strict=True)])

    def arguments(self, platform: Platform, first: int, last: int) -> Mapping[str, Array]:
        """The arguments [entries, poses] of the routines for some poses."""
        told, attitude = self.columns(first, last), platform.wanted.attitude
        if self.table is not None:
            return {"o": told[:3], argument_name(attitude): told[3:]}
        home = [float(x) for x in platform.home.position]
        given = dict(zip(self.names, told, strict=True))
        count = last - first
        o = np.array([given.get(name, np.full(count, value)) for name, value in zip(TRANSLATIONS, home, strict=True)])
        turns = np.array([given.get(name, np.zeros(count)) for name in reversed(ROTATIONS)])
        if attitude == _TURNS and _is_unturned(platform):
            return {"o": o, "angles": turns}
        at_home = Rotation.from_matrix([[float(x) for x in row] for row in platform.home.rotation])
        rotations = (Rotation.from_euler(_TURNS, turns.T) * at_home).as_matrix()
        return {"o": o, argument_name(attitude): attitude_array(attitude, rotations)}


def for_grid(platform: Platform) -> Platform:
    """The platform with the attitude that grids are evaluated in: without a detour where home is not turned."""
    attitude = _TURNS if _is_unturned(platform) else "matrix"
    return replace(platform, wanted=replace(platform.wanted, attitude=attitude))


def _is_unturned(platform: Platform) -> bool:
    return platform.home.rotation == IDENTITY


def grid(text: str) -> Poses:
    """Read a grid: axes ``x y z`` in m and ``roll pitch yaw`` (about axes of the base, in this order) in rad or deg.

    ``x=a:b:n`` is n values from a to b, ``x=a`` is one; what is left out is as at home.

    Raises:
        SpecificationError: all mistakes at once.
    """
    mistakes: list[Mistake] = []
    axes = dict(_axes(text, mistakes))
    count = reduce(lambda product, axis: product * len(axis), axes.values(), 1)
    if count > _MOST:
        mistakes.append(Mistake("--grid", f"has {count} poses", f"give at most {_MOST}"))
    if mistakes:
        raise SpecificationError(mistakes)
    return Poses(count, tuple(axes), tuple(axes.values()))


def poses_of_file(file: Path, platform: Platform) -> Poses:
    """Read poses: CSV or npy, columns o (3), then the attitude as the routines take it.

    Raises:
        SpecificationError: the file cannot be read, names of its columns say another order, or an attitude is none;
            the first ten mistakes at once.
    """
    name = argument_name(platform.wanted.attitude)
    entries = {"R": 9, "q": 4, "angles": 3}[name]
    table = _table(file)
    if table.ndim != 2 or table.shape[1] != 3 + entries:
        what = f"has {table.shape[1] if table.ndim == 2 else 0} columns"
        order = ", column by column" if name == "R" else ""
        remedy = f"give {3 + entries}: x y z in m, then {name} ({entries}{order}); attitude under [output] says which"
        raise SpecificationError([Mistake(str(file), what, remedy)])
    contradicted = heading_mistakes(file, platform.wanted.attitude) if file.suffix != ".npy" else []
    if contradicted:
        raise SpecificationError(contradicted)
    wrong = (
        first + k
        for first, last in pieces(len(table))
        for k in _wrong_attitudes(name, np.asarray(table[first:last, 3:], dtype=np.float64))
    )
    mistakes = [
        Mistake(f"{file}: pose {k + 1}", f"{name} is no rotation", "correct it, or give more digits")
        for k in islice(wrong, 10)
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    names = ("x", "y", "z", *(f"{name}{k}" for k in range(entries)))
    return Poses(len(table), names, table=table)


def _axes(text: str, mistakes: list[Mistake]) -> Iterator[tuple[str, Array]]:
    seen: set[str] = set()
    for part in text.split(","):
        name, _, numbers = (word.strip() for word in part.partition("="))
        if name not in (*TRANSLATIONS, *ROTATIONS):
            remedy = nearest(name, (*TRANSLATIONS, *ROTATIONS))
            mistakes.append(Mistake("--grid", f'there is no axis "{name}"', remedy))
            continue
        if name in seen:
            mistakes.append(Mistake(f"--grid: {name}", "stands twice", "give each axis once"))
        seen.add(name)
        values = _values(numbers, name in ROTATIONS)
        if values is None:
            remedy = "write first:last:count, such as -0.3:0.3:61, or one number"
            mistakes.append(Mistake(f"--grid: {name}", f'"{numbers}" is no range', remedy))
        else:
            yield name, values


def _values(text: str, is_angle: bool) -> Array | None:
    ends = text.split(":")
    try:
        if len(ends) == 1:
            return np.array([_number(ends[0], is_angle)])
        first, last, count = _number(ends[0], is_angle), _number(ends[1], is_angle), int(ends[2])
    except (ValueError, IndexError):
        return None
    return np.linspace(first, last, count) if len(ends) == 3 and 1 <= count <= _MOST else None


def _number(text: str, is_angle: bool) -> float:
    is_degrees = is_angle and text.endswith("deg")
    value = float(text.removesuffix("deg") if is_degrees else text)
    if not math.isfinite(value):
        raise ValueError(text)
    return math.radians(value) if is_degrees else value


def _table(file: Path) -> Array:
    try:
        if file.suffix != ".npy":
            return table_of_csv(file)
        table: Array = np.load(file, mmap_mode="r", allow_pickle=False)
        if np.can_cast(table.dtype, np.float64, "same_kind"):
            return table
        what = f"holds {table.dtype}, no real numbers"
    except OSError as error:
        what = f"cannot be read ({error.strerror or error})"
    except ValueError as error:
        what = f"is no table of numbers ({error})"
    raise SpecificationError([Mistake(str(file), what, "give a CSV with a line of names first, or an npy file")])


def _wrong_attitudes(name: str, entries: Array) -> list[int]:
    """Numbers of the poses whose attitude is no rotation."""
    with np.errstate(all="ignore"):
        if name == "R":
            R = entries.reshape(-1, 3, 3)
            gap = np.abs(R @ R.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
            is_sound = (gap < _TOLERANCE) & (np.linalg.det(R) > 0)
        elif name == "q":
            is_sound = np.abs((entries**2).sum(axis=1) - 1) < _TOLERANCE
        else:
            is_sound = np.isfinite(entries).all(axis=1)
    return [int(k) for k in np.flatnonzero(~is_sound)]
