"""Which parts of a scene are equal, so that each is lowered once and run for all instances.

Sections (`codegen.spec.sections`) are of one kind if they are alike and their joints have the same forms and rows. The
coordinates of attachments in which instances differ, such as those on the ground, are read at run time.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate

from codegen.ir.looped import SHARED, Axis, Segment
from codegen.ir.ops import Constant
from codegen.mechanics.assembly import KINDS, Assembly
from codegen.mechanics.forces import FORCES
from codegen.mechanics.system import System
from codegen.spec.sections import Section, differing, likeness, repeated, sections

_ARGUMENTS = {
    "r": "positions",
    "A": "attitudes",
    "alpha": "coordinates",
    "revolutions": "revolutions",
    "velocity": "displacements",
    "lambda": "constraints",
    "t": "one",
    "cj": "one",
    "y": "state",
    "ydot": "state",
}
"""What the entries of an argument are."""

_OUTPUTS = {
    **KINDS,
    **FORCES,
    "orthonormalise": ("attitudes", "one"),
    "check_orthonormal": ("bodies", "one"),
    "mass": ("displacements", "displacements"),
    "residual": ("state", "one"),
    "jacobian": ("state", "state"),
}
"""What the rows and columns of an output are."""


@dataclass(frozen=True)
class Series:
    """Instances of one kind at equal distances.

    Attributes:
        kind: number of the kind.
        first: the first instance, as a scene of its own.
        sections: of the instances.
        axes: what the entries are -> those of an instance in the whole.
        geometry: what differs, instance by instance.
    """

    kind: int
    first: System
    sections: tuple[Section, ...]
    axes: Mapping[str, Axis]
    geometry: tuple[tuple[Constant, ...], ...]

    def argument(self, name: str) -> Axis:
        """The entries of an argument."""
        return self.axes[_ARGUMENTS[name]]

    def output(self, name: str) -> tuple[Axis, Axis]:
        """The rows and columns of an output."""
        rows, columns = _OUTPUTS[name]
        return self.axes[rows], self.axes[columns]


@dataclass(frozen=True)
class Plan:
    """The kinds of a scene and their instances.

    Attributes:
        kinds: of each kind its first instance, as a scene of its own.
        series: all instances.
        sizes: what the entries are -> their number in the whole.
    """

    kinds: tuple[System, ...]
    series: tuple[Series, ...]
    sizes: Mapping[str, int]

    def argument_length(self, name: str) -> int:
        """Entries of an argument of the whole."""
        return self.sizes[_ARGUMENTS[name]]

    def output_shape(self, name: str) -> tuple[int, int]:
        """Rows and columns of an output of the whole."""
        rows, columns = _OUTPUTS[name]
        return self.sizes[rows], self.sizes[columns]


def parts_of(assembly: Assembly) -> tuple[Assembly, ...]:
    """Give the sections of a scene as scenes of their own."""
    return _Planning(assembly).parts


def plan(assembly: Assembly, is_condensed: bool = False) -> Plan:
    """Find the kinds of a scene.

    Args:
        assembly: the scene.
        is_condensed: whether states leave out what `codegen.mechanics.condensed.Condensed` says.
    """
    return _Planning(assembly).plan(is_condensed)


class _Planning:
    """A plan in the making."""

    def __init__(self, assembly: Assembly) -> None:
        self._whole = assembly
        self._sections = sections(assembly.scene)
        self._scenes = [section.scene(assembly.scene) for section in self._sections]
        self.parts = tuple(Assembly(scene, assembly.forms, self._dropped(k)) for k, scene in enumerate(self._scenes))
        numbers: dict[object, int] = {}
        self._kinds = [numbers.setdefault(self._key(part), len(numbers)) for part in self.parts]
        members: dict[int, list[int]] = {}
        for k, kind in enumerate(self._kinds):
            members.setdefault(kind, []).append(k)
        self._members = members.values()

    def plan(self, is_condensed: bool) -> Plan:
        """Put everything together."""
        systems, values = [], dict[int, tuple[Constant, ...]]()
        for members in self._members:
            varying, numbers = differing([self._scenes[k] for k in members])
            systems.append(System(replace(self.parts[members[0]], varying=varying)))
            values |= {k: tuple(map(Constant, row)) for k, row in zip(members, numbers, strict=True)}
        lengths = [_lengths(system, is_condensed) for system in systems]
        starts = self._starts(lengths)
        series = []
        for places in repeated(self._kinds):
            kind = self._kinds[places[0]]
            axes = {name: _axis(lengths[kind][name], starts[name], places) for name in lengths[kind]}
            found = tuple(self._sections[k] for k in places)
            geometry = tuple(values[k] for k in places)
            first = System(self.parts[places[0]])
            series.append(Series(kind, first, found, axes | {"one": SHARED}, geometry))
        sizes = {name: sum(sum(lengths[kind][name]) for kind in self._kinds) for name in lengths[0]}
        return Plan(tuple(systems), tuple(series), sizes | {"one": 1})

    @staticmethod
    def _key(part: Assembly) -> object:
        return likeness(part.scene), tuple(part.forms[joint.name] for joint in part.scene.joints), part.dropped

    @cached_property
    def _first_rows(self) -> list[int]:
        return [placed.ends.first_row for placed in self._whole.placed] + [self._whole.all_rows]

    def _dropped(self, number: int) -> frozenset[int]:
        joints = self._sections[number].joints
        first, last = self._first_rows[joints.start], self._first_rows[joints.stop]
        return frozenset(row - first for row in range(first, last) if row in self._whole.dropped)

    def _starts(self, lengths: Sequence[Mapping[str, Sequence[int]]]) -> dict[str, list[list[int]]]:
        """What the entries are -> segment by segment the place of the first entry of each section."""
        found: dict[str, list[list[int]]] = {}
        for name in lengths[0]:
            base = 0
            for s in range(len(lengths[0][name])):
                ends = list(accumulate((lengths[kind][name][s] for kind in self._kinds), initial=base))
                found.setdefault(name, []).append(ends[:-1])
                base = ends[-1]
        return found


def _axis(lengths: Sequence[int], starts: Sequence[Sequence[int]], places: range) -> Axis:
    segments = []
    for length, places_of in zip(lengths, starts, strict=True):
        if length:
            start = places_of[places[0]]
            stride = places_of[places[1]] - start if len(places) > 1 else length
            segments.append(Segment(length, start, stride))
    return tuple(segments)


def _lengths(system: System, is_condensed: bool) -> dict[str, tuple[int, ...]]:
    """What the entries are -> number of those in each segment: of bodies, then of joint coordinates; or of rows."""
    assembly = system.assembly
    arrays, bodies, coordinates = assembly.arrays, len(assembly.scene.bodies), assembly.coordinates
    displacements = (arrays.displacements * bodies, coordinates)
    rows = (len(assembly.rows), len(system.drives))
    positions = ((3 if arrays.is_planar else 7) * bodies, coordinates)
    left_out = len(system.condensed.rows) if is_condensed else 0
    rates = (displacements[0], displacements[1] - left_out)
    multipliers = (rows[0] - left_out, rows[1])
    return {
        "positions": (arrays.position * bodies,),
        "attitudes": (arrays.attitude * bodies,),
        "bodies": (bodies,),
        "joints": (len(assembly.placed),),
        "coordinates": (coordinates,),
        "revolutions": (assembly.counted,),
        "displacements": displacements,
        "constraints": rows,
        "state": (*positions, *rates, *multipliers, *multipliers),
    }
