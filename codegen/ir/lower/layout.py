"""The graph of a set of demands: every quantity that may be computed, and every way to compute it.

`Layout` numbers the nodes and asks `vector_forms`, `scalar_forms` and `block_forms` for the alternatives of each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from itertools import pairwise

from codegen.errors import InternalError
from codegen.ir.lower.alternatives import GENERAL, UNIT, ZERO, Alternative, Classes, Key, Node, Prices, inner_class
from codegen.ir.lower.frames import Component, FrameTree
from codegen.ir.lower.polynomial import Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Dyadic, Given, Named, Vector
from codegen.ir.lower.space import Space

Signed = tuple[int, int]
"""Sign and number of a node."""

Turned = tuple[int, int, bool]
"""Sign and number of a node, and whether its transpose is meant."""


class Layout:
    """All nodes of a graph, numbered, with their alternatives.

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
        self.products: dict[tuple[int, ...], None] = {}
        self.blocks: dict[tuple[str, str], list[Dyadic]] = {}
        self.traces: dict[Polynomial, list[Signed]] = {}
        self._numbers: dict[Key, int] = {}
        self._axes_between: dict[tuple[str, str, str], tuple[int, ...]] = {}
        self._classes_between: dict[tuple[str, str, str], tuple[Classes, ...]] = {}
        self._axis_classes: dict[tuple[int, str], tuple[int, ...]] = {}

    # --- nodes

    def vector(self, vector: Vector, frame: str) -> Signed:
        """A vector in a frame."""
        sign = vector.sign or 1
        if len(vector.terms) > 1:
            self.sums.setdefault(vector if sign > 0 else -vector)
        return sign, self._number(("vector", vector if sign > 0 else -vector, frame))

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
        turned = rows > columns or (rows == columns and dyadic.transposed.order < dyadic.order)
        if turned:
            dyadic, rows, columns = dyadic.transposed, columns, rows
        sign = dyadic.sign or 1
        return sign, self._number((kind, dyadic if sign > 0 else -dyadic, rows, columns)), turned

    def known(self, key: Key) -> int | None:
        """Number of a node that something has asked for, else None."""
        return self._numbers.get(key)

    def _number(self, key: Key) -> int:
        known = self._numbers.get(key)
        if known is None:
            known = self._numbers[key] = len(self.nodes)
            self.nodes.append(Node(key, self._classes(key)))
        return known

    def lay_out(self) -> list[tuple[Alternative, ...]]:
        """Give the alternatives of every node that the demands may need.

        Vectors with raw matrices are laid out first, so that others find them. What takes known sums, products or
        blocks is added at the end, when all of these are known.
        """
        self._extend(self._is_raw)
        self._extend(lambda key: True)
        position = 0
        while position < len(self.nodes):
            node = self.nodes[position]
            base = node.alternatives or self._alternatives(node.key)
            node.alternatives = tuple(dict.fromkeys((*base, *self._with_known(node.key))))
            position += 1
        return [node.alternatives or () for node in self.nodes]

    def _extend(self, includes: Callable[[Key], bool]) -> None:
        position = 0
        while position < len(self.nodes):
            node = self.nodes[position]
            if node.alternatives is None and includes(node.key):
                node.alternatives = self._alternatives(node.key)
            position += 1

    def _with_known(self, key: Key) -> Iterable[Alternative]:
        from codegen.ir.lower import block_forms, scalar_forms, vector_forms

        match key[0]:
            case "vector" | "pushed" | "pulled" if len(key[1].terms) > 1:
                return vector_forms.with_known(self, *key)
            case "scalar":
                return scalar_forms.with_known(self, key[1])
            case "pairs" | "block":
                return block_forms.with_known(self, *key)
        return ()

    def _is_raw(self, key: Key) -> bool:
        """Whether a node leads to vectors turned with raw matrices."""
        if key[0] != "scalar":
            return key[0] in ("pushed", "pulled", "offset")
        return any(self.space.atoms[a].kind in ("raw", "stage") for monomial, _ in key[1].terms for a in monomial)

    def _alternatives(self, key: Key) -> tuple[Alternative, ...]:
        from codegen.ir.lower import block_forms, raw_forms, scalar_forms, vector_forms

        match key[0]:
            case "vector":
                return vector_forms.alternatives(self, key[1], key[2])
            case "pushed" | "pulled":
                return raw_forms.alternatives(self, *key)
            case "offset":
                return raw_forms.offset_alternatives(self, *key[1:])
            case "scalar":
                return scalar_forms.alternatives(self, key[1])
            case "outer":
                return block_forms.outer_alternatives(self, *key[1:])
            case "rotation":
                return block_forms.rotation_alternatives(self, *key[1:])
            case "tilde":
                return block_forms.tilde_alternatives(self, *key[1:])
            case "pairs":
                return block_forms.pair_alternatives(self, *key[1:])
            case "block":
                return block_forms.alternatives(self, *key[1:])
        raise InternalError(f"no alternatives for {key[0]}")

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

    # --- what is known of the entries

    def classes(self, node: int) -> tuple[int, ...]:
        """Classes of the entries of a node."""
        return self.nodes[node].classes

    def _classes(self, key: Key) -> tuple[int, ...]:
        match key[0]:
            case "vector" | "pushed" | "pulled":
                return self.vector_classes(key[1], key[2])
            case "offset":
                return (GENERAL,) * 3
            case "scalar":
                return (scalar_class(key[1]),)
            case "outer":
                left, right = self.vector_classes(key[1], key[3]), self.vector_classes(key[2], key[4])
                return tuple(inner_class([(a, b)]) for a in left for b in right)
        return (GENERAL,) * 9

    def vector_classes(self, vector: Vector, frame: str) -> tuple[int, ...]:
        """Classes of the components of a vector in a frame."""
        found = [ZERO] * 3
        for primitive, coefficient in vector.terms:
            factor = scalar_class(coefficient)
            for k, c in enumerate(self.primitive_classes(primitive, frame)):
                term = inner_class([(factor, c)])
                found[k] = term if not found[k] else GENERAL if term else found[k]
        return tuple(found)

    def primitive_classes(self, primitive: int, frame: str) -> tuple[int, ...]:
        """Classes of the components of a primitive in a frame."""
        key = primitive, frame
        if key not in self._axis_classes:
            self._axis_classes[key] = self._new_primitive_classes(primitive, frame)
        return self._axis_classes[key]

    def _new_primitive_classes(self, primitive: int, frame: str) -> tuple[int, ...]:
        description = self.space.primitives[primitive]
        if isinstance(description, Named):
            return self.vector_classes(self.space.named[description.name], frame)
        if isinstance(description, Cross):
            left, right = (self.primitive_classes(p, frame) for p in (description.left, description.right))
            return tuple(
                inner_class([(left[(k + 1) % 3], right[(k + 2) % 3]), (left[(k + 2) % 3], right[(k + 1) % 3])])
                for k in range(3)
            )
        known = self._home_classes(description)
        path = self.tree.path(description.frame, frame)
        for inner, outer in pairwise(path):
            matrix = self.tree.matrix(outer, inner)
            if matrix is None:
                raise InternalError(f"no rotation from {inner} to {outer}")
            columns = [[component_class(entry) for entry in column] for column in matrix]
            known = tuple(inner_class([(columns[k][row], known[k]) for k in range(3)]) for row in range(3))
        return known if path else (GENERAL,) * 3

    def _home_classes(self, description: Axis | Given) -> tuple[int, ...]:
        if isinstance(description, Axis):
            return tuple(UNIT if k == description.k else ZERO for k in range(3))
        return tuple(component_class(entry) for entry in self.tree.given[description.frame, description.name])


def scalar_class(value: Polynomial) -> int:
    """Class of a scalar."""
    constant = value.constant
    return GENERAL if constant is None else ZERO if not constant else UNIT if abs(constant) == 1 else GENERAL


def component_class(component: Component) -> int:
    """Class of a given component."""
    return scalar_class(component) if isinstance(component, Polynomial) else GENERAL
