"""What acts on a chain at all times beside gravity: along its coordinates, and at its end effectors.

``tau_A`` are springs, dampers, constants and soft stops of coordinates; ``f_A`` the wrenches of the effectors,
constants and springs between them, force then moment about the effector's origin, its axes. Forces that switch act
besides where it is told which of them do.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeVar

import sympy

from codegen.mechanics.chain.geometry import Geometry
from codegen.mechanics.chain.tree import Node
from codegen.mechanics.chain.vectors import ZERO, Rows, Vector, added, dot, negative, scaled, times, transposed, vector
from codegen.mechanics.coordinate_load import CoordinateLoad
from codegen.mechanics.placed import rational
from codegen.mechanics.tension import closing, density, square, tension
from codegen.spec.chain_forces import EffectorForce, JointForce, Spring, WorldForce
from codegen.spec.scene import Coordinate

Force = TypeVar("Force", JointForce, EffectorForce, WorldForce)


class Applied:
    """The forces of a chain that act at all times.

    Args:
        geometry: in the axes of the base.
        q: coordinates.
        qd: joint velocities.
        base: rotation from the axes of the base to those of the world.
        on: of each force that switches, in the order of `codegen.spec.chain.Chain.conditions`, 1 while it acts, else 0;
            None to leave these forces out.
    """

    def __init__(self, geometry: Geometry, q: Any, qd: Any, base: Rows, on: Any = None) -> None:
        self._geometry, self._q, self._qd, self._base = geometry, q, qd, base
        self._chain, self._stages, self._on = geometry.tree.chain, geometry.stages, on
        names = (effector.name for effector in self._chain.effectors)
        self._ends = dict(zip(names, geometry.tree.effectors, strict=True))

    # --- along coordinates

    def on_joints(self) -> list[Any]:
        """Give tau_A [n]."""
        found = [sympy.S.Zero] * len(self._chain.links)
        for number, (joint, load, share) in enumerate(self._loads(), 1):
            k = self._chain.index(joint)
            found[k] += share * self._along(load, k, number)
        return found

    def _loads(self) -> Iterator[tuple[str, Coordinate, Any]]:
        for force, share in self._acting(self._chain.joint_forces, 0):
            yield force.joint, Coordinate(force.constant, force.stiffness, force.damping, force.rest), share
        yield from ((stop.joint, Coordinate(limit=stop.limit), sympy.S.One) for stop in self._chain.stops)

    def _acting(self, forces: Iterable[Force], first: int) -> Iterator[tuple[Force, Any]]:
        """Forces, and what share of each acts: 1, or its switch; the first of theirs has the number that is given."""
        for force in forces:
            if force.when is None:
                yield force, sympy.S.One
            elif self._on is not None:
                yield force, self._on[first]
                first += 1

    def _along(self, coordinate: Coordinate, k: int, number: int) -> Any:
        """The load with this number, on a coordinate."""
        alpha, rate = sympy.symbols(f"alpha_{number} rate_{number}")
        load = CoordinateLoad(coordinate, alpha, rate)
        known = self._staged(load.stages, {alpha: self._q[k], rate: self._qd[k]}, "soft stop", "")
        return load.value("force").xreplace(known)

    # --- at effectors

    def at_effectors(self) -> list[Any]:
        """Give f_A, six for each effector."""
        names = [effector.name for effector in self._chain.effectors]
        found = [[*self._own(name)] for name in names]
        for number, spring in enumerate(self._chain.springs, 1):
            pull = self._pull(spring, number)
            for name, force in zip(spring.effectors, (pull, negative(pull)), strict=True):
                found[names.index(name)][:3] = added(
                    vector(found[names.index(name)][:3]), times(self._geometry.axes(self._ends[name].number), force)
                )
        return [value for wrench in found for value in wrench]

    def _own(self, name: str) -> tuple[Any, ...]:
        """The constant wrenches at an effector, its axes."""
        chain = self._chain
        first = [sum(force.when is not None for force in kind) for kind in (chain.joint_forces, chain.effector_forces)]
        acting = [*self._acting(chain.effector_forces, first[0])]
        turned = [*self._acting(chain.world_forces, sum(first))]
        parts = []
        for key in ("force", "moment"):
            given = [_exact(getattr(effector, key)) for effector in chain.effectors if effector.name == name]
            own, world = (
                [scaled(share, _exact(getattr(force, key))) for force, share in forces if force.effector == name]
                for forces in (acting, turned)
            )
            axes = self._geometry.axes(self._ends[name].number)
            parts.append(added(*given, *own, times(axes, times(transposed(self._base), added(ZERO, *world)))))
        return (*parts[0], *parts[1])

    def _pull(self, spring: Spring, number: int) -> Vector:
        """The force of a spring on its first end, axes of the base."""
        one, other = (self._ends[name] for name in spring.effectors)
        gap = self._named(f"gap_{number}", self._between(one, other), "from one end of the spring to the other")
        rate = self._named(f"opening_{number}", self._rate(one, other), "its rate")
        known = {square: dot(gap, gap), closing: dot(gap, rate)}
        law = tension(*(rational(value) for value in (spring.stiffness, spring.damping, spring.length)))
        return scaled(self._staged(law, known, "spring", f"_{number}")[density], gap)

    def _between(self, one: Node, other: Node) -> Vector:
        return added(self._geometry.position(other.number), negative(self._geometry.position(one.number)))

    def _rate(self, one: Node, other: Node) -> Vector:
        """Velocity of one end seen from the other; what carries both, and the base, does not change the length."""
        return added(self._velocity(other), negative(self._velocity(one)))

    def _velocity(self, end: Node) -> Vector:
        """Velocity of the origin of a frame relative to the base."""
        carriers = self._geometry.tree.path(end.parent)
        parts = [scaled(self._qd[node.number], self._geometry.column(node, end.number)[0]) for node in carriers]
        return added(ZERO, *parts)

    # --- stages

    def _staged(self, definitions: Mapping[Any, Any], known: Mapping[Any, Any], words: str, end: str) -> dict[Any, Any]:
        """Name definitions one after the other; gives what stands for each symbol."""
        found = dict(known)
        for symbol, definition in definitions.items():
            value = sympy.Matrix([sympy.sympify(definition).xreplace(found)])
            found[symbol] = self._stages.stage(f"{symbol.name}{end}", value, words)[0]
        return found

    def _named(self, name: str, value: Vector, words: str) -> Vector:
        return vector(self._stages.stage(name, sympy.Matrix(value), words))


def _exact(values: Any) -> Vector:
    return vector(map(sympy.Rational, values))
