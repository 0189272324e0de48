"""The stages of reading a scene file, in order."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from codegen.errors import Mistake, SpecificationError
from codegen.spec.scene import KINEMATIC_QUANTITIES, Joint, Scene, Wanted
from codegen.spec.scene_file.bodies import Pose, body_mistakes, make_body, pose_of
from codegen.spec.scene_file.copies import copied
from codegen.spec.scene_file.entries import MOST_COPIES, CopiesEntry, JointEntry, SceneEntry
from codegen.spec.scene_file.entry import read_entry
from codegen.spec.scene_file.forces import load_mistakes, make_force, make_spring, make_torque, spring_mistakes
from codegen.spec.scene_file.gaps import gap_mistakes
from codegen.spec.scene_file.joints import joint_mistakes, make_joint, poses_of
from codegen.spec.scene_file.names import name_mistakes, routine_name_mistakes
from codegen.spec.scene_file.planar import Placed, out_of_plane_mistakes, placed, planar_mistakes
from codegen.spec.scene_file.tables import read_tables
from codegen.spec.scene_file.text import escaped

_MOST_MISTAKES = 100

_Sound = tuple[JointEntry, Joint, tuple[Pose, Pose]]
"""A joint without mistakes of its own, with its entry and the poses of its bodies."""


def read_scene(text: str, place: str, copies: int | None = None) -> Scene:
    """Read a scene file.

    Args:
        text: TOML, see ``docs/scene.md``.
        place: name of the file in messages.
        copies: number of mechanisms side by side; None for what the file says.

    Raises:
        SpecificationError: all mistakes of the file; only those of its syntax where it is no TOML.
    """
    file = escaped(place, 200)
    mistakes: list[Mistake] = []
    entry = read_entry(SceneEntry, read_tables(text, file), file, mistakes)
    assert entry is not None
    if copies is not None and not 1 <= copies <= MOST_COPIES:
        mistakes.append(Mistake("--copies", "is out of range", f"give a whole number from 1 to {MOST_COPIES}"))
    poses = {body.name: pose_of(body) for body in entry.body if body.name is not None}
    mistakes += _part_mistakes(entry, poses)
    joints = _sound_joints(entry, poses)
    mistakes += _pose_mistakes(entry, joints)
    if mistakes:
        raise SpecificationError(bounded(mistakes, file))
    repeated = entry.copies or CopiesEntry(file, frozenset(), frozenset())
    return copied(_scene(entry, joints), copies or repeated.count, repeated.offset)


def _part_mistakes(entry: SceneEntry, bodies: Mapping[str, Pose | None]) -> Iterator[Mistake]:
    """Check bodies, joints and forces, each by itself."""
    if entry.name is not None:
        yield from routine_name_mistakes(entry.name, f"{entry.place}: name")
    yield from name_mistakes(entry.body)
    for body in entry.body:
        yield from body_mistakes(body, _needs_mass(entry))
    yield from name_mistakes(entry.joint)
    for joint in entry.joint:
        yield from joint_mistakes(joint, bodies)
    for spring in entry.spring:
        yield from spring_mistakes(spring, bodies)
    for torque in entry.torque:
        yield from load_mistakes(torque, bodies)
    for force in entry.force:
        yield from load_mistakes(force, bodies)


def _pose_mistakes(entry: SceneEntry, joints: Sequence[_Sound]) -> Iterator[Mistake]:
    """Check the mechanism in its pose at t = 0, as far as its joints are sound."""
    if not entry.assemble:
        for part, joint, poses in joints:
            yield from gap_mistakes(joint, poses, part.place)
    if entry.motion == "planar":
        axes: list[Placed] = [placed(joint, poses, part.place) for part, joint, poses in joints]
        yield from planar_mistakes(axes)
        moving = [
            (make_body(body), pose, body.place) for body in entry.body if (pose := pose_of(body)) and not body.wrong
        ]
        yield from out_of_plane_mistakes(moving, axes)


def _sound_joints(entry: SceneEntry, bodies: Mapping[str, Pose | None]) -> list[_Sound]:
    """The joints that have no mistakes of their own and hold bodies with a pose."""
    found = []
    for part in entry.joint:
        poses = poses_of(part, bodies)
        if poses is not None and not part.wrong and not any(joint_mistakes(part, bodies)):
            found.append((part, make_joint(part, poses), poses))
    return found


def _needs_mass(entry: SceneEntry) -> bool:
    """Whether something is asked for that depends on masses, as far as the question can be read."""
    if entry.output is None or "quantities" not in entry.output.given:
        return True
    quantities = entry.output.quantities
    return not quantities or not set(quantities) <= set(KINEMATIC_QUANTITIES)


def _scene(entry: SceneEntry, joints: Sequence[_Sound]) -> Scene:
    output = entry.output
    return Scene(
        entry.name or "",
        entry.gravity,
        tuple(make_body(body) for body in entry.body),
        tuple(joint for _, joint, _ in joints),
        tuple(make_spring(spring) for spring in entry.spring),
        tuple(make_torque(torque) for torque in entry.torque),
        entry.motion,
        Wanted(output.quantities, output.rows, output.derivative) if output else Wanted(),
        entry.assemble,
        tuple(make_force(force) for force in entry.force),
    )


def bounded(mistakes: list[Mistake], file: str) -> list[Mistake]:
    """Each mistake once, and not more of them than anyone reads."""
    mistakes = list(dict.fromkeys(mistakes))
    left = len(mistakes) - _MOST_MISTAKES
    if left <= 0:
        return mistakes
    return [*mistakes[:_MOST_MISTAKES], Mistake(file, f"there are {left} more mistakes", "correct these first")]
