"""The frames of a chain in the numbering of S2: links, then C, R and E frames, each hung on a link."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import sympy

from codegen.mechanics.chain.vectors import Rows, Vector, product, rows, times, vector
from codegen.spec.angles import cosine_and_sine, quarter_turns
from codegen.spec.chain import BASE, Chain, Frame, Row

ROOT = -1
"""Number of the base among the nodes."""

_SIMPLE = sympy.Rational(1, 10**39)


@dataclass(frozen=True)
class Node:
    """A frame on a link.

    Attributes:
        number: place among the nodes; of a link also that of its coordinate.
        parent: number of the link it is hung on, or `ROOT`.
        row: where.
        type: ``revolute``, ``prismatic`` or ``screw`` of a link, ``fixed`` of other frames.
        pitch: of a screw, m/rad.
    """

    number: int
    parent: int
    row: Row
    type: str
    pitch: Fraction = Fraction(0)

    @property
    def turns(self) -> bool:
        """Whether its coordinate turns the frame about z."""
        return self.type in ("revolute", "screw")

    @property
    def slides(self) -> bool:
        """Whether its coordinate moves the frame along z."""
        return self.type in ("prismatic", "screw")

    @property
    def advance(self) -> sympy.Rational:
        """Way along z for a coordinate of 1."""
        return sympy.Rational(self.pitch) if self.type == "screw" else sympy.Integer(self.slides)

    @cached_property
    def turn(self) -> Rows:
        """``Rz(psi) Rx(alpha)``, constant: parent's axes to those before the joint turns."""
        return _settled(product(rotation_z(self.row.psi), _rotation_x(self.row.alpha)))

    @cached_property
    def fixed_turn(self) -> Rows:
        """``Rz(psi) Rx(alpha) Rz(theta)`` of a frame that does not turn on its parent."""
        return _settled(product(self.turn, rotation_z(self.row.theta)))

    @cached_property
    def arm(self) -> Vector:
        """Constant part of the offset from the parent's origin, parent's axes: all but what the coordinate slides."""
        cosine, sine = map(sympy.Rational, cosine_and_sine(self.row.psi))
        a, c = sympy.Rational(self.row.a), sympy.Rational(self.row.c)
        d = sympy.Integer(0) if self.type == "prismatic" else sympy.Rational(self.row.d - self.pitch * self.row.theta)
        z = times(self.turn, (0, 0, 1))
        return vector((a * cosine + d * z[0], a * sine + d * z[1], c + d * z[2]))


class Tree:
    """The frames of a chain.

    Attributes:
        chain: whose.
        nodes: links, C frames, R frames, E frames.
    """

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self._numbers = {BASE: ROOT} | {link.name: k for k, link in enumerate(chain.links)}
        links = [(link.parent, link.row, link.type, link.pitch) for link in chain.links]
        cuts = [_hung(cut.base) for cut in chain.cuts] + [_hung(cut.far) for cut in chain.cuts]
        hung = links + cuts + [_hung(effector.frame) for effector in chain.effectors]
        self.nodes = tuple(
            Node(k, self._numbers[parent], row, kind, pitch) for k, (parent, row, kind, pitch) in enumerate(hung)
        )

    @property
    def links(self) -> tuple[Node, ...]:
        """The links."""
        return self.nodes[: len(self.chain.links)]

    @property
    def cuts(self) -> list[tuple[Node, Node]]:
        """C and R of each cut."""
        first, number = len(self.chain.links), len(self.chain.cuts)
        return list(zip(self.nodes[first : first + number], self.nodes[first + number :][:number], strict=True))

    @property
    def effectors(self) -> tuple[Node, ...]:
        """The frames of the end effectors."""
        return self.nodes[len(self.chain.links) + 2 * len(self.chain.cuts) :]

    @cached_property
    def children(self) -> dict[int, list[Node]]:
        """Links hung on each link."""
        found: dict[int, list[Node]] = {number: [] for number in (ROOT, *range(len(self.chain.links)))}
        for node in self.links:
            found[node.parent].append(node)
        return found

    def path(self, number: int, root: int = ROOT) -> list[Node]:
        """Nodes from the one after the root to this one."""
        found = []
        while number != root:
            found.append(self.nodes[number])
            number = self.nodes[number].parent
        return found[::-1]

    def above(self, number: int) -> Iterator[Node]:
        """The links that carry a link, nearest first."""
        number = self.nodes[number].parent
        while number != ROOT:
            yield self.nodes[number]
            number = self.nodes[number].parent

    def loop_root(self, cut: tuple[Node, Node]) -> int:
        """The last link that carries both frames of a cut."""
        left = [node.number for node in self.path(cut[0].parent)]
        right = [node.number for node in self.path(cut[1].parent)]
        common = [a for a, b in zip(left, right, strict=False) if a == b]
        return common[-1] if common else ROOT


def _hung(frame: Frame) -> tuple[str, Row, str, Fraction]:
    return frame.link, frame.row, "fixed", Fraction(0)


def rotation_z(angle: object) -> Rows:
    """Rotation about z by a constant angle in rad; exact at right angles."""
    c, s = map(sympy.Rational, cosine_and_sine(angle))  # type: ignore[arg-type]
    return rows([(c, -s, 0), (s, c, 0), (0, 0, 1)])


def _rotation_x(angle: object) -> Rows:
    c, s = map(sympy.Rational, cosine_and_sine(angle))  # type: ignore[arg-type]
    return rows([(1, 0, 0), (0, c, -s), (0, s, c)])


def _settled(matrix: Rows) -> Rows:
    """What 45 digits leave in the place of 0, 1 and their like is taken away."""
    return rows([_settled_value(value) for value in row] for row in matrix)


def _settled_value(value: sympy.Rational) -> sympy.Rational:
    simple = sympy.Rational(round(2 * value), 2)
    return simple if abs(value - simple) < _SIMPLE else value


__all__ = ["ROOT", "Node", "Tree", "quarter_turns", "rotation_z"]
