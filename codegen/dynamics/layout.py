"""What the entries of the state vector of an implicit integrator are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import accumulate

from codegen.mechanics.condensed import Condensed
from codegen.mechanics.derivation import is_matrix
from codegen.mechanics.frames import d_ij, dp_ij, e_ij, ep_ij
from codegen.mechanics.joints import JOINTS
from codegen.mechanics.placed import Placed
from codegen.mechanics.system import System

FORMS = ("index2", "index1", "condensed")
"""Stabilised index 2 after Gear, Gupta and Leimkuhler; index 1 after Baumgarte; index 2 without what
`codegen.mechanics.condensed` says."""


Entry = tuple[str, str]
"""Name and unit."""


@dataclass(frozen=True, slots=True)
class Layout:
    """The layout of ``y``, and of the residual's rows.

    Attributes:
        positions: of each body ``r`` (centre of mass, world) and its Euler parameters ``w x y z``, in the plane ``x``,
            ``y`` and the angle; then the joint coordinates alpha.
        velocities: of each body ``v`` (world) and ``omega`` (body axes), in the plane its one component; then the
            rates of alpha.
        multipliers: ``lambda``, in the order of the rows.
        corrections: ``mu``, in the order of the rows; empty at index 1.
        names: of the entries.
        units: of the entries.
        coordinates: the joint coordinates among the positions.
        condensed: joint coordinates whose rates, and rows whose multipliers and corrections, are no entries.
        places: number of each entry among all that there are without condensation.
    """

    positions: range
    velocities: range
    multipliers: range
    corrections: range
    names: tuple[str, ...]
    units: tuple[str, ...]
    coordinates: range
    condensed: Condensed
    places: tuple[int, ...]

    @property
    def size(self) -> int:
        """Number of entries."""
        return self.corrections.stop

    @property
    def is_differential(self) -> tuple[bool, ...]:
        """Whether the derivative of an entry is in the residual.

        That of positions and velocities is, but for joint coordinates that the constraints alone determine.
        """
        algebraic = {self.coordinates[k] for k in self.condensed.coordinates}
        return tuple(k < self.velocities.stop and k not in algebraic for k in range(self.size))


def layout(system: System, form: str) -> Layout:
    """Lay out the state of a system.

    Args:
        system: the mechanism.
        form: one of `FORMS`.
    """
    condensed = system.condensed if form == "condensed" else Condensed()
    positions, rates = [*_positions(system)], [*_velocities(system)]
    multipliers = [*_multipliers(system, "lambda", "N", "N m")]
    corrections = [] if form == "index1" else [*_multipliers(system, "mu", "m/s", "1/s")]
    alphas = system.assembly.coordinates
    first = len(rates) - alphas
    entries = [
        _kept(positions, ()),
        _kept(rates, [first + k for k in condensed.coordinates]),
        _kept(multipliers, condensed.rows),
        _kept(corrections, condensed.rows),
    ]
    lengths = (len(positions), len(rates), len(multipliers))
    starts, ends = (list(accumulate(sizes, initial=0)) for sizes in (lengths, map(len, entries)))
    places = [start + k for start, group in zip(starts, entries, strict=True) for k, _ in group]
    names, units = zip(*(entry for group in entries for _, entry in group), strict=True)
    return Layout(
        range(ends[0], ends[1]),
        range(ends[1], ends[2]),
        range(ends[2], ends[3]),
        range(ends[3], ends[4]),
        names,
        units,
        range(ends[1] - alphas, ends[1]),
        condensed,
        tuple(places),
    )


def _kept(entries: Sequence[Entry], left_out: Sequence[int]) -> list[tuple[int, Entry]]:
    """Entries with their numbers, without those that are left out."""
    missing = frozenset(left_out)
    return [(k, entry) for k, entry in enumerate(entries) if k not in missing]


def whole(system: System, layout_: Layout) -> Layout:
    """The layout of all entries, of a state that may leave some out."""
    if not layout_.condensed.coordinates:
        return layout_
    return layout(system, "index2")


def _positions(system: System) -> Iterator[Entry]:
    is_planar = system.assembly.arrays.is_planar
    for body in system.assembly.scene.bodies:
        yield from ((f"{body.name}.r{axis}", "m") for axis in ("xy" if is_planar else "xyz"))
        if is_planar:
            yield f"{body.name}.angle", "rad"
        else:
            yield from ((f"{body.name}.q{axis}", "1") for axis in "wxyz")
    yield from _coordinates(system, "alpha", "")


def _velocities(system: System) -> Iterator[Entry]:
    is_planar = system.assembly.arrays.is_planar
    for body in system.assembly.scene.bodies:
        yield from ((f"{body.name}.v{axis}", "m/s") for axis in ("xy" if is_planar else "xyz"))
        yield from ((f"{body.name}.w{axis}", "rad/s") for axis in ("z" if is_planar else "xyz"))
    yield from _coordinates(system, "alphadot", "/s")


def _coordinates(system: System, word: str, per: str) -> Iterator[Entry]:
    for placed in system.assembly.placed:
        joint = JOINTS[placed.joint.type]
        translations = 0 if joint.is_screw else joint.translations
        for k in range(placed.form.coordinates):
            unit = "m" if k < translations else "rad"
            yield f"{placed.joint.name}.{word}{k + 1}", unit + per


def _multipliers(system: System, word: str, of_length: str, of_angle: str) -> Iterator[Entry]:
    """Multipliers of rows in m, and of rows that are plain numbers or rad."""
    first = 0
    for placed in system.assembly.placed:
        for k, is_length in enumerate(_is_length(placed)):
            if first + k not in system.assembly.dropped:
                yield f"{placed.joint.name}.{word}{k + 1}", of_length if is_length else of_angle
        first += placed.form.row_count
    coordinates = dict(enumerate(_coordinates(system, "alpha", "")))
    for driven in system.drives:
        _, unit = coordinates[driven.alpha]
        yield f"drive of {driven.joint}.{word}", of_length if unit == "m" else of_angle


def _is_length(placed: Placed) -> Iterator[bool]:
    for row in placed.form.rows:
        for _ in range(3 if is_matrix(row) else 1):
            yield is_matrix(row) or row.has(d_ij, e_ij, dp_ij, ep_ij)
