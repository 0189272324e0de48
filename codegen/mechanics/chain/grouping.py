"""Mass properties of links regrouped, so that most of them vanish while M, f_C and f_G stay what they are.

A body that is symmetric about the axis of a revolute joint, and without moment of inertia about it, does not feel the
joint: it may as well be fixed on the parent. A link's mass, the moment of its mass along the axis, and
``diag(Y, Y, 0)`` of its inertia go there. A prismatic joint does not turn the link: all its inertia about the origin
goes to the parent. A screw moves its link along the axis as well: mass and mass moment stay. What arrives at the base
is gone. A link that only turns about one direction keeps what matters for that.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from codegen.mechanics.chain.tree import ROOT, Node, Tree
from codegen.mechanics.chain.vectors import (
    Rows,
    Vector,
    added,
    dot,
    is_zero,
    product,
    rows,
    scaled,
    times,
    transposed,
    vector,
)
from codegen.spec.chain import Link

_NO_ROWS: Rows = rows([(0, 0, 0)] * 3)


@dataclass(frozen=True)
class Inertia:
    """Constant mass properties in the axes of a link.

    Attributes:
        m: mass.
        S: [3] mass times mass centre, from the origin.
        I: [3, 3] moments of inertia about the origin.
    """

    m: Any = sympy.S.Zero
    S: Vector = (sympy.S.Zero,) * 3
    I: Rows = _NO_ROWS

    def __add__(self, other: Inertia) -> Inertia:
        together = rows(added(a, b) for a, b in zip(self.I, other.I, strict=True))
        return Inertia(self.m + other.m, added(self.S, other.S), together)

    def moved(self, turn: Rows, arm: Vector) -> Inertia:
        """The same body in the axes and from the origin of a link on which it stands.

        Args:
            turn: its axes to those.
            arm: its origin from that.
        """
        S, turned = times(turn, self.S), product(product(turn, self.I), transposed(turn))
        total = added(S, scaled(self.m, arm))
        shifted = rows(
            added(row, [_shift(arm, S, i, k) + _shift(total, arm, i, k) for k in range(3)])
            for i, row in enumerate(turned)
        )
        return Inertia(self.m, total, shifted)


def _shift(a: Vector, b: Vector, i: int, k: int) -> Any:
    """Entry of ``(a . b) I - (a b^T + b a^T) / 2``."""
    return (dot(a, b) if i == k else 0) - (a[i] * b[k] + a[k] * b[i]) / 2


def of_link(link: Link) -> Inertia:
    """Mass properties of a link from its origin."""
    m, centre = sympy.Rational(link.mass), vector(map(sympy.Rational, link.centre))
    about_centre = rows(map(sympy.Rational, row) for row in link.inertia)
    moment = scaled(m, centre)
    shifted = rows(added(row, [_shift(moment, centre, i, k) for k in range(3)]) for i, row in enumerate(about_centre))
    return Inertia(m, moment, shifted)


def regrouped(tree: Tree) -> list[Inertia]:
    """The mass properties of the links with as many zeros as the joints allow."""
    found = [of_link(link) for link in tree.chain.links]
    for node in reversed(tree.links):
        kept, moved = _parted(tree, node, found[node.number])
        found[node.number] = kept
        if node.parent != ROOT:
            found[node.parent] += moved
    return found


def _parted(tree: Tree, node: Node, whole: Inertia) -> tuple[Inertia, Inertia]:
    """What stays on a link, and what goes to its parent, in the parent's axes.

    Y is chosen so that ``zz I`` and a dyad of one axis stay, of that along which the mass centre lies where it can be.
    """
    if not node.turns:
        arm_free = Inertia(I=whole.I).moved(node.fixed_turn, (0, 0, 0))
        return Inertia(whole.m, whole.S), arm_free
    (xx, xy, xz), (_, yy, yz), (_, _, zz) = whole.I
    is_along_y = not any((xy, xz, yz)) and whole.S[0] == 0 and whole.S[1] != 0
    Y = xx - zz if is_along_y else yy - zz
    symmetric = rows([(Y, 0, 0), (0, Y, 0), (0, 0, 0)])
    if node.slides:
        m, S, moved = whole.m, whole.S, Inertia(I=symmetric).moved(node.turn, (0, 0, 0))
    else:
        m, S = sympy.S.Zero, (whole.S[0], whole.S[1], sympy.S.Zero)
        moved = Inertia(whole.m, (0, 0, whole.S[2]), symmetric).moved(node.turn, node.arm)
    if _turns_about_one_direction(tree, node):
        return Inertia(m, S, rows([(zz, 0, 0), (0, zz, 0), (0, 0, zz)])), moved
    return Inertia(m, S, rows([(xx - Y, xy, xz), (xy, yy - Y, yz), (xz, yz, zz)])), moved


def _turns_about_one_direction(tree: Tree, node: Node) -> bool:
    """Whether all revolute joints that carry a link are parallel to its own, and the base does not turn."""
    if tree.chain.base == "moving":
        return False
    direction = times(node.turn, (0, 0, 1))
    for carrier in tree.above(node.number):
        if carrier.turns and not is_zero(direction[:2]):
            return False
        direction = times(carrier.turn if carrier.turns else carrier.fixed_turn, direction)
    return True
