"""Rank, redundant rows and degrees of freedom of a mechanism, judged at several consistent poses.

Rows that depend on others at every pose are redundant for good; a rank that drops at some poses only is a singular
configuration. Connected parts are judged one by one, equal ones once. A joint with a prescribed motion is to be
given without it: what the motion takes is one degree of freedom for each of its rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from codegen.measure.assembly import assemble
from codegen.measure.constraints import ConstraintSystem, Pose, scales
from codegen.measure.gaps import Gap
from codegen.measure.lasting import lasting_rows
from codegen.measure.loops import Group, group, loops
from codegen.measure.motion import consistent_poses, finite_freedoms, implied_rows
from codegen.measure.parts import Part, likeness, parts
from codegen.measure.rank import Rank, independent_rows, rank
from codegen.measure.replacements import Suggestion, suggestions
from codegen.measure.threads import one_thread

_NEAR_SINGULAR = 0.03
"""Near a singular pose the smallest singular value that counts is below this part of what it is at the best pose."""


@dataclass(frozen=True, slots=True)
class Verdict:
    """What is found of a connected part; rows and joints by their positions in it.

    Attributes:
        rows: number of constraint rows.
        columns: number of coordinates.
        ranks: at each pose, the given one first.
        rank: the largest of them.
        freedoms: degrees of freedom: motions that can be followed.
        infinitesimal: further directions that no finite motion follows; the part is shaky if there are any.
        redundant: rows that are left out: they follow from the others at every pose.
        is_common: whether the rows that are kept are independent at all regular poses.
        groups: of each loop.
        by_dimensions: redundant rows that follow from special dimensions, beyond those of the loops' groups.
        suggestions: joints to replace.
    """

    rows: int
    columns: int
    ranks: tuple[Rank, ...]
    rank: int
    freedoms: int
    infinitesimal: int
    redundant: tuple[int, ...]
    is_common: bool
    groups: tuple[Group, ...]
    by_dimensions: int
    suggestions: tuple[Suggestion, ...]

    @property
    def is_singular(self) -> bool:
        """Whether the rank drops at the given pose, not at all poses."""
        return self.ranks[0].rank < self.rank

    @property
    def is_clear(self) -> bool:
        """Whether every rank is sure."""
        return all(found.is_clear for found in self.ranks)


@dataclass(frozen=True, slots=True)
class JudgedPart:
    """A connected part by name.

    Attributes:
        bodies: names.
        joints: names.
        row_labels: joint and name of each row.
        verdict: None where the part does not close.
        open_joints: gaps, where it does not close.
    """

    bodies: tuple[str, ...]
    joints: tuple[str, ...]
    row_labels: tuple[tuple[str, str], ...]
    verdict: Verdict | None
    open_joints: tuple[Gap, ...] = ()

    @property
    def redundant(self) -> tuple[tuple[str, str], ...]:
        """Joint and name of each redundant row."""
        return tuple(self.row_labels[row] for row in self.verdict.redundant) if self.verdict else ()


@dataclass(frozen=True, slots=True)
class Mobility:
    """What is found of a mechanism.

    Attributes:
        parts: its connected parts.
        kept: rows of the whole that are kept, in ascending order.
    """

    parts: tuple[JudgedPart, ...]
    kept: tuple[int, ...]

    @property
    def is_closed(self) -> bool:
        """Whether every part closes."""
        return all(part.verdict for part in self.parts)

    @property
    def rows(self) -> int:
        """Number of constraint rows."""
        return sum(len(part.row_labels) for part in self.parts)

    @property
    def columns(self) -> int:
        """Number of coordinates of the parts that close."""
        return sum(part.verdict.columns for part in self.parts if part.verdict)

    @property
    def rank(self) -> int:
        """Rank at a general pose, of the parts that close."""
        return sum(part.verdict.rank for part in self.parts if part.verdict)

    @property
    def freedoms(self) -> int:
        """Degrees of freedom, of the parts that close."""
        return sum(part.verdict.freedoms for part in self.parts if part.verdict)

    @property
    def redundant(self) -> tuple[tuple[str, str], ...]:
        """Joint and name of each redundant row."""
        return tuple(row for part in self.parts for row in part.redundant)


def mobility(system: ConstraintSystem, pose: Pose) -> Mobility:
    """Judge a mechanism.

    Args:
        system: the mechanism, without prescribed motions.
        pose: the given one; it is brought onto the constraints first if it is not there.
    """
    known: dict[object, _Found] = {}
    judged, kept = [], []
    ranges = system.row_ranges()
    with one_thread():
        for part in parts(system):
            found = _judged(part, part.pose(pose), known)
            rows = [row for position in part.joints for row in ranges[position]]
            redundant = found.verdict.redundant if found.verdict else ()
            kept += [row for position, row in enumerate(rows) if position not in redundant]
            judged.append(found)
    return Mobility(tuple(judged), tuple(sorted(kept)))


_Found = Verdict | tuple[tuple[int, Gap], ...]
"""A verdict, or the joints that stay open, by position."""


def _judged(part: Part, pose: Pose, known: dict[object, _Found]) -> JudgedPart:
    key = likeness(part.system, pose)
    joints = tuple(joint.name for joint in part.system.joints)
    if key not in known:
        assembly = assemble(part.system, pose)
        opened = tuple((joints.index(gap.joint), gap) for gap in assembly.open_joints)
        known[key] = _verdict(part.system, assembly.pose) if assembly.is_closed else opened
    found = known[key]
    labels = part.system.row_labels()
    if isinstance(found, Verdict):
        return JudgedPart(part.system.bodies, joints, labels, found)
    gaps = tuple(replace(gap, joint=joints[position]) for position, gap in found)
    return JudgedPart(part.system.bodies, joints, labels, None, gaps)


def _regular(ranks: Sequence[Rank]) -> list[int]:
    """Poses of full rank that are not near one where it drops."""
    count = max(found.rank for found in ranks)
    largest = max(found.kept for found in ranks if found.rank == count)
    return [k for k, found in enumerate(ranks) if found.rank == count and found.kept > _NEAR_SINGULAR * largest]


def _verdict(system: ConstraintSystem, pose: Pose) -> Verdict:
    units = scales(system)
    poses = consistent_poses(system, pose, units)
    jacobians = [units.values(system, here)[1] for here in poses]
    ranks = tuple(rank(jacobian) for jacobian in jacobians)
    count = max(found.rank for found in ranks)
    regular = _regular(ranks)
    best = poses[max(regular, key=lambda k: ranks[k].kept)]
    kept = independent_rows([jacobians[k] for k in regular], system.row_ranges(), count)
    infinitesimal = system.column_count - count
    freedoms = finite_freedoms(system, best, units)
    groups = tuple(group(system, best, joints, units.length) for joints in loops(system))
    by_group = sum(6 - found.dimension for found in groups)
    if len(kept) == count and system.row_count - count > by_group:
        kept = lasting_rows(system, best, units, [jacobians[k] for k in regular], kept)
    redundant = implied_rows(system, best, units, kept)
    is_shaky = infinitesimal > freedoms
    return Verdict(
        rows=system.row_count,
        columns=system.column_count,
        ranks=ranks,
        rank=count,
        freedoms=freedoms,
        infinitesimal=infinitesimal - freedoms,
        redundant=redundant,
        is_common=len(kept) == count,
        groups=groups,
        by_dimensions=max(0, len(redundant) - by_group),
        suggestions=() if is_shaky else suggestions(system, [poses[k] for k in regular], units, len(redundant)),
    )
