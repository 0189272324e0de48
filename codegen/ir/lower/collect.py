"""Collect what products share: ``a x b + a x c = a x (b + c)``, ``a . b + a . c = a . (b + c)``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from codegen.ir.lower.polynomial import ONE, Polynomial
from codegen.ir.lower.quantities import Cross, Vector, primitive_vector
from codegen.ir.lower.space import Space

Product = tuple[Vector, Vector]
"""Two vectors that are multiplied."""


def cross_products(space: Space, vector: Vector) -> list[Product]:
    """Write a sum of cross products of primitives with as few cross products; none where something else is in it."""
    pairs: dict[tuple[int, int], Polynomial] = {}
    for primitive, coefficient in vector.terms:
        description = space.primitives[primitive]
        if not isinstance(description, Cross):
            return []
        pairs[description.left, description.right] = coefficient
    return _collected(pairs, anticommutative=True)


def scalar_products(space: Space, value: Polynomial) -> list[Product]:
    """Write a sum of scalar products of primitives with as few scalar products; coefficients go into the vectors.

    Terms with no scalar product, or with several, make the result empty.
    """
    pairs: dict[tuple[int, int], Polynomial] = {}
    for monomial, coefficient in value.terms:
        dots = [index for index in monomial if space.atoms[index].kind == "dot"]
        if len(dots) != 1:
            return []
        rest = list(monomial)
        rest.remove(dots[0])
        p, q = space.atoms[dots[0]].key
        term = Polynomial({tuple(rest): coefficient})
        pairs[p, q] = pairs.get((p, q), Polynomial({})) + term
    return _collected(pairs, anticommutative=False)


def _collected(pairs: dict[tuple[int, int], Polynomial], anticommutative: bool) -> list[Product]:
    """Take the primitive that most pairs share, collect its partners, and go on with the rest; then join."""
    products: list[Product] = []
    while pairs:
        counts = Counter(p for pair in pairs for p in pair)
        shared = min(counts, key=lambda p: (-counts[p], p))
        partners: dict[int, Polynomial] = {}
        for pair in [pair for pair in pairs if shared in pair]:
            coefficient = pairs.pop(pair)
            other = pair[1] if pair[0] == shared else pair[0]
            partners[other] = coefficient if pair[0] == shared or not anticommutative else -coefficient
        products.append((primitive_vector(shared), Vector(partners)))
    return _joined(products)


def _joined(products: Iterable[Product]) -> list[Product]:
    """Join products whose partners differ in a common coefficient only: ``l a x b + m c x b = (l a + m c) x b``."""
    groups: dict[Vector, Vector] = {}
    for left, right in products:
        coefficient, plain = common_coefficient(right)
        groups[plain] = groups.get(plain, Vector({})) + left.times(coefficient)
    return [(left, right) for right, left in groups.items()]


def common_coefficient(vector: Vector) -> tuple[Polynomial, Vector]:
    """Take out a coefficient that all terms have up to sign; where they differ, the sign of the first."""
    first = vector.terms[0][1]
    if all(c in (first, -first) for _, c in vector.terms):
        return first, Vector({p: ONE if c == first else -ONE for p, c in vector.terms})
    return (ONE, vector) if vector.sign > 0 else (-ONE, -vector)
