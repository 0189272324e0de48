"""The stages of reading a platform file, in order."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from codegen.errors import Mistake, SpecificationError
from codegen.spec.platform import LEGS, UNITS, VARIANTS, Platform, PlatformPose, WantedIndices
from codegen.spec.platform_file.entries import IndicesEntry, PlatformEntry, Points, PoseEntry
from codegen.spec.platform_file.legs import columns, leg_mistakes, length_mistakes, points_mistakes
from codegen.spec.platform_file.poses import make_pose, pose_mistakes
from codegen.spec.scene import Vector
from codegen.spec.scene_file.entry import read_entry
from codegen.spec.scene_file.names import routine_name_mistakes
from codegen.spec.scene_file.reading import bounded
from codegen.spec.scene_file.tables import read_tables
from codegen.spec.scene_file.text import escaped, quoted


def read_platform(text: str, place: str) -> Platform:
    """Read a platform file.

    Args:
        text: TOML, see ``docs/platform.md``.
        place: name of the file in messages.

    Raises:
        SpecificationError: all mistakes of the file; only those of its syntax where it is no TOML.
    """
    file = escaped(place, 200)
    mistakes: list[Mistake] = []
    entry = read_entry(PlatformEntry, read_tables(text, file), file, mistakes)
    assert entry is not None
    mistakes += _mistakes(entry)
    if mistakes:
        raise SpecificationError(bounded(mistakes, file))
    assert entry.home is not None
    home, *poses = [pose for pose in (make_pose(item, UNITS[entry.unit]) for item in _poses(entry)) if pose]
    base, joints = (_in_metres(points, UNITS[entry.unit]) for points in (entry.base, entry.platform))
    return Platform(entry.name or "", base, joints, home, tuple(poses), _wanted(entry.output))


def wanted_mistakes(wanted: WantedIndices, place: str) -> Iterator[Mistake]:
    """Check that a variant offers what is asked for."""
    offered = VARIANTS[wanted.variant]
    for name in wanted.quantities:
        if name not in offered:
            what = f"the variant {quoted(wanted.variant)} does not evaluate {quoted(name)}"
            yield Mistake(place, what, f"it offers {', '.join(offered)}; robust offers everything")


def _mistakes(entry: PlatformEntry) -> Iterator[Mistake]:
    if entry.name is not None:
        yield from routine_name_mistakes(entry.name, f"{entry.place}: name", "platform")
    points = {name: getattr(entry, name) for name in ("base", "platform")}
    for name, rows in points.items():
        if rows is not None:
            yield from points_mistakes(rows, f"{entry.place}: {name}")
    for pose in _poses(entry):
        yield from pose_mistakes(pose)
    yield from wanted_mistakes(_wanted(entry.output), f"{entry.place}: output: quantities")
    if all(rows is not None and all(len(row) == LEGS for row in rows) for rows in points.values()):
        yield from _leg_mistakes(entry)


def _leg_mistakes(entry: PlatformEntry) -> Iterator[Mistake]:
    """Check the legs, and their lengths in the poses that are sound."""
    base, joints = (_in_metres(points, UNITS[entry.unit]) for points in (entry.base, entry.platform))
    yield from leg_mistakes(base, joints, entry.place)
    for item in _poses(entry):
        pose: PlatformPose | None = make_pose(item, UNITS[entry.unit])
        if pose is not None and not any(pose_mistakes(item)):
            yield from length_mistakes(base, joints, pose, item.place)


def _poses(entry: PlatformEntry) -> tuple[PoseEntry, ...]:
    return (*([entry.home] if entry.home else []), *entry.poses)


def _in_metres(points: Points | None, unit: Fraction) -> tuple[Vector, ...]:
    return tuple((x * unit, y * unit, z * unit) for x, y, z in columns(points or ()))


def _wanted(entry: IndicesEntry | None) -> WantedIndices:
    return WantedIndices(entry.quantities, entry.variant, entry.attitude) if entry else WantedIndices()
