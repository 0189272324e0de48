"""Where the frames of a chain are and how they are turned, in the axes of one link.

A frame's rotation is ``B Rz(phi) Q``: B the axes of a joint before it turns, phi the sum of the coordinates of
consecutive parallel joints, Q constant. So parallel axes add angles, and need one sine and cosine each.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import sympy

from codegen.errors import InternalError
from codegen.ir.lower.staged import Stages
from codegen.mechanics.chain.tree import ROOT, Node, Tree
from codegen.mechanics.chain.vectors import (
    IDENTITY,
    ZERO,
    Rows,
    Vector,
    added,
    cross,
    is_zero,
    product,
    rows,
    scaled,
    transposed,
    vector,
)

Axes = tuple[Vector, Vector, Vector]
"""Axes x, y, z of a frame, each by its components: the columns of its rotation."""

_LETTERS = "xyz"


@dataclass(frozen=True)
class Turned:
    """A rotation ``B Rz(phi) Q``.

    Attributes:
        base: link before the first of the parallel joints.
        before: columns of B.
        joints: the parallel joints with their senses, 1 or -1.
        angle: phi; 0 if there are no joints.
        after: columns of ``B Rz(phi)``.
        Q: constant.
    """

    base: int
    before: Axes
    joints: tuple[tuple[int, int], ...]
    angle: Any
    after: Axes
    Q: Rows


class Geometry:
    """Frames in the axes of a link, positions from its origin.

    Args:
        tree: the chain.
        stages: where temporaries are named.
        q: coordinates.
        root: number of the link.
        prefix: of the names of temporaries.
    """

    def __init__(self, tree: Tree, stages: Stages, q: Any, root: int = ROOT, prefix: str = "") -> None:
        self.tree, self.stages, self.root, self.prefix = tree, stages, root, prefix
        self._q = q
        self._names: dict[str, tuple[Vector, Vector]] = {}
        self._turned = {root: Turned(root, IDENTITY, (), sympy.S.Zero, IDENTITY, IDENTITY)}
        self._axes: dict[int, Axes] = {root: IDENTITY}
        self._offsets: dict[int, Vector] = {}
        self._positions: dict[int, Vector] = {root: ZERO}
        self._reaches: dict[tuple[int, int], Vector] = {}
        self._swept: dict[tuple[int, int], Vector] = {}

    def named(self, name: str, number: int, value: Iterable[Any], definition: str) -> Vector:
        """Name a vector of a frame; frames count from 1, the base is 0. The same vector may be named again.

        Raises:
            InternalError: the name is that of another vector.
        """
        key, entries = f"{self.prefix}{name}_{number + 1}", vector(value)
        if key not in self._names:
            self._names[key] = entries, vector(self.stages.stage(key, sympy.Matrix(entries), definition))
        known, symbols = self._names[key]
        if known != entries:
            raise InternalError(f"two vectors have the name {key}")
        return symbols

    def coordinate(self, node: Node) -> Any:
        """The joint coordinate of a link."""
        return self._q[node.number]

    # --- directions

    def turned(self, number: int) -> Turned:
        """The rotation of a frame in its parts."""
        if number not in self._turned:
            self._turned[number] = self._turn(self.tree.nodes[number])
        return self._turned[number]

    def axes(self, number: int) -> Axes:
        """The axes of a frame."""
        if number not in self._axes:
            turned = self.turned(number)
            self._axes[number] = rows(
                self.named(letter, number, combined(turned.after, column), f"axis {letter} of frame {number + 1}")
                for letter, column in zip(_LETTERS, transposed(turned.Q), strict=True)
            )
        return self._axes[number]

    def z(self, number: int) -> Vector:
        """The axis z of a frame: of its joint, where it is a link."""
        return self.axes(number)[2]

    def _turn(self, node: Node) -> Turned:
        carrier = self.turned(node.parent)
        if not node.turns:
            return replace(carrier, Q=product(carrier.Q, node.fixed_turn))
        Q = product(carrier.Q, node.turn)
        if is_zero((Q[0][2], Q[1][2])):
            return self._further(node, carrier, Q)
        before = rows(
            self.named(
                f"b{letter}", node.number, combined(self.axes(node.parent), column), f"{letter} before the joint"
            )
            for letter, column in zip(_LETTERS, transposed(node.turn), strict=True)
        )
        angle = self.coordinate(node)
        joints = ((node.number, 1),)
        return Turned(node.parent, before, joints, angle, self._after(node, before, angle), IDENTITY)

    def _further(self, node: Node, carrier: Turned, Q: Rows) -> Turned:
        """A joint parallel to the one before: ``Rz(phi) Q Rz(theta) = Rz(phi + sense theta) Q``."""
        sense = int(Q[2][2])
        constant = sympy.S.Zero
        if any(abs(value) not in (0, 1) for row in Q for value in row):
            constant = sympy.Rational(str(sympy.atan2(Q[1][0], Q[0][0]).evalf(45)))
            Q = rows([(1, 0, 0), (0, sense, 0), (0, 0, sense)])
        first = self._summed(node, "phi0", carrier.angle + constant)
        angle = self._summed(node, "phi", first + sense * self.coordinate(node))
        base = carrier.base if carrier.joints else node.parent
        joints = (*carrier.joints, (node.number, sense))
        return Turned(base, carrier.before, joints, angle, self._after(node, carrier.before, angle), Q)

    def _summed(self, node: Node, name: str, value: Any) -> Any:
        words = "sum of the angles of parallel joints"
        return self.stages.stage(f"{self.prefix}{name}_{node.number + 1}", sympy.Matrix([value]), words)[0]

    def _after(self, node: Node, before: Axes, angle: Any) -> Axes:
        c, s = sympy.cos(angle), sympy.sin(angle)
        x, y, z = before
        u = self.named("u", node.number, added(scaled(c, x), scaled(s, y)), "x turned about the joint")
        v = self.named("v", node.number, added(scaled(c, y), scaled(-s, x)), "y turned about the joint")
        return u, v, z

    # --- positions

    def offset(self, number: int) -> Vector:
        """From the origin of the parent to that of a frame."""
        if number not in self._offsets:
            node = self.tree.nodes[number]
            value = combined(self.axes(node.parent), node.arm)
            if node.slides:
                value = added(value, scaled(node.advance * self.coordinate(node), self.z(number)))
            self._offsets[number] = self.named("l", number, value, "offset from the parent's origin")
        return self._offsets[number]

    def position(self, number: int) -> Vector:
        """Origin of a frame."""
        if number not in self._positions:
            parent = self.tree.nodes[number].parent
            value = added(self.position(parent), self.offset(number))
            self._positions[number] = self.named("o", number, value, f"origin of frame {number + 1}")
        return self._positions[number]

    def reach(self, first: int, last: int) -> Vector:
        """From the origin of a link, or of the root, to that of a frame it carries: summed from the far end."""
        if first == last:
            return ZERO
        if (first, last) not in self._reaches:
            following = self.tree.path(last, first)[0].number
            value = added(self.offset(following), self.reach(following, last))
            words = f"from origin {first + 1} to origin {last + 1}"
            self._reaches[first, last] = self.named(f"d_{first + 1}", last, value, words)
        return self._reaches[first, last]

    def swept(self, first: int, last: int) -> Vector:
        """Velocity of the origin of a frame when a link that carries it turns by 1 about its joint."""
        if (first, last) not in self._swept:
            value = cross(self.z(first), self.reach(first, last))
            words = f"velocity of origin {last + 1} by joint {first + 1}"
            self._swept[first, last] = self.named(f"m_{first + 1}", last, value, words)
        return self._swept[first, last]

    def column(self, joint: Node, last: int) -> tuple[Vector, Vector]:
        """Velocity of the origin of a frame, and its angular velocity, for a unit rate of a joint that carries it."""
        z = self.z(joint.number)
        linear = scaled(joint.advance, z)
        return (added(self.swept(joint.number, last), linear), z) if joint.turns else (linear, ZERO)


def combined(axes: Axes, coefficients: Vector) -> Vector:
    """The vector with these components along the axes."""
    return added(*(scaled(factor, axis) for factor, axis in zip(coefficients, axes, strict=True)))
