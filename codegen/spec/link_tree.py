"""From links that hang on each other, as files of robots have them, to a scene: bodies and joints at t = 0.

Links that are fixed to each other become one rigid body with the axes of the first of them; what is fixed to the world
becomes part of the ground. Everything is exact: a joint frame is laid in the axes of a link, never by way of the world.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from fractions import Fraction

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import LONGEST_NAME, Imported, LeftOut, quoted
from codegen.spec.placement import IDENTITY, NEARLY, columns, frame, length, marker, times, transposed, turned_back
from codegen.spec.pose import MassProperties, Pose, composed, is_inertia, moved, normalised, plus, scaled, seen_from
from codegen.spec.pose import together as rigidly_together
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Coordinate, Joint, Marker, Matrix, Scene, Vector

NEARLY_CLOSED = 1e-9
"""A loop with less of a gap is closed, m or rad."""


@dataclass(frozen=True, slots=True)
class LinkJoint:
    """How a link moves on its parent.

    Attributes:
        name: of the joint.
        type: a type of joint of a scene, or ``free``.
        point: [3] m, axes of the link.
        h: third axis of the joint frame, axes of the link; None for a ball joint without preferred axes, or a free one.
        f: first axis; None where it may be any across h.
        coordinates: as in a scene.
    """

    name: str
    type: str
    point: Vector = ZERO_VECTOR
    h: Vector | None = None
    f: Vector | None = None
    coordinates: tuple[Coordinate, ...] = ()


@dataclass(frozen=True, slots=True)
class Link:
    """A link.

    Attributes:
        name: unique.
        parent: name of the link it hangs on; None for the world.
        pose: at t = 0, in the parent.
        masses: in the axes of the link; None if it has none.
        joint: None if it is fixed to its parent.
    """

    name: str
    parent: str | None
    pose: Pose
    masses: MassProperties | None
    joint: LinkJoint | None


@dataclass(frozen=True, slots=True)
class Loop:
    """A joint that closes a loop, ``ball`` or ``rigid``.

    Attributes:
        name: of the joint.
        type: ``ball`` or ``rigid``.
        links: names; None for the world.
        frames: the joint frame in each link; the second is None where it follows from the pose at t = 0.
    """

    name: str
    type: str
    links: tuple[str | None, str | None]
    frames: tuple[Pose, Pose | None]


@dataclass(frozen=True, slots=True)
class LinkTree:
    """A mechanism as its file has it: links, each after the one it hangs on, and what closes loops.

    Attributes:
        name: of the scene.
        place: name of the file, for messages.
        kind: what the file calls a link, for messages.
        gravity: [3] m/s^2.
        links: in an order in which parents come first.
        loops: in the order of the file.
        keep_fixed: whether fixed links with a mass stay bodies.
        left_out: what the file holds beside this.
    """

    name: str
    place: str
    kind: str
    gravity: Vector
    links: tuple[Link, ...]
    loops: tuple[Loop, ...] = ()
    keep_fixed: bool = False
    left_out: tuple[LeftOut, ...] = ()


@dataclass(slots=True)
class _Carriers:
    """Which body each link is part of, and where; the world pose of each body's own link."""

    tree: LinkTree
    pose: dict[str | None, tuple[str, Pose]] = field(default_factory=lambda: {None: (GROUND, Pose())})
    world: dict[str, Pose] = field(default_factory=lambda: {GROUND: Pose()})
    masses: dict[str, list[MassProperties]] = field(default_factory=lambda: {GROUND: []})
    centre: dict[str, Vector] = field(default_factory=lambda: {GROUND: ZERO_VECTOR})


def assembled(tree: LinkTree) -> Imported:
    """Turn links into a scene.

    Raises:
        SpecificationError: bodies without mass, or with what is no inertia, loops that are open at t = 0, names that
            are taken.
    """
    if any(link.name == GROUND and _is_body(link, tree) for link in tree.links):
        what = f"moves, and {GROUND} is the name of what does not"
        raise SpecificationError([Mistake(f"{tree.place}: {tree.kind} {quoted(GROUND)}", what, "give it another name")])
    carriers = _Carriers(tree)
    mistakes: list[Mistake] = []
    joints: list[tuple[Link, str, Pose]] = []
    fixed_to_ground: list[Link] = []
    for link in tree.links:
        carrier, pose = carriers.pose[link.parent]
        pose = composed(pose, link.pose)
        if _is_body(link, tree):
            joints.append((link, carrier, pose))
            carriers.world[link.name] = composed(carriers.world[carrier], pose)
            carriers.masses[link.name] = []
            carrier, pose = link.name, Pose()
        carriers.pose[link.name] = (carrier, pose)
        if link.masses and link.masses.mass:
            carriers.masses[carrier].append(moved(link.masses, pose))
            fixed_to_ground += [link] if carrier == GROUND else []
    bodies = [_body(name, carriers, mistakes) for name in carriers.world if name != GROUND]
    made = [_joint(link, carrier, pose, carriers) for link, carrier, pose in joints if not _is_free(link)]
    made += [_loop(loop, carriers, mistakes) for loop in tree.loops]
    mistakes += [mistake for joint in made for mistake in _name_mistakes(joint.name, f"{tree.place}: joint")]
    if mistakes:
        raise SpecificationError(mistakes)
    why = "is fixed to the ground, where a mass has no effect"
    masses = tuple(LeftOut("mass", f"{tree.place}: {tree.kind} {quoted(link.name)}", why) for link in fixed_to_ground)
    return Imported(Scene(tree.name, tree.gravity, tuple(bodies), _with_own_names(made)), (*tree.left_out, *masses))


def _is_body(link: Link, tree: LinkTree) -> bool:
    return link.joint is not None or (tree.keep_fixed and link.masses is not None and link.masses.mass > 0)


def _is_free(link: Link) -> bool:
    return link.joint is not None and link.joint.type == "free"


def _body(name: str, carriers: _Carriers, mistakes: list[Mistake]) -> Body:
    masses = rigidly_together(carriers.masses[name])
    place = f"{carriers.tree.place}: {carriers.tree.kind} {quoted(name)}"
    mistakes += _name_mistakes(name, f"{carriers.tree.place}: {carriers.tree.kind}")
    if masses.mass <= 0:
        mistakes.append(Mistake(place, "moves and has no mass", "give it a mass and an inertia, or fix its joint"))
    elif not is_inertia(masses.inertia):
        what = "has the inertia of no body: a principal value is not positive, or above the sum of the two others"
        mistakes.append(Mistake(place, what, "correct the inertia; it is about the centre of mass"))
    carriers.centre[name] = masses.centre
    world = carriers.world[name]
    return Body(name, masses.mass, masses.inertia, world.point(masses.centre), normalised(world.quaternion))


def _name_mistakes(name: str, place: str) -> list[Mistake]:
    if name.strip() and name.isprintable() and len(name) <= LONGEST_NAME:
        return []
    what = "is blank, holds signs that do not print, or is too long"
    return [Mistake(f"{place} {quoted(name)}: name", what, f"use 1 to {LONGEST_NAME} signs that print")]


def _joint(link: Link, carrier: str, pose: Pose, carriers: _Carriers) -> Joint:
    joint = link.joint or LinkJoint(f"{link.name} fixed", "rigid")
    attitude = pose.attitude
    axes = _axes(joint, attitude)
    seen = tuple(times(attitude, axis) for axis in axes)
    marker_i = _marker(plus(pose.position, times(attitude, joint.point)), seen, carriers.centre[carrier])
    marker_j = _marker(joint.point, axes, carriers.centre[link.name])
    return Joint(joint.name, joint.type, (carrier, link.name), marker_i, marker_j, coordinates=joint.coordinates)


def _marker(point: Vector, axes: Iterable[Vector], centre: Vector) -> Marker:
    f, g, h = axes
    return marker(point, columns(f, g, h), centre, IDENTITY)


def _axes(joint: LinkJoint, attitude: Matrix) -> Matrix:
    """f, g and h as rows, in the axes of the link: f where it leaves the fewest components on both links."""
    if joint.h is None:
        return IDENTITY
    if joint.f is not None:
        return transposed(frame(joint.h, [joint.f]))
    preferred = [*IDENTITY, *(turned_back(attitude, axis) for axis in IDENTITY)]
    frames = [transposed(frame(joint.h, [direction, *IDENTITY])) for direction in preferred]
    return min(frames, key=lambda axes: sum(map(_components, (*axes, *(times(attitude, axis) for axis in axes)))))


def _components(vector: Vector) -> int:
    return sum(abs(component) > NEARLY for component in vector)


def _loop(loop: Loop, carriers: _Carriers, mistakes: list[Mistake]) -> Joint:
    place = f"{carriers.tree.place}: {quoted(loop.name)}"
    (carrier_i, pose_i), (carrier_j, pose_j) = (carriers.pose[link] for link in loop.links)
    if carrier_i == carrier_j:
        mistakes.append(Mistake(place, f"joins {quoted(carrier_i)} to itself", "take it out"))
    frame_i = composed(pose_i, loop.frames[0])
    closing = seen_from(carriers.world[carrier_j], composed(carriers.world[carrier_i], frame_i))
    if loop.frames[1] is not None:
        mistakes += _gap(loop, closing, composed(pose_j, loop.frames[1]), place)
    marker_i = _marker(frame_i.position, transposed(frame_i.attitude), carriers.centre[carrier_i])
    marker_j = _marker(closing.position, transposed(closing.attitude), carriers.centre[carrier_j])
    return Joint(loop.name, loop.type, (carrier_i, carrier_j), marker_i, marker_j)


def _gap(loop: Loop, closing: Pose, given: Pose, place: str) -> list[Mistake]:
    gap = float(length(plus(closing.position, scaled(given.position, Fraction(-1)))))
    sine = float(length(normalised(seen_from(closing, given).quaternion)[1:])) if loop.type == "rigid" else 0.0
    if max(gap, sine) <= NEARLY_CLOSED:
        return []
    turn = math.degrees(2 * math.asin(min(sine, 1.0)))
    what = f"is open at t = 0, by {1e3 * gap:.6g} mm and {turn:.6g} degrees"
    return [Mistake(place, what, "close it in the initial pose")]


def _with_own_names(joints: Iterable[Joint]) -> tuple[Joint, ...]:
    """Number the joints that share a name: what closes a loop may have the name of a joint."""
    named: dict[str, Joint] = {}
    for joint in joints:
        names = itertools.chain([joint.name], (f"{joint.name} {k}" for k in itertools.count(2)))
        name = next(name for name in names if name not in named)
        named[name] = replace(joint, name=name)
    return tuple(named.values())
