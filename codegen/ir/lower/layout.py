"""The graph of a set of demands: every quantity that may be computed, numbered.

`codegen.ir.lower.ways` lays out the ways to compute each.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

from codegen.ir.lower.alternatives import Classes, Key, Node, Prices
from codegen.ir.lower.entry_classes import EntryClasses
from codegen.ir.lower.frames import FrameTree
from codegen.ir.lower.polynomial import Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Dyadic, Named, Vector
from codegen.ir.lower.space import Space

Signed = tuple[int, int]
"""Sign and number of a node."""

Turned = tuple[int, int, bool]
"""Sign and number of a node, and whether its transpose is meant."""


class Placed(dict[str, Signed]):
    """Frame -> node of one vector there, numbered when it is first asked for."""

    __slots__ = ("_number", "_positive", "_sign")

    def __init__(self, vector: Vector, number: Callable[[Key], int]) -> None:
        super().__init__()
        self._sign = vector.sign or 1
        self._positive = vector if self._sign > 0 else -vector
        self._number = number

    def __missing__(self, frame: str) -> Signed:
        found = self[frame] = self._sign, self._number(("vector", self._positive, frame))
        return found


@dataclass(frozen=True, slots=True)
class Turn:
    """The rotation between two frames, as it is applied to vectors.

    Attributes:
        by: ``columns`` (axes of the one seen in the other) or ``rows``.
        axes: nodes of these.
        classes: of the axes.
        family: of the alternatives.
    """

    by: str
    axes: tuple[int, ...]
    classes: tuple[Classes, ...]
    family: str


class Layout:
    """All nodes of a graph, numbered.

    Args:
        space: the vectors and scalars.
        tree: the frames.
        definitions: stage scalar -> its definition, see `codegen.ir.lower.read`.
        prices: of operations.
        axes: frames whose axes have a meaning.
    """

    def __init__(
        self,
        space: Space,
        tree: FrameTree,
        definitions: Mapping[str, tuple[str, tuple[Polynomial, ...]]],
        prices: Prices,
        axes: frozenset[str],
    ) -> None:
        self.space = space
        self.tree = tree
        self.definitions = definitions
        self.prices = prices
        self.axes = axes
        self.nodes: list[Node] = []
        self.sums: dict[Vector, None] = {}
        self.scaled: dict[Vector, None] = {}
        self.products: dict[tuple[int, ...], None] = {}
        self.blocks: dict[tuple[str, str], list[Dyadic]] = {}
        self.traces: dict[Polynomial, list[Signed]] = {}
        self.parts: dict[Vector, list[list[tuple[Polynomial, Vector]]]] = {}
        self._numbers: dict[Key, int] = {}
        self._placed: dict[Vector, Placed] = {}
        self._turns: dict[tuple[str, str, str], Turn] = {}
        self._axes_between: dict[tuple[str, str, str], tuple[int, ...]] = {}
        self._classes_between: dict[tuple[str, str, str], tuple[Classes, ...]] = {}
        self._entries = EntryClasses(space, tree)

    @cached_property
    def dot_families(self) -> tuple[tuple[str, str], ...]:
        """Each frame, and the family of the scalar products in it."""
        return tuple((frame, f"dot {frame}") for frame in self.tree.frames)

    # --- nodes

    def vector(self, vector: Vector, frame: str) -> Signed:
        """A vector in a frame."""
        return self.at(vector)[frame]

    def at(self, vector: Vector) -> Placed:
        """A vector in any frame."""
        found = self._placed.get(vector)
        if found is None:
            found = self._placed[vector] = Placed(vector, self._number)
            if len(vector.terms) > 1:
                self.sums.setdefault(vector if vector.sign >= 0 else -vector)
        return found

    def turn(self, start: str, end: str, by: str) -> Turn:
        """The rotation from ``start`` to ``end`` by its columns or its rows."""
        key = start, end, by
        if key not in self._turns:
            axes, classes = self.axes_between(*key), self.axis_classes(*key)
            self._turns[key] = Turn(by, axes, classes, f"{by} {start} {end}")
        return self._turns[key]

    def axes_between(self, start: str, end: str, by: str) -> tuple[int, ...]:
        """Nodes of the columns, or of the rows, of the rotation from ``start`` to ``end``."""
        key = start, end, by
        if key not in self._axes_between:
            of, seen = (start, end) if by == "columns" else (end, start)
            self._axes_between[key] = tuple(self.vector(self.space.vector(Axis(of, k)), seen)[1] for k in range(3))
        return self._axes_between[key]

    def axis_classes(self, start: str, end: str, by: str) -> tuple[Classes, ...]:
        """Classes of `axes_between`."""
        key = start, end, by
        if key not in self._classes_between:
            self._classes_between[key] = tuple(self.nodes[node].classes for node in self.axes_between(*key))
        return self._classes_between[key]

    def pushed(self, vector: Vector, frame: str) -> Signed:
        """A vector in a frame around its own, the rotation matrices taken as they are."""
        sign = vector.sign or 1
        return sign, self._number(("pushed", vector if sign > 0 else -vector, frame))

    def pulled(self, vector: Vector, frame: str) -> Signed:
        """The components of a vector along the columns of the rotation matrix of a frame, whatever their length."""
        sign = vector.sign or 1
        return sign, self._number(("pulled", vector if sign > 0 else -vector, frame))

    def offset(self, pulled: Vector, plain: Vector, frame: str) -> Signed:
        """The sum of a pulled vector and of one that is in the frame already."""
        return 1, self._number(("offset", pulled, frame, plain))

    def scalar(self, value: Polynomial) -> Signed:
        """A scalar."""
        sign = value.sign or 1
        if len(value.terms) == 1 and len(value.terms[0][0]) > 1:
            self.products.setdefault(value.terms[0][0])
        return sign, self._number(("scalar", value if sign > 0 else -value))

    def outer(self, left: Vector, right: Vector, rows: str, columns: str) -> Signed:
        """An outer product between two frames."""
        sign = (left.sign or 1) * (right.sign or 1)
        left, right = (v if v.sign >= 0 else -v for v in (left, right))
        return sign, self._number(("outer", left, right, rows, columns))

    def rotation(self, factor: Polynomial, rows: str, columns: str) -> Signed:
        """A scalar times the rotation between two frames."""
        sign = factor.sign or 1
        return sign, self._number(("rotation", factor if sign > 0 else -factor, rows, columns))

    def tilde(self, vector: Vector, rows: str, columns: str) -> Signed:
        """The skew map of a vector between two frames."""
        sign = vector.sign or 1
        return sign, self._number(("tilde", vector if sign > 0 else -vector, rows, columns))

    def block(self, dyadic: Dyadic, rows: str, columns: str) -> Turned:
        """A map between two frames: sign, node, and whether it is the transpose of the node's value."""
        if not dyadic.identity and not dyadic.tilde:
            return self.pairs(dyadic, rows, columns)
        return self._map("block", dyadic, rows, columns)

    def pairs(self, pairs: Dyadic, rows: str, columns: str) -> Turned:
        """A sum of outer products between two frames, as for `block`."""
        sign, node, turned = self._map("pairs", pairs, rows, columns)
        key = self.nodes[node].key
        known = self.blocks.setdefault(key[2:], [])
        if key[1] not in known:
            known.append(key[1])
        return sign, node, turned

    def _map(self, kind: str, dyadic: Dyadic, rows: str, columns: str) -> Turned:
        sign, key, turned = _map_key(kind, dyadic, rows, columns)
        return sign, self._number(key), turned

    def known(self, key: Key) -> int | None:
        """Number of a node that something has asked for, else None."""
        return self._numbers.get(key)

    def has_scalar(self, value: Polynomial) -> bool:
        """Whether something has asked for a scalar or its negative."""
        return ("scalar", value if value.sign > 0 else -value) in self._numbers

    def known_map(self, kind: str, dyadic: Dyadic, rows: str, columns: str) -> Turned | None:
        """A ``block`` or ``pairs`` between two frames that something has asked for, as for `block`, else None."""
        sign, key, turned = _map_key(kind, dyadic, rows, columns)
        node = self.known(key)
        return None if node is None else (sign, node, turned)

    def _number(self, key: Key) -> int:
        known = self._numbers.get(key)
        if known is None:
            known = self._numbers[key] = len(self.nodes)
            self.nodes.append(Node(key, self._entries.of(key)))
        return known

    def home(self, vector: Vector) -> str | None:
        """The body that all parts of a vector are fixed in; none for parts of the outermost frame."""
        bodies = set()
        for primitive, _ in vector.terms:
            description = self.space.primitives[primitive]
            if isinstance(description, Cross | Named):
                return None
            chain = self.tree.outward(description.frame)
            bodies.add(chain[-2] if len(chain) > 1 else "")
        body = bodies.pop() if len(bodies) == 1 else ""
        return body or None

    def classes(self, node: int) -> tuple[int, ...]:
        """Classes of the entries of a node."""
        return self.nodes[node].classes


def _map_key(kind: str, dyadic: Dyadic, rows: str, columns: str) -> tuple[int, Key, bool]:
    """Sign and key of the node of a map, and whether it is the transpose of the node's value."""
    turned = rows > columns or (rows == columns and dyadic.transposed.order < dyadic.order)
    if turned:
        dyadic, rows, columns = dyadic.transposed, columns, rows
    sign = dyadic.sign or 1
    return sign, (kind, dyadic if sign > 0 else -dyadic, rows, columns), turned
