"""Vectors free of frames: the algebra of dot, cross and outer products in which frames do not occur.

`Space` numbers the primitive vectors (axes of frames, given vectors, cross products of two of these) and the atoms of
scalars, and reduces every vector, scalar and dyadic to a normal form over them. Equal things are found equal, however
they were written; how they were written is kept as a `hint`, since it is one way to evaluate them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from codegen.ir.lower.polynomial import ONE, ZERO, Polynomial, atom, total


@dataclass(frozen=True, slots=True)
class Axis:
    """Axis k of a frame."""

    frame: str
    k: int


@dataclass(frozen=True, slots=True)
class Given:
    """A vector whose components are known in a frame, under a name."""

    frame: str
    name: str


@dataclass(frozen=True, slots=True)
class Cross:
    """Cross product of two primitives by their numbers."""

    left: int
    right: int


@dataclass(frozen=True, slots=True)
class Named:
    """A vector with a name and a definition, taken as a whole: see ``Space.named``."""

    name: str


Primitive = Axis | Given | Cross | Named


class Vector:
    """A sum of scalars times primitive vectors, in ascending order of the primitives."""

    __slots__ = ("__dict__", "_hash", "terms")

    def __init__(self, terms: Mapping[int, Polynomial]) -> None:
        self.terms: tuple[tuple[int, Polynomial], ...] = tuple(sorted((p, c) for p, c in terms.items() if c))
        self._hash = hash(self.terms)

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Vector) and self.terms == other.terms

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Vector) -> Vector:
        result = dict(self.terms)
        for primitive, coefficient in other.terms:
            result[primitive] = result.get(primitive, ZERO) + coefficient
        return Vector(result)

    def __neg__(self) -> Vector:
        return self._negative

    @cached_property
    def _negative(self) -> Vector:
        return Vector({primitive: -coefficient for primitive, coefficient in self.terms})

    def __sub__(self, other: Vector) -> Vector:
        return self + -other

    def times(self, factor: Polynomial) -> Vector:
        """Multiply by a scalar."""
        return Vector({primitive: factor * coefficient for primitive, coefficient in self.terms})

    @cached_property
    def sign(self) -> int:
        """Sign of the first coefficient; 0 for the zero vector."""
        return self.terms[0][1].sign if self.terms else 0

    @property
    def single(self) -> int | None:
        """The primitive, where the vector is one with coefficient 1."""
        return self.terms[0][0] if len(self.terms) == 1 and self.terms[0][1] == ONE else None


class Dyadic:
    """``sum c a b^T + kappa I + w~``: a linear map of vectors, free of frames.

    Attributes:
        pairs: (a, b) -> c, of primitives.
        identity: kappa.
        tilde: w.
    """

    __slots__ = ("_hash", "identity", "pairs", "tilde")

    def __init__(
        self, pairs: Mapping[tuple[int, int], Polynomial], identity: Polynomial = ZERO, tilde: Vector | None = None
    ) -> None:
        self.pairs = tuple(sorted((p, c) for p, c in pairs.items() if c))
        self.identity = identity
        self.tilde = tilde or Vector({})
        self._hash = hash((self.pairs, self.identity, self.tilde))

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Dyadic) and (
            self.pairs == other.pairs and self.identity == other.identity and self.tilde == other.tilde
        )

    def __bool__(self) -> bool:
        return bool(self.pairs or self.identity or self.tilde)

    def __add__(self, other: Dyadic) -> Dyadic:
        pairs = dict(self.pairs)
        for pair, coefficient in other.pairs:
            pairs[pair] = pairs.get(pair, ZERO) + coefficient
        return Dyadic(pairs, self.identity + other.identity, self.tilde + other.tilde)

    def __neg__(self) -> Dyadic:
        return Dyadic({pair: -c for pair, c in self.pairs}, -self.identity, -self.tilde)

    def __sub__(self, other: Dyadic) -> Dyadic:
        return self + -other

    def times(self, factor: Polynomial) -> Dyadic:
        """Multiply by a scalar."""
        return Dyadic({pair: factor * c for pair, c in self.pairs}, factor * self.identity, self.tilde.times(factor))

    @property
    def transposed(self) -> Dyadic:
        """The transpose."""
        return Dyadic({(b, a): c for (a, b), c in self.pairs}, self.identity, -self.tilde)

    @property
    def order(self) -> tuple[object, ...]:
        """A key that tells a dyadic and its transpose apart."""
        return tuple(pair for pair, _ in self.pairs), tuple(c.terms for _, c in self.pairs), self.tilde.sign

    @property
    def sign(self) -> int:
        """Sign by which a dyadic and its negative are told apart."""
        return self.pairs[0][1].sign if self.pairs else self.identity.sign or self.tilde.sign


@dataclass(frozen=True, slots=True)
class Atom:
    """What an atom of a scalar stands for.

    Attributes:
        kind: ``symbol`` (a scalar input), ``stage`` (a scalar with a definition), ``dot``, ``triple`` (of primitives),
            ``raw`` (a scalar product of vectors as the rotation matrices are, orthonormal or not).
        key: name, or numbers of primitives, or vectors.
    """

    kind: str
    key: tuple[Any, ...]


Relation = Callable[[Axis, Axis], Polynomial | None]
"""Scalar product of two axes where the frames know it."""


class Space:
    """Numbers primitives and atoms, and reduces products of vectors to the normal form.

    Args:
        relation: scalar products that frames know, such as entries of H between the joint frames.
    """

    def __init__(self, relation: Relation) -> None:
        self.primitives: list[Primitive] = []
        self.atoms: list[Atom] = []
        self.named: dict[str, Vector] = {}
        self.cross_hints: dict[Vector, list[tuple[Vector, Vector]]] = {}
        self.dot_hints: dict[Polynomial, list[tuple[Vector, Vector]]] = {}
        self.sum_hints: dict[Polynomial, list[tuple[Polynomial, ...]]] = {}
        self.product_hints: dict[Polynomial, list[tuple[Polynomial, Polynomial]]] = {}
        self._relation = relation
        self._numbers: dict[Primitive, int] = {}
        self._atom_numbers: dict[Atom, int] = {}

    def primitive(self, description: Primitive) -> int:
        """Give the number of a primitive."""
        if description not in self._numbers:
            self._numbers[description] = len(self.primitives)
            self.primitives.append(description)
        return self._numbers[description]

    def vector(self, description: Primitive) -> Vector:
        """A primitive as a vector."""
        return Vector({self.primitive(description): ONE})

    def scalar(self, kind: str, *key: Any) -> Polynomial:
        """An atom as a scalar."""
        description = Atom(kind, key)
        if description not in self._atom_numbers:
            self._atom_numbers[description] = len(self.atoms)
            self.atoms.append(description)
        return atom(self._atom_numbers[description])

    def dot(self, left: Vector, right: Vector) -> Polynomial:
        """Scalar product."""
        result = total(a * b * self._dot(p, q) for p, a in left.terms for q, b in right.terms)
        self._remember(self.dot_hints, result, left, right)
        return result

    def raw_dot(self, left: Vector, right: Vector) -> Polynomial:
        """Scalar product with the rotation matrices as they are, an atom of its own."""
        sign = left.sign * right.sign
        left, right = (v if v.sign >= 0 else -v for v in (left, right))
        product = self.scalar("raw", *sorted((left, right), key=lambda v: [p for p, _ in v.terms]))
        return product if sign >= 0 else -product

    def cross(self, left: Vector, right: Vector) -> Vector:
        """Cross product; ``a x (b x c) = b (a . c) - c (a . b)``."""
        result = Vector({})
        for p, a in left.terms:
            for q, b in right.terms:
                result += self._cross(p, q).times(a * b)
        self._remember(self.cross_hints, result, left, right)
        return result

    @staticmethod
    def outer(left: Vector, right: Vector) -> Dyadic:
        """``left right^T``."""
        return Dyadic({(p, q): a * b for p, a in left.terms for q, b in right.terms})

    def tilde(self, vector: Vector) -> Dyadic:
        """Skew map of a vector; of a cross product ``(a x b)~ = b a^T - a b^T``."""
        plain, pairs = dict(vector.terms), Dyadic({})
        for number, coefficient in vector.terms:
            description = self.primitives[number]
            if isinstance(description, Cross):
                del plain[number]
                a, b = description.left, description.right
                pairs += Dyadic({(b, a): coefficient, (a, b): -coefficient})
        return pairs + Dyadic({}, ZERO, Vector(plain))

    def apply(self, dyadic: Dyadic, vector: Vector) -> Vector:
        """The image of a vector."""
        result = vector.times(dyadic.identity)
        for (a, b), c in dyadic.pairs:
            result += Vector({a: c}).times(self.dot(Vector({b: ONE}), vector))
        return result + self.cross(dyadic.tilde, vector) if dyadic.tilde else result

    def compose(self, left: Dyadic, right: Dyadic) -> Dyadic:
        """Product of two maps; ``a~ b~ = b a^T - (a . b) I``."""
        result = right.times(left.identity)
        for (a, b), c in left.pairs:
            row = self.apply(right.transposed, Vector({b: ONE}))
            result += self.outer(Vector({a: c}), row)
        if left.tilde:
            result += Dyadic({}, ZERO, left.tilde).times(right.identity)
            for (a, b), c in right.pairs:
                result += self.outer(self.cross(left.tilde, Vector({a: c})), Vector({b: ONE}))
            if right.tilde:
                result += self.outer(right.tilde, left.tilde)
                result += Dyadic({}, -self.dot(left.tilde, right.tilde))
        return result

    def _remember(self, hints: dict[Any, list[tuple[Vector, Vector]]], key: Any, left: Vector, right: Vector) -> None:
        known = hints.setdefault(key, [])
        if key and (left, right) not in known and len(known) < 6:
            known.append((left, right))

    def _dot(self, p: int, q: int) -> Polynomial:
        p, q = min(p, q), max(p, q)
        left, right = self.primitives[p], self.primitives[q]
        for whole, other in ((left, q), (right, p)):
            if isinstance(whole, Named):
                return total(c * self._dot(part, other) for part, c in self.named[whole.name].terms)
        if isinstance(left, Cross):
            return self._triple(left, q) if not isinstance(right, Cross) else self._quadruple(left, right)
        if isinstance(right, Cross):
            return self._triple(right, p)
        if isinstance(left, Axis) and isinstance(right, Axis):
            if left.frame == right.frame:
                return ONE if left.k == right.k else ZERO
            known = self._relation(left, right)
            if known is not None:
                return known
        return self.scalar("dot", p, q)

    def _quadruple(self, left: Cross, right: Cross) -> Polynomial:
        a, b, c, d = left.left, left.right, right.left, right.right
        return self._dot(a, c) * self._dot(b, d) - self._dot(a, d) * self._dot(b, c)

    def _triple(self, product: Cross, r: int) -> Polynomial:
        a, b = product.left, product.right
        if r in (a, b):
            return ZERO
        for x, y, z in ((a, b, r), (b, r, a)):
            whole = self.primitives[x]
            if isinstance(whole, Named):
                parts = self.named[whole.name].terms
                return total(c * self.dot(self._cross(part, y), Vector({z: ONE})) for part, c in parts)
        for x, y, z in ((a, b, r), (b, r, a), (r, a, b)):
            simple = self._axis_product(x, y)
            if simple is not None:
                return total(c * self._dot(p, z) for p, c in simple.terms)
        order = sorted((a, b, r))
        even = (a, b, r) in (
            (order[0], order[1], order[2]),
            (order[1], order[2], order[0]),
            (order[2], order[0], order[1]),
        )
        triple = self.scalar("triple", *order)
        return triple if even else -triple

    def _axis_product(self, p: int, q: int) -> Vector | None:
        """Cross product of two axes of one frame."""
        left, right = self.primitives[p], self.primitives[q]
        if not (isinstance(left, Axis) and isinstance(right, Axis) and left.frame == right.frame):
            return None
        if left.k == right.k:
            return Vector({})
        third = self.vector(Axis(left.frame, 3 - left.k - right.k))
        return third if (right.k - left.k) % 3 == 1 else -third

    def _cross(self, p: int, q: int) -> Vector:
        left, right = self.primitives[p], self.primitives[q]
        if p == q:
            return Vector({})
        if isinstance(left, Cross) and (not isinstance(right, Cross) or p > q):
            return -self._cross(q, p)
        if isinstance(right, Cross):
            b, c = right.left, right.right
            return Vector({b: self._dot(p, c)}) - Vector({c: self._dot(p, b)})
        axis = self._axis_product(p, q)
        if axis is not None:
            return axis
        product = self.vector(Cross(min(p, q), max(p, q)))
        return product if p < q else -product


def combined(parts: Iterable[tuple[Polynomial, Vector]]) -> Vector:
    """Linear combination of vectors."""
    result = Vector({})
    for coefficient, vector in parts:
        result += vector.times(coefficient)
    return result
