"""Inertia matrix M, bias force f_C and gravity force f_G of the tree, by composite bodies.

``M qdd + f_C = f_G + tau + ...``. All links carried by a joint move as one body when it alone accelerates: F and N are
the force and the moment about the joint's origin that this takes. Mass properties are those of
`codegen.mechanics.chain.grouping`; axes are those of the base.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy

from codegen.mechanics.chain.bias import Bias
from codegen.mechanics.chain.geometry import Geometry, combined
from codegen.mechanics.chain.grouping import Inertia, regrouped
from codegen.mechanics.chain.tree import ROOT, Node
from codegen.mechanics.chain.vectors import (
    ZERO,
    Rows,
    Vector,
    added,
    cross,
    dot,
    is_zero,
    rows,
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
        self._own = regrouped(self._tree)
        self._masses: dict[int, Any] = {}
        self._moments: dict[int, Vector] = {}
        self._hung: dict[int, Rows] = {}
        self._wholes: dict[int, Rows] = {}
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
        if node.type == "prismatic":
            return self._mass(k)
        z, own = self._geometry.z(k), self._own[k].I[2][2]
        if self._has_children(k):
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
            z = self._geometry.z(at)
            found.append((at, dot(z, F if carrier.type == "prismatic" else N)))
        return found

    def _about(self, node: Node, end: Node) -> list[tuple[int, Any]]:
        """The same by the moment about the far end of a loop, whose velocities J has."""
        F, N = self._force(node.number)
        arm = self._geometry.reach(node.number, end.number)
        moment = self._geometry.named("Z", node.number, added(N, cross(F, arm)), "moment about the far end")
        found = []
        for carrier in self._tree.above(node.number):
            j = carrier.number
            turning = dot(self._geometry.z(j), moment) + dot(self._geometry.swept(j, end.number), F)
            found.append((j, dot(self._geometry.z(j), F) if carrier.type == "prismatic" else turning))
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
        own = self._own[k]
        if self._tree.nodes[k].type == "prismatic":
            return scaled(self._mass(k), z), cross(self._moment(k), z)
        if not self._has_children(k):
            return combined((x, y, z), (-own.S[1], own.S[0], 0)), combined((x, y, z), own.I[2])
        return cross(z, self._moment(k)), added(self._of_children(k), combined((x, y, z), own.I[2]))

    def _of_children(self, k: int) -> Vector:
        """Moment of what hangs on a link, when it turns with unit acceleration."""
        return self._geometry.named(
            "I", k, times(self._hung_inertia(k), self._geometry.z(k)), "moment of what hangs on it"
        )

    def _has_children(self, k: int) -> bool:
        """Whether anything that hangs on a link has mass properties."""
        return any(
            self._mass(child.number) or not is_zero((*self._moment(child.number), *_all(self._whole(child.number))))
            for child in self._tree.children[k]
        )

    # --- composite bodies

    def _mass(self, k: int) -> Any:
        if k not in self._masses:
            children = self._tree.children[k]
            self._masses[k] = self._own[k].m + sum(self._mass(child.number) for child in children)
        return self._masses[k]

    def _moment(self, k: int) -> Vector:
        """Mass moment of what a link carries, with itself, about its origin."""
        if k not in self._moments:
            own = combined(self._geometry.axes(k), self._own[k].S)
            hung = [self._moved_moment(child) for child in self._tree.children[k]]
            self._moments[k] = self._geometry.named("S", k, added(own, *hung), "mass moment of what the link carries")
        return self._moments[k]

    def _moved_moment(self, child: Node) -> Vector:
        """Mass moment of a composite body about the parent's origin."""
        k = child.number
        if not self._mass(k):
            return self._moment(k)
        value = added(self._moment(k), scaled(self._mass(k), self._geometry.offset(k)))
        return self._geometry.named("P", k, value, "about the parent's origin")

    def _hung_inertia(self, k: int) -> Rows:
        """Inertia of what hangs on a link about its origin."""
        if k not in self._hung:
            parts = [self._shifted(child) for child in self._tree.children[k]]
            total = rows(added(*columns) for columns in zip(*parts, strict=True)) if parts else rows([ZERO] * 3)
            self._hung[k] = self._symmetric("H", k, total, "inertia of what hangs on the link")
        return self._hung[k]

    def _whole(self, k: int) -> Rows:
        """Inertia of what a link carries, with itself, about its origin."""
        if k not in self._wholes:
            own = self._own_inertia(k)
            hung = self._hung_inertia(k)
            total = rows(added(a, b) for a, b in zip(own, hung, strict=True))
            self._wholes[k] = self._symmetric("W", k, total, "inertia of what the link carries")
        return self._wholes[k]

    def _own_inertia(self, k: int) -> Rows:
        """``zz I`` and dyads of the axes of a link."""
        x, y, z = self._geometry.axes(k)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = self._own[k].I
        named = self._geometry.named
        if not any((xy, xz, yz)):
            axis, excess = (x, xx - zz) if xx != zz else (y, yy - zz)
            by_axis = named("i", k, scaled(excess, axis), "inertia by an axis")
            return rows(((zz if i == j else 0) + axis[i] * by_axis[j] for j in range(3)) for i in range(3))
        by_x = named("i", k, combined((x, y, z), ((xx - zz) / 2, xy, xz)), "inertia by x")
        by_y = named("j", k, scaled(yz, z), "inertia by y")
        return rows(
            ((zz if i == j else 0) + _dyad(x, by_x, i, j) + _dyad(y, by_y, i, j) for j in range(3)) for i in range(3)
        )

    def _shifted(self, child: Node) -> Rows:
        """Inertia of a composite body about the parent's origin."""
        k = child.number
        offset, whole = self._geometry.offset(k), self._whole(k)
        if is_zero(offset):
            return whole
        S, P = self._moment(k), self._moved_moment(child)
        both = scaled(2, S) if P is S else added(S, P)
        total = self._geometry.named("Q", k, both, "sum of the mass moments about both origins")
        t = self._geometry.named("t", k, (x * y for x, y in zip(offset, total, strict=True)), "offset times it")
        return rows(
            (
                whole[i][j] + (t[(i + 1) % 3] + t[(i + 2) % 3] if i == j else -(offset[i] * P[j] + S[i] * offset[j]))
                for j in range(3)
            )
            for i in range(3)
        )

    def _symmetric(self, name: str, k: int, matrix: Rows, words: str) -> Rows:
        """Name the six entries of a symmetric matrix."""
        xx, yy, zz = self._geometry.named(name, k, (matrix[i][i] for i in range(3)), words)
        yz, zx, xy = self._geometry.named(f"{name}o", k, (matrix[1][2], matrix[0][2], matrix[0][1]), f"{words}, mixed")
        return rows([(xx, xy, zx), (xy, yy, yz), (zx, yz, zz)])

    # --- forces

    def gravity(self, g: Vector) -> list[Any]:
        """f_G, of the acceleration of gravity in the axes of the base."""
        return [dot(g, self._force(node.number)[0]) for node in self._tree.links]

    def bias(self) -> list[Any]:
        """f_C."""
        found = []
        for node in self._tree.links:
            F, N = self._wrench(node.number)
            found.append(dot(self._geometry.z(node.number), F if node.type == "prismatic" else N))
        return found

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
        own, bias = self._own[k], self._bias
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
            inertia = self._symmetric("J", k, self._own_inertia(k), "inertia of the link")
            w = self._bias.w(k)
            momentum = self._geometry.named("L", k, times(inertia, w), "angular momentum")
            return added(times(inertia, self._bias.e(k)), cross(w, momentum))
        number, excess = (0, xx - zz) if xx != zz else (1, yy - zz)
        turning = scaled(zz + excess, self._bias.e(k))
        if excess == 0:
            return turning
        axis = self._geometry.axes(k)[number]
        return added(turning, scaled(-excess, cross(axis, self._bias.of_axis(k, number))))


def _all(matrix: Rows) -> Sequence[Any]:
    return [entry for row in matrix for entry in row]


def _dyad(a: Vector, b: Vector, i: int, k: int) -> Any:
    """Entry of ``a b^T + b a^T``."""
    return 2 * a[i] * b[i] if i == k else a[i] * b[k] + a[k] * b[i]
