"""The recursion of S2 in the axes of each frame: velocities and accelerations outwards, joint wrenches inwards.

``v_ij = S v_i + h qd`` and ``vd_ij = S vd_i + h qdd + gamma`` from the base on (S2 8); back to it
``f_i = sum S^T f_ij + M_i vd_i + f_C,i - f_G,i`` (S2 24, corrected). Gravity is an acceleration of the base upwards.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy

from codegen.ir.lower.staged import Stages
from codegen.mechanics.chain.tree import ROOT, Node, Tree
from codegen.mechanics.chain.vectors import (
    Rows,
    Vector,
    added,
    cross,
    negative,
    product,
    rows,
    scaled,
    times,
    transposed,
    vector,
)

_Z: Vector = (sympy.S.Zero, sympy.S.Zero, sympy.S.One)


@dataclass(frozen=True)
class Twist:
    """Motion of a frame in its own axes.

    Attributes:
        v: velocity of the origin.
        w: angular velocity.
        a: acceleration of the origin.
        e: angular acceleration.
    """

    v: Vector
    w: Vector
    a: Vector
    e: Vector


Wrench = tuple[Vector, Vector]
"""Force, and moment about the origin of a frame, in its axes."""


class Recursion:
    """Motion and wrenches of the tree.

    Args:
        tree: the chain.
        stages: where temporaries are named.
        state: coordinates, velocities, accelerations.
        base: motion of the base.
        prefix: of the names of temporaries.
    """

    def __init__(self, tree: Tree, stages: Stages, state: tuple[Any, Any, Any], base: Twist, prefix: str) -> None:
        self._tree, self._stages, self._prefix = tree, stages, prefix
        self._q, self._qd, self._qdd = state
        self._twists = {ROOT: base}
        self._turns: dict[int, Rows] = {}
        self._arms: dict[int, Vector] = {}

    def twist(self, number: int) -> Twist:
        """Motion of a frame."""
        if number not in self._twists:
            node = self._tree.nodes[number]
            moved = self._moved(node, self.twist(node.parent))
            named = (self._named(name, number, getattr(moved, name), "in own axes") for name in ("v", "w", "a", "e"))
            self._twists[number] = Twist(*named)
        return self._twists[number]

    def _moved(self, node: Node, carrier: Twist) -> Twist:
        back, arm = transposed(self._turn(node)), self._arm(node)
        v = times(back, added(carrier.v, cross(carrier.w, arm)))
        rate = self._named("l", node.number, cross(carrier.w, arm), "w x p")
        a = times(back, added(carrier.a, cross(carrier.e, arm), cross(carrier.w, rate)))
        w, e = times(back, carrier.w), times(back, carrier.e)
        if node.type == "fixed":
            return Twist(v, w, a, e)
        qd, qdd = self._qd[node.number], self._qdd[node.number]
        before = self._named("b", node.number, w, "w of the parent, own axes")
        if node.slides:
            rate, change = node.advance * qd, node.advance * qdd
            v = added(v, scaled(rate, _Z))
            a = added(a, scaled(change, _Z), scaled(2 * rate, cross(before, _Z)))
        if not node.turns:
            return Twist(v, before, a, e)
        turning = scaled(qd, cross(before, _Z))
        return Twist(v, added(before, scaled(qd, _Z)), a, added(e, turning, scaled(qdd, _Z)))

    def wrenches(self, at: Mapping[int, Wrench]) -> list[Wrench]:
        """Wrench of each joint on its link.

        Args:
            at: number of a C, R or E frame -> wrench on the chain there.
        """
        found = [self._inertial(node) for node in self._tree.links]
        for number, (force, moment) in at.items():
            self._take(found, self._tree.nodes[number], (negative(force), negative(moment)))
        for node in reversed(self._tree.links):
            F, N = found[node.number]
            found[node.number] = (
                self._named("F", node.number, F, "force of the joint"),
                self._named("N", node.number, N, "moment of the joint"),
            )
            self._take(found, node, found[node.number])
        return found

    def _take(self, found: list[Wrench], node: Node, wrench: Wrench) -> None:
        """Add what a frame takes to its carrier."""
        if node.parent == ROOT:
            return
        force = self._named("G", node.number, times(self._turn(node), wrench[0]), "axes of the parent")
        moment = added(times(self._turn(node), wrench[1]), cross(self._arm(node), force))
        F, N = found[node.parent]
        found[node.parent] = added(F, force), added(N, moment)

    def _inertial(self, node: Node) -> Wrench:
        """``M vd + f_C`` of one link."""
        link, twist = self._tree.chain.links[node.number], self.twist(node.number)
        m, r = sympy.Rational(link.mass), vector(map(sympy.Rational, link.centre))
        inertia = rows(map(sympy.Rational, row) for row in link.inertia)
        named = self._named
        rate = named("u", node.number, cross(twist.w, r), "w x r")
        centre = named("c", node.number, added(twist.a, cross(twist.e, r), cross(twist.w, rate)), "of the mass centre")
        force = named("f", node.number, scaled(m, centre), "inertia force")
        momentum = named("L", node.number, times(inertia, twist.w), "angular momentum")
        turning = added(times(inertia, twist.e), cross(twist.w, momentum))
        return force, added(cross(r, force), turning)

    def _turn(self, node: Node) -> Rows:
        """Rotation from a frame's axes to its parent's."""
        if not node.turns:
            return node.fixed_turn
        if node.number not in self._turns:
            c, s = sympy.cos(self._q[node.number]), sympy.sin(self._q[node.number])
            turned = product(node.turn, rows([(c, -s, 0), (s, c, 0), (0, 0, 1)]))
            columns = (
                self._named(f"R{'xyz'[k]}", node.number, column, "axis, parent's axes")
                for k, column in enumerate(transposed(turned))
            )
            self._turns[node.number] = transposed(rows(columns))
        return self._turns[node.number]

    def _arm(self, node: Node) -> Vector:
        if node.number not in self._arms:
            way = node.advance * self._q[node.number] if node.slides else 0
            along = scaled(way, times(node.turn, _Z))
            self._arms[node.number] = self._named("p", node.number, added(node.arm, along), "offset, parent's axes")
        return self._arms[node.number]

    def _named(self, name: str, number: int, value: Any, words: str) -> Vector:
        matrix = sympy.Matrix(list(value))
        return vector(self._stages.stage(f"{self._prefix}{name}_{number + 1}", matrix, words))
