"""Velocities, and accelerations without those of the joints: b and c in ``v = D qd + b``, ``vd = D qdd + c`` (S2 7, 8).

In the axes of one link. Of every link: angular velocity w, angular bias acceleration e, and the matrix A that gives the
acceleration of a point fixed on it relative to its origin, ``A r = e x r + w x (w x r)``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy

from codegen.mechanics.chain.geometry import Geometry, combined
from codegen.mechanics.chain.tree import Node
from codegen.mechanics.chain.vectors import ZERO, Rows, Vector, added, cross, is_zero, rows, scaled, times


class Bias:
    """The bias motion of the links.

    Args:
        geometry: of the chain.
        qd: joint velocities.
        w: angular velocity of the root.
        e: angular acceleration of the root.
        a: acceleration of the root's origin.
        prefix: of the names of temporaries.
    """

    def __init__(
        self,
        geometry: Geometry,
        qd: Any,
        w: Vector = ZERO,
        e: Vector = ZERO,
        a: Vector = ZERO,
        prefix: str = "",
    ) -> None:
        root = geometry.root
        self._geometry, self._qd, self._prefix = geometry, qd, prefix
        self._w, self._e, self._a = {root: w}, {root: e}, {root: a}
        self._rates: dict[tuple[tuple[int, int], ...], Any] = {(): sympy.S.Zero}
        self._spins: dict[int, Vector] = {}
        self._matrices: dict[int, Rows] = {}
        self._carried: dict[tuple[int, Vector], Vector] = {}

    def w(self, number: int) -> Vector:
        """Angular velocity of a link."""
        if number not in self._w:
            node, turned = self._at(number)
            if not node.turns:
                return self.w(node.parent)
            value = added(self.w(turned.base), self._spin(number))
            self._w[number] = self._named("w", number, value, "angular velocity")
        return self._w[number]

    def e(self, number: int) -> Vector:
        """Angular bias acceleration of a link."""
        if number not in self._e:
            node, turned = self._at(number)
            if not node.turns:
                return self.e(node.parent)
            value = added(self.e(turned.base), cross(self.w(turned.base), self._spin(number)))
            self._e[number] = self._named("e", number, value, "angular bias acceleration")
        return self._e[number]

    def a(self, number: int) -> Vector:
        """Bias acceleration of the origin of a frame."""
        if number not in self._a:
            node = self._geometry.tree.nodes[number]
            value = added(self.a(node.parent), self._of_offset(node))
            self._a[number] = self._named("a", number, value, "bias acceleration of the origin")
        return self._a[number]

    def of_fixed(self, number: int, point: Vector) -> Vector:
        """``A r`` of a point fixed on a link, r from its origin by constant components along its axes."""
        axes = [k for k in range(3) if point[k] != 0]
        if len(axes) == 1:
            return scaled(point[axes[0]], self.of_axis(number, axes[0]))
        vector = combined(self._geometry.axes(number), point)
        return self._of_vector(self._owner(number), f"p{len(self._carried)}", vector)

    def of_axis(self, number: int, k: int) -> Vector:
        """``A`` times axis k of a link."""
        return self._of_vector(self._carrier(number, k), f"{'xyz'[k]}{number + 1}", self._geometry.axes(number)[k])

    def _carrier(self, number: int, k: int) -> int:
        """The first link on which an axis is fixed: the axis of parallel joints is fixed on the link before them."""
        turned = self._geometry.turned(number)
        column = [row[k] for row in turned.Q]
        return self._owner(turned.base if turned.joints and is_zero(column[:2]) else number)

    def _owner(self, number: int) -> int:
        """The link with which a frame turns."""
        while number != self._geometry.root and not self._geometry.tree.nodes[number].turns:
            number = self._geometry.tree.nodes[number].parent
        return number

    def _of_vector(self, number: int, name: str, vector: Vector) -> Vector:
        """``A`` of a link times a vector fixed on it."""
        if (number, vector) not in self._carried:
            value = times(self._matrix(number), vector)
            self._carried[number, vector] = self._named(f"A{name}", number, value, "acceleration by a fixed vector")
        return self._carried[number, vector]

    def _matrix(self, number: int) -> Rows:
        """A of a link."""
        if number not in self._matrices:
            (x, y, z), (ex, ey, ez) = self.w(number), self.e(number)
            named = self._named
            xx, yy, zz = named("ww", number, (x * x, y * y, z * z), "squares of the angular velocity")
            yz, zx, xy = named("wv", number, (y * z, z * x, x * y), "products of the angular velocity")
            words = "acceleration of points fixed on the link, row"
            values = (-(yy + zz), xy - ez, zx + ey), (xy + ez, -(xx + zz), yz - ex), (zx - ey, yz + ex, -(xx + yy))
            self._matrices[number] = rows(
                named(f"A{k}", number, row, f"{words} {k}") for k, row in enumerate(values, 1)
            )
        return self._matrices[number]

    def _of_offset(self, node: Node) -> Vector:
        if not node.slides:
            return self.of_fixed(node.parent, node.arm)
        along = cross(self.w(self._carrier(node.number, 2)), self._geometry.z(node.number))
        rate = node.advance * self._qd[node.number]
        twice = self._named("k", node.number, scaled(2 * rate, along), "Coriolis acceleration")
        carrier = self._carrier(node.number, 2) if is_zero(node.arm) else self._owner(node.parent)
        offset = self._geometry.offset(node.number)
        return added(self._of_vector(carrier, f"l{node.number + 1}", offset), twice)

    def _spin(self, number: int) -> Vector:
        """Angular velocity of a link relative to the one before its parallel joints."""
        if number not in self._spins:
            _, turned = self._at(number)
            rate = self._rate(turned.joints)
            self._spins[number] = self._named("s", number, scaled(rate, turned.before[2]), "spin")
        return self._spins[number]

    def _rate(self, joints: tuple[tuple[int, int], ...]) -> Any:
        """Sum of the velocities of parallel joints."""
        if joints not in self._rates:
            number, sense = joints[-1]
            value = [self._rate(joints[:-1]) + sense * self._qd[number], 0, 0]
            self._rates[joints] = self._named("n", number, value, "rate about the common axis")[0]
        return self._rates[joints]

    def _at(self, number: int) -> tuple[Node, Any]:
        return self._geometry.tree.nodes[number], self._geometry.turned(number)

    def _named(self, name: str, number: int, value: Iterable[Any], words: str) -> Vector:
        return self._geometry.named(f"{self._prefix}{name}", number, value, words)
