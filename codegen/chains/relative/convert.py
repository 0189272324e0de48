"""From a scene to a chain: joints become joints of one freedom, bodies links, joints that close loops cuts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction

from codegen.chains.relative.acting import acting
from codegen.chains.relative.independent import independents
from codegen.chains.relative.inertia import hung
from codegen.chains.relative.pose import Pose, row_of
from codegen.chains.relative.spanning import Branch, spanning
from codegen.chains.relative.steps import Step, coordinates, steps
from codegen.spec.chain import BASE, Chain, Cut, Frame, Link, Row
from codegen.spec.chain_forces import JointForce, Stop
from codegen.spec.placement import rotation, transposed
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Coordinate, Joint, Limit, Marker, Scene

_MASSLESS = (ZERO_VECTOR, ZERO_VECTOR, ZERO_VECTOR)


@dataclass(frozen=True, slots=True)
class Carried:
    """What became of a joint.

    Attributes:
        coordinates: of each its link, and what the link's coordinate is more than the joint's.
        end: link on which the joint ends, of the body that hangs on it; "" where the bodies became one link.
        cut: number of the cut; None for joints of the tree.
        on_second: whether the body that hangs on it is the joint's second one.
    """

    coordinates: tuple[tuple[str, Fraction], ...]
    end: str
    cut: int | None
    on_second: bool


@dataclass(frozen=True, slots=True)
class Relative:
    """A scene as a chain.

    Attributes:
        chain: of the scene; coordinates are those of the joints, but for a constant.
        notes: how it was made, line by line.
        bodies: name -> link that the body is on, and its pose there.
        joints: name -> what became of it.
    """

    chain: Chain
    notes: tuple[str, ...]
    bodies: Mapping[str, tuple[str, Pose]]
    joints: Mapping[str, Carried]


def relative(scene: Scene) -> Relative:
    """Describe a scene by relative coordinates."""
    return _Conversion(scene).result()


class _Conversion:
    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._bodies = {body.name: body for body in scene.bodies}
        self._spanning = spanning(scene)
        self._places: dict[str, tuple[str, Pose]] = {GROUND: (BASE, Pose())}
        self._links: list[Link] = []
        self._loads: list[tuple[str, Fraction, Coordinate]] = []
        self._joints: dict[str, Carried] = {}

    def result(self) -> Relative:
        """The chain, when all bodies are hung and all loops cut."""
        for branch in self._spanning.branches:
            self._carry(branch)
        cuts = tuple(self._cut(number, joint) for number, joint in enumerate(self._spanning.loops))
        links = hung(
            self._links, [(self._bodies[name], *place) for name, place in self._places.items() if name != GROUND]
        )
        forces = [_force(*load) for load in self._loads]
        scene, on_bodies = self._scene, acting(self._scene, self._places)
        chain = Chain(
            scene.name,
            scene.gravity,
            tuple(links),
            cuts,
            on_bodies.effectors,
            joint_forces=tuple(force for force in forces if force != JointForce(force.joint)),
            assemble=scene.assemble,
            world_forces=on_bodies.world_forces,
            springs=on_bodies.springs,
            stops=tuple(_stop(own, offset, c.limit) for own, offset, c in self._loads if c.limit is not None),
        )
        driven = {name: (offset, c.drive) for name, offset, c in self._loads if c.drive is not None}
        bodies = {name: place for name, place in self._places.items() if name != GROUND}
        chain = replace(chain, independents=independents(chain, driven))
        return Relative(chain, tuple(self._notes(cuts)), bodies, self._joints)

    def _carry(self, branch: Branch) -> None:
        """Hang a body on its carrier."""
        link, carrier = self._places[branch.carrier]
        if branch.joint is None:
            own = Pose(rotation(self._bodies[branch.body].quaternion), self._bodies[branch.body].position)
            start, carried = coordinates("free", own), (link, carrier)
            end, frame, _ = self._stepped(branch.body, "free", (), steps("free", False), start, carried)
            self._places[branch.body] = end, frame
            return
        joint = branch.joint
        near, far = (_pose(m) for m in _markers(joint, branch.is_reversed))
        way = steps(joint.type, branch.is_reversed, joint.pitch)
        start = coordinates(joint.type, self._apart(joint), joint.pitch)
        end, frame, found = self._stepped(
            branch.body, joint.name, joint.coordinates, way, start, (link, carrier @ near)
        )
        self._places[branch.body] = end, frame @ far.inverse
        self._joints[joint.name] = Carried(found, end if way else "", None, not branch.is_reversed)

    def _cut(self, number: int, joint: Joint) -> Cut:
        """Hang the joint on its second body, or on the one that moves, and cut it from the other."""
        is_reversed = joint.bodies[1] != GROUND
        near, far = (_pose(m) for m in _markers(joint, is_reversed))
        on, off = reversed(joint.bodies) if is_reversed else joint.bodies
        link, place = self._places[on]
        way = steps(joint.type, is_reversed, joint.pitch)
        start = coordinates(joint.type, self._apart(joint), joint.pitch)
        end, frame, found = self._stepped("", joint.name, joint.coordinates, way, start, (link, place @ near))
        self._joints[joint.name] = Carried(found, end, number, is_reversed)
        other, place = self._places[off]
        return Cut(joint.name, Frame(other, row_of(place @ far)), Frame(end, row_of(frame)))

    def _stepped(
        self,
        body: str,
        name: str,
        loads: tuple[Coordinate, ...],
        way: tuple[Step, ...],
        start: tuple[Fraction, ...],
        place: tuple[str, Pose],
    ) -> tuple[str, Pose, tuple[tuple[str, Fraction], ...]]:
        """Hang a link for each step; gives the last link, the frame of the joint's end on it, and the coordinates."""
        link, frame = place
        found: dict[int, tuple[str, Fraction]] = {}
        for number, step in enumerate(way, 1):
            turned = Pose(step.turn)
            row, value = row_of(frame @ turned), start[step.coordinate]
            offset = row.d if step.type == "prismatic" else row.theta
            row = _moved(row, step, value)
            is_last = number == len(way)
            own = body if body and is_last else name if len(way) == 1 else f"{name} {number}"
            own = self._free_name(own)
            massless = Link(own, link, step.type, row, Fraction(0), ZERO_VECTOR, _MASSLESS, pitch=step.pitch)
            self._links.append(massless)
            found[step.coordinate] = own, offset
            if loads:
                self._loads.append((own, offset, loads[step.coordinate]))
            link, frame = own, Pose(transposed(step.turn))
        return link, frame, tuple(found[k] for k in sorted(found))

    def _free_name(self, name: str) -> str:
        taken = {BASE, *(link.name for link in self._links)}
        found, number = name, 1
        while found in taken:
            number += 1
            found = f"{name} ({number})"
        return found

    def _apart(self, joint: Joint) -> Pose:
        """The second marker on the first, at t = 0."""
        i, j = (
            self._at_start(name) @ _pose(marker)
            for name, marker in zip(joint.bodies, (joint.marker_i, joint.marker_j), strict=True)
        )
        return i.inverse @ j

    def _at_start(self, name: str) -> Pose:
        body: Body | None = self._scene.body(name)
        return Pose() if body is None else Pose(rotation(body.quaternion), body.position)

    def _notes(self, cuts: tuple[Cut, ...]) -> Iterator[str]:
        for branch in self._spanning.branches:
            by = f'joint "{branch.joint.name}"' if branch.joint else "nothing, it is free"
            yield f'body "{branch.body}" hangs on "{branch.carrier}" by {by}'
        yield from (f'joint "{cut.name}" closes a loop: it is cut from "{cut.base.link}"' for cut in cuts)


def _markers(joint: Joint, is_reversed: bool) -> tuple[Marker, Marker]:
    pair = joint.marker_i, joint.marker_j
    return (pair[1], pair[0]) if is_reversed else pair


def _pose(marker: Marker) -> Pose:
    return Pose(marker.axes, marker.point)


def _moved(row: Row, step: Step, value: Fraction) -> Row:
    """A row with its coordinate further by a value."""
    if step.type == "prismatic":
        return replace(row, d=row.d + value)
    return replace(row, theta=row.theta + value, d=row.d + step.pitch * value)


def _stop(joint: str, offset: Fraction, limit: Limit) -> Stop:
    lower, upper = (None if bound is None else bound + offset for bound in (limit.lower, limit.upper))
    return Stop(joint, replace(limit, lower=lower, upper=upper))


def _force(joint: str, offset: Fraction, load: Coordinate) -> JointForce:
    rest = load.rest + offset if load.stiffness else Fraction(0)
    return JointForce(joint, load.torque, load.stiffness, load.damping, rest)
