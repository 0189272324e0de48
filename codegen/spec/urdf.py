"""Robots in the Unified Robot Description Format, as scenes in the zero configuration.

The text is parsed with defusedxml; every number is the decimal that stands in the file. Angles of ``rpy`` go through
doubles, but for multiples of a right angle, which are exact.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from fractions import Fraction
from xml.etree.ElementTree import Element

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.spec.imported import Imported, ImportOptions, quoted, scene_name
from codegen.spec.link_tree import Link, LinkJoint, LinkTree, assembled
from codegen.spec.pose import MassProperties, Pose, from_rpy, moved
from codegen.spec.scene import ZERO_VECTOR, Coordinate, Vector
from codegen.spec.urdf_left_out import left_out
from codegen.spec.xml_text import numbers, read_xml, tag

JOINT_TYPES = {
    "revolute": "revolute",
    "continuous": "revolute",
    "prismatic": "translational",
    "planar": "planar",
    "floating": "free",
    "fixed": "rigid",
}
"""Types of joint of a URDF, and what they are in a scene; ``free`` is no joint."""

GRAVITY: Vector = (Fraction(0), Fraction(0), Fraction("-9.81"))
"""A URDF has none; its z axis points up (REP 103)."""

_X: Vector = (Fraction(1), Fraction(0), Fraction(0))
_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")


def read_urdf(text: str | bytes, place: str, options: ImportOptions | None = None) -> Imported:
    """Read a robot.

    Args:
        text: the file.
        place: its name, for messages.
        options: how it is read.

    Returns:
        The scene. The axes of a body are those of its link; the first link is fixed to the ground, unless its joints
        are all ``floating`` or ``options.free_base``.

    Raises:
        SpecificationError: with all mistakes of the file.
    """
    return _Reader(place, options or ImportOptions()).read(read_xml(text, place))


class _Reader:
    """Reads one file and collects its mistakes."""

    def __init__(self, place: str, options: ImportOptions) -> None:
        self.place = place
        self.options = options
        self.mistakes: list[Mistake] = []

    def read(self, robot: Element) -> Imported:
        self._check_root(robot)
        links = self._named(robot, "link")
        joints = self._named(robot, "joint")
        masses = {name: self._masses(link, f"{self.place}: link {quoted(name)}") for name, link in links.items()}
        hung = [self._hung(name, joint, masses) for name, joint in joints.items()]
        known = [link for link in hung if link]
        ordered = self._ordered(masses, known) if len(known) == len(hung) else ()
        made = self._assembled(self._tree(robot, ordered)) if ordered else None
        if self.mistakes or made is None:
            raise SpecificationError(self.mistakes)
        return made

    def _mistake(self, place: str, what: str, remedy: str) -> None:
        self.mistakes.append(Mistake(place, what, remedy))

    def _check_root(self, robot: Element) -> None:
        if robot.tag != "robot":
            what = f"is no URDF: its first element is {quoted(tag(robot))}"
            raise SpecificationError([Mistake(self.place, what, "give a file that begins with <robot>")])
        if any("xacro" in element.tag for element in robot.iter()):
            what = "holds macros of xacro"
            raise SpecificationError([Mistake(self.place, what, "expand it first: xacro FILE > robot.urdf")])

    def _named(self, robot: Element, kind: str) -> dict[str, Element]:
        elements = robot.findall(kind)
        names = Counter(element.get("name", "") for element in elements)
        for name, count in names.items():
            if not name:
                self._mistake(f"{self.place}: {kind}", f"{count} have no name", 'give name="..."')
            elif count > 1:
                what = f"the name stands {count} times"
                self._mistake(f"{self.place}: {kind} {quoted(name)}", what, f"give each {kind} its own")
        if kind == "link" and not elements:
            self._mistake(self.place, "has no link", "add at least one")
        return {element.get("name", ""): element for element in elements}

    # ------------------------------------------------------------------------------------------------
    # numbers

    def _numbers(
        self, element: Element | None, key: str, place: str, default: Sequence[Fraction]
    ) -> Sequence[Fraction]:
        text = None if element is None else element.get(key)
        if element is None or text is None:
            return default
        values = numbers(text, len(default))
        if values is None:
            count = f"{len(default)} numbers" if len(default) > 1 else "a number"
            self._mistake(f"{place}: {tag(element)}: {key}", f"{quoted(text)} is not {count}", f"write {count}")
            return default
        return values

    def _required(self, element: Element, key: str, place: str) -> Fraction:
        if element.get(key) is None:
            self._mistake(f"{place}: {tag(element)}", f"{key} is missing", f'add {key}="..."')
        return self._numbers(element, key, place, [Fraction(0)])[0]

    def _child(self, element: Element, kind: str, place: str) -> Element | None:
        children = element.findall(kind)
        if len(children) > 1:
            self._mistake(f"{place}: {kind}", f"stands {len(children)} times", "leave one")
        return children[0] if children else None

    def _pose(self, element: Element, place: str) -> Pose:
        origin = self._child(element, "origin", place)
        for key in sorted(set() if origin is None else set(origin.keys()) - {"xyz", "rpy"}):
            self._mistake(f"{place}: origin: {quoted(key)}", "is not known", nearest(key, ["xyz", "rpy"]))
        x, y, z = self._numbers(origin, "xyz", place, ZERO_VECTOR)
        angles = self._numbers(origin, "rpy", place, ZERO_VECTOR)
        if max(map(abs, angles)) > 100:
            self._mistake(f"{place}: origin: rpy", "turns more than 100 rad", "give angles in rad")
        return Pose((x, y, z), from_rpy(angles, self.options.right_angle))

    # ------------------------------------------------------------------------------------------------
    # links and joints

    def _masses(self, link: Element, place: str) -> MassProperties | None:
        inertial = self._child(link, "inertial", place)
        if inertial is None:
            return None
        pose = self._pose(inertial, f"{place}: inertial")
        mass, inertia = (self._child(inertial, kind, place) for kind in ("mass", "inertia"))
        for kind, element in (("mass", mass), ("inertia", inertia)):
            if element is None:
                self._mistake(f"{place}: inertial", f"{kind} is missing", f"add <{kind} .../>")
        if mass is None or inertia is None:
            return None
        xx, xy, xz, yy, yz, zz = (self._required(inertia, key, place) for key in _INERTIA)
        value = self._required(mass, "value", place)
        if value < 0:
            self._mistake(f"{place}: mass", "is negative", "correct it")
        return moved(MassProperties(value, ZERO_VECTOR, ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))), pose)

    def _hung(self, name: str, joint: Element, masses: dict[str, MassProperties | None]) -> Link | None:
        place = f"{self.place}: joint {quoted(name)}"
        kind = joint.get("type", "")
        if kind not in JOINT_TYPES:
            self._mistake(f"{place}: type", f"{quoted(kind)} is not known", nearest(kind, JOINT_TYPES))
        parent, child = (self._link_of(joint, side, place, masses) for side in ("parent", "child"))
        pose = self._pose(joint, place)
        axis = self._axis(joint, place)
        coordinates = self._coordinates(joint, kind, place)
        if parent is None or child is None or kind not in JOINT_TYPES:
            return None
        made = LinkJoint(name, JOINT_TYPES[kind], h=axis, coordinates=coordinates) if kind != "fixed" else None
        return Link(child, parent, pose, masses[child], made)

    def _link_of(self, joint: Element, side: str, place: str, known: Iterable[str]) -> str | None:
        element = self._child(joint, side, place)
        name = None if element is None else element.get("link")
        if name is None:
            self._mistake(f"{place}: {side}", "is missing", f'add <{side} link="..."/>')
        elif name not in known:
            self._mistake(f"{place}: {side}", f"there is no link {quoted(name)}", nearest(name, known))
            return None
        return name

    def _axis(self, joint: Element, place: str) -> Vector:
        x, y, z = self._numbers(self._child(joint, "axis", place), "xyz", place, _X)
        if not (x or y or z):
            self._mistake(f"{place}: axis", "is zero", "give a direction")
            return _X
        return x, y, z

    def _coordinates(self, joint: Element, kind: str, place: str) -> tuple[Coordinate, ...]:
        dynamics = self._child(joint, "dynamics", place)
        damping = self._numbers(dynamics, "damping", place, [Fraction(0)])[0]
        if damping < 0:
            self._mistake(f"{place}: dynamics: damping", "is negative", "correct it")
        limit = self._child(joint, "limit", place)
        lower, upper = (self._numbers(limit, key, place, [Fraction(0)])[0] for key in ("lower", "upper"))
        if lower > upper:
            self._mistake(f"{place}: limit", "lower is above upper", "swap them")
        if kind == "planar":
            return (Coordinate(), Coordinate(), Coordinate())
        if kind not in ("revolute", "continuous", "prismatic"):
            return ()
        stops = self.options.stops
        if stops is None or kind == "continuous" or limit is None or not {"lower", "upper"} & set(limit.keys()):
            return (Coordinate(damping=damping),)
        return (Coordinate(damping=damping, limit=stops.limit(lower, upper, kind == "revolute")),)

    # ------------------------------------------------------------------------------------------------
    # the tree

    def _tree(self, robot: Element, links: tuple[Link, ...]) -> LinkTree:
        return LinkTree(
            name=scene_name(robot.get("name")),
            place=self.place,
            kind="link",
            gravity=GRAVITY,
            links=links,
            keep_fixed=self.options.keep_fixed,
            left_out=tuple(left_out(robot, self.place, bool(self.options.stops))),
        )

    def _assembled(self, tree: LinkTree) -> Imported | None:
        """The scene; what is wrong with it joins the mistakes, unless it follows from one of them."""
        try:
            return assembled(tree)
        except SpecificationError as error:
            known = [mistake.place for mistake in self.mistakes]
            self.mistakes += [m for m in error.mistakes if not any(place.startswith(m.place) for place in known)]
            return None

    def _ordered(self, masses: dict[str, MassProperties | None], hung: list[Link]) -> tuple[Link, ...]:
        """Links so that parents come first, in the order of the file; none if they do not hang on each other."""
        hanging = Counter(link.name for link in hung)
        several = [name for name, count in hanging.items() if count > 1]
        for name in several:
            what = f"hangs on {hanging[name]} joints"
            self._mistake(f"{self.place}: link {quoted(name)}", what, "close the loop with MJCF, or in the scene file")
        roots = [name for name in masses if name not in hanging]
        if len(roots) > 1:
            listed = ", ".join(map(quoted, roots))
            self._mistake(self.place, f"has several links that hang on none: {listed}", "join them with fixed joints")
        if several or len(roots) > 1:
            return ()
        below: dict[str | None, list[Link]] = {}
        for link in hung:
            below.setdefault(link.parent, []).append(link)
        base = LinkJoint("base", "free") if self.options.free_base else None
        ordered = [Link(name, None, Pose(), masses[name], base) for name in roots]
        for link in ordered:
            ordered += below.get(link.name, [])
        if len(ordered) < len(masses):
            reached = {link.name for link in ordered}
            circle = ", ".join(quoted(name) for name in masses if name not in reached)
            self._mistake(
                self.place, f"has links that hang on each other in a circle: {circle}", "hang one on the base"
            )
            return ()
        return tuple(ordered)
