"""Cut a scene where nothing ties its bodies, and tell which of the pieces are alike.

A section is a run of bodies and a run of joints, such that every joint of the run is between bodies of the run or the
ground, and so is every spring on its bodies. Sections are as short as the order of the scene allows: mechanisms whose
bodies take turns in the file are one section together.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import accumulate

from codegen.spec.scene import GROUND, Scene, Vector

Coordinate = tuple[int, int, int]
"""Number of a joint, or of a spring behind the joints, side (0 for body i, 1 for body j) and number of a coordinate."""


@dataclass(frozen=True, slots=True)
class Section:
    """A part of a scene.

    Attributes:
        bodies: numbers of its bodies.
        joints: numbers of its joints.
        springs: numbers of its springs.
        torques: numbers of its torques.
        forces: numbers of its forces.
    """

    bodies: range
    joints: range

    springs: tuple[int, ...] = ()
    torques: tuple[int, ...] = ()
    forces: tuple[int, ...] = ()

    def scene(self, scene: Scene) -> Scene:
        """The section as a scene of its own."""
        return replace(
            scene,
            bodies=scene.bodies[self.bodies.start : self.bodies.stop],
            joints=scene.joints[self.joints.start : self.joints.stop],
            springs=tuple(scene.springs[k] for k in self.springs),
            torques=tuple(scene.torques[k] for k in self.torques),
            forces=tuple(scene.forces[k] for k in self.forces),
        )


def sections(scene: Scene) -> tuple[Section, ...]:
    """Cut a scene; every section has a body and a joint, unless the scene has none."""
    whole = (len(scene.bodies), len(scene.joints))
    starts, ends = [(0, 0)], list[tuple[int, int]]()
    for bodies, joints in _cuts(scene):
        if bodies > starts[-1][0] and joints > starts[-1][1]:
            ends.append((bodies, joints))
            starts.append((bodies, joints))
    is_whole = bool(ends) and whole[0] > ends[-1][0] and whole[1] > ends[-1][1]
    ends = [*ends, whole] if is_whole or not ends else [*ends[:-1], whole]
    numbers = {body.name: k for k, body in enumerate(scene.bodies)}
    owner = [k for k, (start, end) in enumerate(zip(starts, ends, strict=False)) for _ in range(start[0], end[0])]
    moving = (next((numbers[name] for name in spring.bodies if name != GROUND), None) for spring in scene.springs)
    owners = (
        [0 if body is None else owner[body] for body in moving],
        [owner[numbers[torque.body]] for torque in scene.torques],
        [owner[numbers[force.body]] for force in scene.forces],
    )
    return tuple(
        Section(
            range(start[0], end[0]),
            range(start[1], end[1]),
            *(tuple(n for n, section in enumerate(kind) if section == k) for kind in owners),
        )
        for k, (start, end) in enumerate(zip(starts, ends, strict=False))
    )


def _cuts(scene: Scene) -> Iterator[tuple[int, int]]:
    """Numbers of bodies and joints before which the scene may be cut, in ascending order."""
    numbers = {body.name: k for k, body in enumerate(scene.bodies)}
    moving = [[numbers[name] for name in joint.bodies if name != GROUND] for joint in scene.joints]
    springs = [[numbers[name] for name in spring.bodies if name != GROUND] for spring in scene.springs]
    tied = {body for bodies in springs if len(bodies) == 2 for body in range(min(bodies) + 1, max(bodies) + 1)}
    count = len(scene.bodies)
    before = list(accumulate((max(bodies, default=-1) for bodies in moving), max, initial=-1))
    after = list(accumulate((min(bodies, default=count) for bodies in reversed(moving)), min, initial=count))[::-1]
    first = 0
    for joint, (last, least) in enumerate(zip(before, after, strict=True)):
        for body in range(max(first, last + 1), least + 1):
            first = body
            if body not in tied:
                yield body, joint


def alike(scene: Scene) -> tuple[tuple[Section, ...], ...]:
    """Group the sections that differ in names and in where joints and springs are attached, and in nothing else."""
    groups: dict[object, list[Section]] = {}
    for section in sections(scene):
        groups.setdefault(likeness(section.scene(scene)), []).append(section)
    return tuple(tuple(group) for group in groups.values())


def likeness(scene: Scene) -> object:
    """Give a key that is equal for scenes that are alike."""
    numbers = {body.name: k for k, body in enumerate(scene.bodies)}
    return (
        tuple((body.mass, body.inertia) for body in scene.bodies),
        tuple(
            (
                *(numbers.get(name) for name in joint.bodies),
                *(joint.type, joint.form, joint.marker_i.axes, joint.marker_j.axes, joint.pitch, joint.coordinates),
            )
            for joint in scene.joints
        ),
        tuple(
            (*(numbers.get(name) for name in spring.bodies), spring.stiffness, spring.damping, spring.length)
            for spring in scene.springs
        ),
        tuple((numbers[torque.body], torque.vector) for torque in scene.torques),
        tuple((numbers[force.body], force.vector, force.point) for force in scene.forces),
    )


# --- what differs


def attachments(scene: Scene) -> tuple[tuple[Vector, Vector], ...]:
    """Points on body i and body j of the joints, then of the springs."""
    joints = ((joint.marker_i.point, joint.marker_j.point) for joint in scene.joints)
    return (*joints, *(spring.points for spring in scene.springs))


def varying_of(varying: Mapping[Coordinate, int], number: int) -> dict[tuple[int, int], int]:
    """Of the coordinates that vary, those of one joint or spring."""
    return {(side, k): place for (owner, side, k), place in varying.items() if owner == number}


def differing(scenes: Sequence[Scene]) -> tuple[dict[Coordinate, int], tuple[tuple[Fraction, ...], ...]]:
    """Find the coordinates of attachments that scenes which are alike do not have in common.

    Returns:
        Coordinate -> number; those that are equal in every scene have one number. And the values, scene by scene.
    """
    points = [[x for pair in attachments(scene) for point in pair for x in point] for scene in scenes]
    places: dict[tuple[Fraction, ...], int] = {}
    found = {}
    for position, values in enumerate(zip(*points, strict=True)):
        if len(set(values)) > 1:
            owner, rest = divmod(position, 6)
            found[owner, *divmod(rest, 3)] = places.setdefault(values, len(places))
    return found, tuple(zip(*places, strict=True)) if places else tuple(() for _ in scenes)


# --- series


def repeated(keys: Sequence[int]) -> tuple[range, ...]:
    """Find the equal keys that follow each other at equal distances, with equal keys between them.

    Returns:
        Positions of such a series, of one position where there is no other; every position is in one of them.
    """
    period = _period(keys)
    if 2 * period <= len(keys):
        return tuple(range(start, len(keys), period) for start in range(period))
    places: dict[int, list[int]] = {}
    for position, key in enumerate(keys):
        places.setdefault(key, []).append(position)
    found = [series for positions in places.values() for series in _series(keys, positions)]
    return tuple(sorted(found, key=lambda series: series.start))


def _period(keys: Sequence[int]) -> int:
    """The least distance after which all keys come again (by the failure function of Knuth, Morris and Pratt)."""
    border = [0] * len(keys)
    for k in range(1, len(keys)):
        length = border[k - 1]
        while length and keys[k] != keys[length]:
            length = border[length - 1]
        border[k] = length + 1 if keys[k] == keys[length] else 0
    return len(keys) - border[-1]


def _series(keys: Sequence[int], positions: Sequence[int]) -> Iterator[range]:
    start, step = 0, 1
    for k in range(1, len(positions) + 1):
        begin, here = positions[start], positions[k - 1]
        follows = k < len(positions)
        gap = positions[k] - here if follows else 0
        if follows and k - start > 1:
            follows = gap == step and keys[here : here + gap] == keys[begin : begin + step]
        if not follows:
            yield range(begin, here + 1, step)
            start, step = k, 1
        elif k - start == 1:
            step = gap
