"""Cut a scene where no joint ties its bodies, and tell which of the pieces are alike.

A section is a run of bodies and a run of joints, such that every joint of the run is between bodies of the run or the
ground. Sections are as short as the order of the scene allows: mechanisms whose bodies take turns in the file are one
section together.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

from codegen.spec.scene import GROUND, Joint, Scene


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a scene.

    Attributes:
        bodies: numbers of its bodies.
        joints: numbers of its joints.
    """

    bodies: range
    joints: range

    def scene(self, scene: Scene) -> Scene:
        """The section as a scene of its own, without springs and torques."""
        bodies = scene.bodies[self.bodies.start : self.bodies.stop]
        joints = scene.joints[self.joints.start : self.joints.stop]
        return replace(scene, bodies=bodies, joints=joints, springs=(), torques=())


def sections(scene: Scene) -> tuple[Section, ...]:
    """Cut a scene; every section has a body and a joint, unless the scene has none."""
    found: list[Section] = []
    start = (0, 0)
    for cut in [*_cuts(scene), (len(scene.bodies), len(scene.joints))]:
        section = Section(range(start[0], cut[0]), range(start[1], cut[1]))
        if section.bodies and section.joints:
            found.append(section)
            start = cut
    rest = Section(range(start[0], len(scene.bodies)), range(start[1], len(scene.joints)))
    if not found:
        return (rest,)
    last = found.pop()
    whole = Section(range(last.bodies.start, rest.bodies.stop), range(last.joints.start, rest.joints.stop))
    return (*found, whole)


def _cuts(scene: Scene) -> Iterator[tuple[int, int]]:
    """Numbers of bodies and joints before which the scene may be cut, in ascending order."""
    numbers = {body.name: k for k, body in enumerate(scene.bodies)}
    moving = [[numbers[name] for name in joint.bodies if name != GROUND] for joint in scene.joints]
    count = len(scene.bodies)
    before = list(accumulate((max(bodies, default=-1) for bodies in moving), max, initial=-1))
    after = list(accumulate((min(bodies, default=count) for bodies in reversed(moving)), min, initial=count))[::-1]
    first = 0
    for joint, (last, least) in enumerate(zip(before, after, strict=True)):
        for body in range(max(first, last + 1), least + 1):
            yield body, joint
            first = body


def alike(scene: Scene) -> tuple[tuple[Section, ...], ...]:
    """Group the sections that differ in names and in where their joints are attached, and in nothing else."""
    groups: dict[object, list[Section]] = {}
    for section in sections(scene):
        groups.setdefault(likeness(scene, section), []).append(section)
    return tuple(tuple(group) for group in groups.values())


def likeness(scene: Scene, section: Section) -> object:
    """Give a key that is equal for sections that are alike."""
    numbers = {body.name: k for k, body in enumerate(scene.bodies[section.bodies.start : section.bodies.stop])}
    joints = scene.joints[section.joints.start : section.joints.stop]
    return len(section.bodies), tuple((_ends(joint, numbers), _kind(joint)) for joint in joints)


def _ends(joint: Joint, numbers: dict[str, int]) -> Sequence[int | None]:
    return tuple(numbers.get(name) for name in joint.bodies)


def _kind(joint: Joint) -> object:
    axes = joint.marker_i.axes, joint.marker_j.axes
    return joint.type, joint.form, axes, joint.pitch, joint.coordinates


def repeated(keys: Sequence[object]) -> tuple[range, ...]:
    """Find the equal keys that follow each other at equal distances, with equal keys between them.

    Returns:
        Positions of such a series, of one position where there is no other; every position is in one of them.
    """
    places: dict[object, list[int]] = {}
    for position, key in enumerate(keys):
        places.setdefault(key, []).append(position)
    found = [series for positions in places.values() for series in _series(keys, positions)]
    return tuple(sorted(found, key=lambda series: series.start))


def _series(keys: Sequence[object], positions: Sequence[int]) -> Iterator[range]:
    start, between = 0, None
    for k, (here, following) in enumerate(pairwise(positions)):
        gap = tuple(keys[here:following])
        if between is not None and gap != between:
            yield _range(positions[start : k + 1])
            start, between = k + 1, None
        else:
            between = gap
    yield _range(positions[start:])


def _range(positions: Sequence[int]) -> range:
    step = positions[1] - positions[0] if len(positions) > 1 else 1
    return range(positions[0], positions[-1] + 1, step)
