"""Vectors free of frames: the algebra of dot, cross and outer products in which frames do not occur.

`Space` numbers the primitive vectors (axes of frames, given vectors, cross products of two of these) and the atoms of
scalars, and reduces every vector, scalar and dyadic to a normal form over them. Equal things are found equal, however
they were written; how they were written is kept as a `hint`, since it is one way to evaluate them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from codegen.ir.lower.polynomial import ONE, ZERO, Polynomial, atom, total
from codegen.ir.lower.quantities import Atom, Axis, Cross, Dyadic, Given, Named, Primitive, Vector, primitive_vector

Relation = Callable[[Axis | Given, Axis | Given], Polynomial | None]
"""Scalar product of two axes or given vectors where the frames know it."""


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
        self._dots: dict[tuple[Vector, Vector], Polynomial] = {}

    def primitive(self, description: Primitive) -> int:
        """Give the number of a primitive."""
        if description not in self._numbers:
            self._numbers[description] = len(self.primitives)
            self.primitives.append(description)
        return self._numbers[description]

    def vector(self, description: Primitive) -> Vector:
        """A primitive as a vector."""
        return primitive_vector(self.primitive(description))

    def scalar(self, kind: str, *key: Any) -> Polynomial:
        """An atom as a scalar."""
        description = Atom(kind, key)
        if description not in self._atom_numbers:
            self._atom_numbers[description] = len(self.atoms)
            self.atoms.append(description)
        return atom(self._atom_numbers[description])

    def dot(self, left: Vector, right: Vector) -> Polynomial:
        """Scalar product."""
        known = self._dots.get((left, right))
        if known is None:
            known = total(a * b * self._dot(p, q) for p, a in left.terms for q, b in right.terms)
            self._dots[left, right] = known
            self._remember(self.dot_hints, known, left, right)
        return known

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
            result += Vector({a: c}).times(self.dot(primitive_vector(b), vector))
        return result + self.cross(dyadic.tilde, vector) if dyadic.tilde else result

    def compose(self, left: Dyadic, right: Dyadic) -> Dyadic:
        """Product of two maps; ``a~ b~ = b a^T - (a . b) I``."""
        result = right.times(left.identity)
        for (a, b), c in left.pairs:
            row = self.apply(right.transposed, primitive_vector(b))
            result += self.outer(Vector({a: c}), row)
        if left.tilde:
            result += Dyadic({}, ZERO, left.tilde).times(right.identity)
            for (a, b), c in right.pairs:
                result += self.outer(self.cross(left.tilde, Vector({a: c})), primitive_vector(b))
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
        if isinstance(left, Axis) and isinstance(right, Axis) and left.frame == right.frame:
            return ONE if left.k == right.k else ZERO
        if not (isinstance(left, Named) or isinstance(right, Named)):
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
                return total(c * self.dot(self._cross(part, y), primitive_vector(z)) for part, c in parts)
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
