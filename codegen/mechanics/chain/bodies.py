"""What the links carry, as composite bodies: mass, mass moment and inertia, each link with all that hangs on it.

Mass properties are those of `codegen.mechanics.chain.grouping`; axes are those of the base.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from codegen.mechanics.chain.geometry import Geometry, combined
from codegen.mechanics.chain.grouping import regrouped
from codegen.mechanics.chain.tree import Node
from codegen.mechanics.chain.vectors import ZERO, Rows, Vector, added, is_zero, rows, scaled


class Bodies:
    """The composite bodies of a tree.

    Args:
        geometry: in the axes of the base.

    Attributes:
        own: mass properties of the links alone.
    """

    def __init__(self, geometry: Geometry) -> None:
        self._geometry, self._tree = geometry, geometry.tree
        self.own = regrouped(self._tree)
        self._masses: dict[int, Any] = {}
        self._moments: dict[int, Vector] = {}
        self._hung: dict[int, Rows] = {}
        self._wholes: dict[int, Rows] = {}

    def has_children(self, k: int) -> bool:
        """Whether anything that hangs on a link has mass properties."""
        return any(
            self.mass(child.number) or not is_zero((*self.moment(child.number), *_all(self.whole(child.number))))
            for child in self._tree.children[k]
        )

    def mass(self, k: int) -> Any:
        """Mass of what a link carries, with itself."""
        if k not in self._masses:
            children = self._tree.children[k]
            self._masses[k] = self.own[k].m + sum(self.mass(child.number) for child in children)
        return self._masses[k]

    def moment(self, k: int) -> Vector:
        """Mass moment of what a link carries, with itself, about its origin."""
        if k not in self._moments:
            own = combined(self._geometry.axes(k), self.own[k].S)
            hung = [self.moved_moment(child) for child in self._tree.children[k]]
            self._moments[k] = self._geometry.named("S", k, added(own, *hung), "mass moment of what the link carries")
        return self._moments[k]

    def moved_moment(self, child: Node) -> Vector:
        """Mass moment of a composite body about the parent's origin."""
        k = child.number
        if not self.mass(k):
            return self.moment(k)
        value = added(self.moment(k), scaled(self.mass(k), self._geometry.offset(k)))
        return self._geometry.named("P", k, value, "about the parent's origin")

    def hung_inertia(self, k: int) -> Rows:
        """Inertia of what hangs on a link about its origin."""
        if k not in self._hung:
            parts = [self._shifted(child) for child in self._tree.children[k]]
            total = rows(added(*columns) for columns in zip(*parts, strict=True)) if parts else rows([ZERO] * 3)
            self._hung[k] = self.symmetric("H", k, total, "inertia of what hangs on the link")
        return self._hung[k]

    def whole(self, k: int) -> Rows:
        """Inertia of what a link carries, with itself, about its origin."""
        if k not in self._wholes:
            own = self.own_inertia(k)
            hung = self.hung_inertia(k)
            total = rows(added(a, b) for a, b in zip(own, hung, strict=True))
            self._wholes[k] = self.symmetric("W", k, total, "inertia of what the link carries")
        return self._wholes[k]

    def own_inertia(self, k: int) -> Rows:
        """``zz I`` and dyads of the axes of a link."""
        x, y, z = self._geometry.axes(k)
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = self.own[k].I
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
        offset, whole = self._geometry.offset(k), self.whole(k)
        if is_zero(offset):
            return whole
        S, P = self.moment(k), self.moved_moment(child)
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

    def symmetric(self, name: str, k: int, matrix: Rows, words: str) -> Rows:
        """Name the six entries of a symmetric matrix."""
        xx, yy, zz = self._geometry.named(name, k, (matrix[i][i] for i in range(3)), words)
        yz, zx, xy = self._geometry.named(f"{name}o", k, (matrix[1][2], matrix[0][2], matrix[0][1]), f"{words}, mixed")
        return rows([(xx, xy, zx), (xy, yy, yz), (zx, yz, zz)])


def _all(matrix: Rows) -> Sequence[Any]:
    return [entry for row in matrix for entry in row]


def _dyad(a: Vector, b: Vector, i: int, k: int) -> Any:
    """Entry of ``a b^T + b a^T``."""
    return 2 * a[i] * b[i] if i == k else a[i] * b[k] + a[k] * b[i]
