"""The mechanism of a compiled MuJoCo model: links, joints and loops in the pose ``qpos0``."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from fractions import Fraction
from typing import Any

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import ImportOptions, LeftOut, quoted, scene_name
from codegen.spec.link_tree import Link, LinkJoint, LinkTree, Loop
from codegen.spec.mjcf_joints import Simple, combined
from codegen.spec.pose import MassProperties, Pose, composed, moved, squared_up
from codegen.spec.scene import ZERO_VECTOR, Coordinate, Matrix, Quaternion, Vector
from codegen.spec.xml_text import shortest

_KINDS = ("free", "ball", "slide", "hinge")
"""Types of joint, by number."""

_CONNECT, _SITES = 0, 6
"""Type of constraint and type of object, by number."""

_NO_CONSTRAINTS, _NO_SPRINGS, _NO_DAMPERS, _NO_GRAVITY = 1 | 2, 32, 64, 128
"""Bits of ``option/flag`` that switch something off."""

_ROUNDING = Fraction(1, 10**14)
"""A part of an inertia below this is what doubles leave of 0."""


def link_tree(specification: Any, model: Any, place: str, options: ImportOptions) -> LinkTree:
    """Read the mechanism.

    Args:
        specification: the ``MjSpec``.
        model: the ``MjModel`` that is made of it.
        place: name of the file, for messages.
        options: how it is read.

    Raises:
        SpecificationError: joints that no joint of a scene is.
    """
    return _Reader(specification, model, place, options).tree()


class _Reader:
    """Reads one model; collects what is wrong and what is left out."""

    def __init__(self, specification: Any, model: Any, place: str, options: ImportOptions) -> None:
        self.specification = specification
        self.model = model
        self.place = place
        self.options = options
        self.names = _names((model.body(k).name for k in range(model.nbody)), "body")
        self.joint_names = _names((model.joint(k).name for k in range(model.njnt)), "joint")
        self.mistakes: list[Mistake] = []
        self.left_out: list[LeftOut] = []

    def tree(self) -> LinkTree:
        links = tuple(self._link(body) for body in range(1, self.model.nbody))
        loops = tuple(loop for k in range(self.model.neq) for loop in self._loop(k))
        if self.mistakes:
            raise SpecificationError(self.mistakes)
        return LinkTree(
            name=scene_name(self.specification.modelname),
            place=self.place,
            kind="body",
            gravity=ZERO_VECTOR if self._is_off(_NO_GRAVITY) else _vector(self.model.opt.gravity),
            links=links,
            loops=loops,
            keep_fixed=self.options.keep_fixed,
            left_out=tuple(self.left_out),
        )

    def _leave_out(self, element: str, place: str, why: str) -> None:
        self.left_out.append(LeftOut(element, f"{self.place}: {place}", why))

    def _is_off(self, flags: int) -> bool:
        return bool(self.model.opt.disableflags & flags)

    def _quaternion(self, values: Sequence[float]) -> Quaternion:
        w, x, y, z = map(shortest, values)
        return squared_up((w, x, y, z), self.options.right_angle)

    # ------------------------------------------------------------------------------------------------
    # bodies

    def _link(self, body: int) -> Link:
        model, place = self.model, f"body {quoted(self.names[body])}"
        if model.body_gravcomp[body]:
            self._leave_out("gravcomp", place, "gravity acts on every body alike")
        if model.body_mocapid[body] >= 0:
            self._leave_out("mocap", place, "the body stays where it is")
        parent = int(model.body_parentid[body])
        pose = Pose(_vector(model.body_pos[body]), self._quaternion(model.body_quat[body]))
        return Link(
            name=self.names[body],
            parent=self.names[parent] if parent else None,
            pose=pose,
            masses=self._masses(body) if model.body_mass[body] else None,
            joint=self._joint(body),
        )

    def _masses(self, body: int) -> MassProperties:
        """Mass properties in the axes of the body; as in the file where MuJoCo has not changed them."""
        model = self.model
        pose = Pose(_vector(model.body_ipos[body]), self._quaternion(model.body_iquat[body]))
        a, b, c = map(shortest, model.body_inertia[body])
        nought = Fraction(0)
        principal = ((a, nought, nought), (nought, b, nought), (nought, nought, c))
        masses = moved(MassProperties(shortest(model.body_mass[body]), ZERO_VECTOR, principal), pose)
        return MassProperties(
            masses.mass, masses.centre, self._written(body, masses.inertia) or _cleaned(masses.inertia)
        )

    def _written(self, body: int, compiled: Matrix) -> Matrix | None:
        """The ``fullinertia`` of the file, if MuJoCo has taken it over: it keeps principal values only."""
        if body >= len(self.specification.bodies):
            return None
        xx, yy, zz, xy, xz, yz = (float(value) for value in self.specification.bodies[body].fullinertia)
        if not all(map(math.isfinite, (xx, yy, zz, xy, xz, yz))):
            return None
        exact = tuple(tuple(map(shortest, row)) for row in ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz)))
        size = max(abs(value) for row in compiled for value in row)
        pairs = (pair for rows in zip(exact, compiled, strict=True) for pair in zip(*rows, strict=True))
        return exact if all(abs(a - b) <= size / 10**12 for a, b in pairs) else None  # type: ignore[return-value]

    # ------------------------------------------------------------------------------------------------
    # joints

    def _joint(self, body: int) -> LinkJoint | None:
        start, count = int(self.model.body_jntadr[body]), int(self.model.body_jntnum[body])
        stack = [self._simple(joint) for joint in range(start, start + count)]
        made = combined(stack) if stack else None
        if stack and made is None:
            listed = ", ".join(f"{joint.kind} {quoted(joint.name)}" for joint in stack)
            what = f"these joints of one body are no joint of a scene together: {listed}"
            remedy = "put a body with a mass between them"
            self.mistakes.append(Mistake(f"{self.place}: body {quoted(self.names[body])}", what, remedy))
        return made

    def _simple(self, joint: int) -> Simple:
        kind = _KINDS[int(self.model.jnt_type[joint])]
        place = f"joint {quoted(self.joint_names[joint])}"
        self._list_unmodelled(joint, place)
        coordinate = self._coordinate(joint, kind, place)
        axis, point = _vector(self.model.jnt_axis[joint]), _vector(self.model.jnt_pos[joint])
        if kind in ("hinge", "slide") and not any(axis):
            self.mistakes.append(Mistake(f"{self.place}: {place}: axis", "has no direction", "write a vector near 1"))
            axis = (Fraction(0), Fraction(0), Fraction(1))
        return Simple(self.joint_names[joint], kind, ZERO_VECTOR if kind == "free" else point, axis, coordinate)

    def _coordinate(self, joint: int, kind: str, place: str) -> Coordinate:
        model = self.model
        stiffness, damping = shortest(model.jnt_stiffness[joint]), shortest(model.dof_damping[model.jnt_dofadr[joint]])
        if self._is_off(_NO_SPRINGS):
            stiffness = Fraction(0)
        if self._is_off(_NO_DAMPERS):
            damping = Fraction(0)
        if kind in ("free", "ball"):
            for element, value in (("stiffness", stiffness), ("damping", damping)):
                if value:
                    self._leave_out(element, place, f"acts on no single coordinate of a joint that is {kind}")
            return Coordinate()
        address = model.jnt_qposadr[joint]
        start = shortest(model.qpos0[address])
        rest = shortest(model.qpos_spring[address]) - start if stiffness else Fraction(0)
        limit = None
        if model.jnt_limited[joint] and self.options.stops:
            lower, upper = (shortest(value) - start for value in model.jnt_range[joint])
            limit = self.options.stops.limit(lower, upper, kind == "hinge")
        return Coordinate(stiffness=stiffness, damping=damping, rest=rest, limit=limit)

    def _list_unmodelled(self, joint: int, place: str) -> None:
        model = self.model
        dof = model.jnt_dofadr[joint]
        kind = _KINDS[int(model.jnt_type[joint])]
        if model.jnt_limited[joint] and not (self.options.stops and kind in ("hinge", "slide")):
            self._leave_out(
                "range", place, "the joint has no stops; ask for soft ones, which hinges and slides may have"
            )
        if model.dof_frictionloss[dof]:
            self._leave_out("frictionloss", place, "dry friction is not modelled")
        if model.dof_armature[dof]:
            self._leave_out("armature", place, "the inertia of a rotor is not modelled; add it to a body")
        for key, values in (("stiffness", "jnt_stiffnesspoly"), ("springyield", "jnt_springyield")):
            if any(getattr(model, values)[joint : joint + 1].flat):
                self._leave_out(key, place, "only the linear part of a spring is modelled")
        if any(model.dof_dampingpoly[dof]):
            self._leave_out("damping", place, "only the linear part of a damper is modelled")

    # ------------------------------------------------------------------------------------------------
    # loops

    def _loop(self, k: int) -> list[Loop]:
        model = self.model
        kind = "connect" if model.eq_type[k] == _CONNECT else "weld"
        name = model.equality(k).name or f"{kind} {k + 1}"
        if self._is_off(_NO_CONSTRAINTS) or not model.eq_active0[k]:
            self._leave_out(kind, quoted(name), "it is switched off")
            return []
        if model.eq_objtype[k] == _SITES:
            return [self._loop_of_sites(name, kind, int(model.eq_obj1id[k]), int(model.eq_obj2id[k]))]
        first, second = (self._link_name(int(body)) for body in (model.eq_obj1id[k], model.eq_obj2id[k]))
        data = model.eq_data[k]
        if kind == "connect":
            return [Loop(name, "ball", (first, second), (Pose(_vector(data[0:3])), None))]
        anchor = Pose(_vector(data[0:3]))
        of_second = Pose(_vector(data[3:6]), self._quaternion(data[6:10]))
        return [Loop(name, "rigid", (second, first), (anchor, composed(of_second, anchor)))]

    def _loop_of_sites(self, name: str, kind: str, first: int, second: int) -> Loop:
        model = self.model
        links = [self._link_name(int(model.site_bodyid[site])) for site in (first, second)]
        frames = [
            Pose(_vector(model.site_pos[site]), self._quaternion(model.site_quat[site])) for site in (first, second)
        ]
        return Loop(name, "ball" if kind == "connect" else "rigid", (links[0], links[1]), (frames[0], frames[1]))

    def _link_name(self, body: int) -> str | None:
        return self.names[body] if body else None


def _names(names: Iterable[str], kind: str) -> list[str]:
    """Names for all: what has none is counted."""
    given = list(names)
    taken = set(given)
    return [name or _free_name(f"{kind} {k}", taken) for k, name in enumerate(given)]


def _free_name(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "_"
    return name


def _vector(values: Sequence[float]) -> Vector:
    x, y, z = map(shortest, values)
    return x, y, z


def _cleaned(inertia: Matrix) -> Matrix:
    """An inertia without what doubles leave of 0, symmetric."""
    size = max(abs(value) for row in inertia for value in row)
    rows = [[x if abs(x) > _ROUNDING * size else Fraction(0) for x in row] for row in inertia]
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = rows
    return ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))
