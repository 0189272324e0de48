"""Inertia matrix M, bias force f_C and gravity force f_G of the tree, by composite bodies.

``M qdd + f_C = f_G + tau + ...``. All links carried by a joint move as one body when it alone accelerates: F and N are
the force and the moment about the joint's origin that this takes; axes are those of the base.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.mechanics.chain.bias import Bias
from codegen.mechanics.chain.bodies import Bodies
from codegen.mechanics.chain.geometry import Geometry, combined
from codegen.mechanics.chain.grouping import Inertia
from codegen.mechanics.chain.tree import ROOT, Node
from codegen.mechanics.chain.vectors import (
    ZERO,
    Vector,
    added,
    cross,
    dot,
    is_zero,
    scaled,
    times,
)


class Composite:
    """The dynamics of the tree.

    Args:
        geometry: in the axes of the base.
        bias: motion of the links, with that of the base.
        progressive: whether moments are carried from joint to joint, or summed about one point of the path.
    """

    def __init__(self, geometry: Geometry, bias: Bias, progressive: bool) -> None:
        self._geometry, self._bias, self._progressive = geometry, bias, progressive
        self._tree = geometry.tree
        self._bodies = Bodies(geometry)
        self._needed: dict[int, tuple[Vector, Vector]] = {}
        self._wrenches: dict[int, tuple[Vector, Vector]] = {}

    # --- M

    def matrix(self) -> sympy.Matrix:
        """M, symmetric."""
        size = len(self._tree.links)
        found = sympy.zeros(size, size)
        for node in self._tree.links:
            k = node.number
            found[k, k] = self._own_entry(node)
            for j, value in self._coupled(node):
                found[j, k] = found[k, j] = value
        return found

    def _own_entry(self, node: Node) -> Any:
        """Force or moment on the joint that accelerates."""
        k = node.number
        if not node.turns:
            return self._bodies.mass(k)
        z, own = self._geometry.z(k), self._bodies.own[k].I[2][2]
        if node.slides:
            own += node.advance**2 * self._bodies.mass(k)
        if self._bodies.has_children(k):
            return own + dot(z, self._of_children(k))
        return own

    def _coupled(self, node: Node) -> list[tuple[int, Any]]:
        """Forces or moments on the joints that carry it."""
        end = None if self._progressive else self._end(node)
        return self._from_joint_to_joint(node) if end is None else self._about(node, end)

    def _from_joint_to_joint(self, node: Node) -> list[tuple[int, Any]]:
        F, N = self._force(node.number)
        found, at = [], node.number
        for carrier in self._tree.above(node.number):
            N, at = self._carried(F, N, at, f"N{node.number + 1}"), carrier.number
            found.append((at, self._along(carrier, F, N)))
        return found

    def _along(self, node: Node, F: Vector, N: Vector) -> Any:
        """What a force, and a moment about the joint's origin, do along its coordinate."""
        z = self._geometry.z(node.number)
        force = node.advance * dot(z, F)
        return force + dot(z, N) if node.turns else force

    def _about(self, node: Node, end: Node) -> list[tuple[int, Any]]:
        """The same by the moment about the far end of a loop, whose velocities J has."""
        F, N = self._force(node.number)
        arm = self._geometry.reach(node.number, end.number)
        moment = self._geometry.named("Z", node.number, added(N, cross(F, arm)), "moment about the far end")
        found = []
        for carrier in self._tree.above(node.number):
            j = carrier.number
            turning = self._along(carrier, F, moment)
            found.append((j, turning + dot(self._geometry.swept(j, end.number), F) if carrier.turns else turning))
        return found

    def _end(self, node: Node) -> Node | None:
        """The far end of a loop through the base that a link carries."""
        cuts = (cut for cut in self._tree.cuts if self._tree.loop_root(cut) == ROOT)
        return next((R for _, R in cuts if node in self._tree.path(R.number)), None)

    def _carried(self, F: Vector, N: Vector, number: int, name: str) -> Vector:
        """The moment about the origin of the parent."""
        offset = self._geometry.offset(number)
        if is_zero(offset) or is_zero(F):
            return N
        return self._geometry.named(name, number, added(N, cross(offset, F)), "moment about the parent's origin")

    def _force(self, k: int) -> tuple[Vector, Vector]:
        """F and N of a joint that accelerates by 1."""
        if k not in self._needed:
            F, N = self._unit(k)
            named = self._geometry.named
            self._needed[k] = named("F", k, F, "force for a unit acceleration"), named("N", k, N, "and moment")
        return self._needed[k]

    def _unit(self, k: int) -> tuple[Vector, Vector]:
        x, y, z = self._geometry.axes(k)
        own, node = self._bodies.own[k], self._tree.nodes[k]
        if not node.turns:
            return self._unit_slide(k)
        if self._bodies.has_children(k) or node.slides:
            F, N = cross(z, self._bodies.moment(k)), added(self._of_children(k), combined((x, y, z), own.I[2]))
        else:
            F, N = combined((x, y, z), (-own.S[1], own.S[0], 0)), combined((x, y, z), own.I[2])
        if not node.slides:
            return F, N
        force, moment = (scaled(node.advance, part) for part in self._unit_slide(k))
        return added(F, force), added(N, moment)

    def _unit_slide(self, k: int) -> tuple[Vector, Vector]:
        """F and N along z."""
        z = self._geometry.z(k)
        return scaled(self._bodies.mass(k), z), cross(self._bodies.moment(k), z)

    def _of_children(self, k: int) -> Vector:
        """Moment of what hangs on a link, when it turns with unit acceleration."""
        return self._geometry.named(
            "I", k, times(self._bodies.hung_inertia(k), self._geometry.z(k)), "moment of what hangs on it"
        )

    # --- forces

    def gravity(self, g: Vector) -> list[Any]:
        """f_G, of the acceleration of gravity in the axes of the base."""
        return [dot(g, self._force(node.number)[0]) for node in self._tree.links]

    def bias(self) -> list[Any]:
        """f_C."""
        return [self._along(node, *self._wrench(node.number)) for node in self._tree.links]

    def _wrench(self, k: int) -> tuple[Vector, Vector]:
        """Force and moment about its origin that the bias motion of what a link carries takes."""
        if k not in self._wrenches:
            F, N = self._own_wrench(k)
            for child in self._tree.children[k]:
                force, moment = self._wrench(child.number)
                F, N = added(F, force), added(N, self._carried(force, moment, child.number, "C"))
            named = self._geometry.named
            self._wrenches[k] = named("X", k, F, "force of the bias motion"), named("Y", k, N, "and moment")
        return self._wrenches[k]

    def _own_wrench(self, k: int) -> tuple[Vector, Vector]:
        own, bias = self._bodies.own[k], self._bias
        F, N = ZERO, ZERO
        if own.m:
            F = added(F, scaled(own.m, bias.a(k)))
        if not is_zero(own.S):
            S = self._geometry.named("q", k, combined(self._geometry.axes(k), own.S), "mass moment of the link")
            F = added(F, bias.of_fixed(k, own.S))
            N = added(N, cross(S, bias.a(k)))
        return F, added(N, self._euler(k, own))

    def _euler(self, k: int, own: Inertia) -> Vector:
        """``I e + w x I w`` of a link."""
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = own.I
        if not any((xx, xy, xz, yy, yz, zz)):
            return ZERO
        if any((xy, xz, yz)):
            inertia = self._bodies.symmetric("J", k, self._bodies.own_inertia(k), "inertia of the link")
            w = self._bias.w(k)
            momentum = self._geometry.named("L", k, times(inertia, w), "angular momentum")
            return added(times(inertia, self._bias.e(k)), cross(w, momentum))
        number, excess = (0, xx - zz) if xx != zz else (1, yy - zz)
        turning = scaled(zz + excess, self._bias.e(k))
        if excess == 0:
            return turning
        axis = self._geometry.axes(k)[number]
        return added(turning, scaled(-excess, cross(axis, self._bias.of_axis(k, number))))
