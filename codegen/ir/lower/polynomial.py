"""Polynomials with exact rational coefficients over numbered atoms: the scalars of the vector level.

A polynomial is immutable and hashable. What an atom stands for is known to `codegen.ir.lower.space.Space`.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cache, reduce

Coefficient = int | Fraction
"""Integers stay integers: their arithmetic is fast."""

Monomial = tuple[int, ...]
"""Atoms in ascending order; an atom stands as often as its power says."""


class Polynomial:
    """A sum of rational coefficients times monomials, kept in ascending order of the monomials.

    Attributes:
        terms: monomials and their coefficients.
        sign: of the first coefficient; 0 for zero.
    """

    __slots__ = ("_content", "_hash", "_negative", "sign", "terms")

    def __init__(self, terms: Mapping[Monomial, Coefficient]) -> None:
        left = [(m, c) for m, c in terms.items() if c]
        if len(left) > 1:
            left.sort()
        self.terms: tuple[tuple[Monomial, Coefficient], ...] = tuple(left)
        self.sign = 0 if not left else 1 if left[0][1] > 0 else -1
        self._hash = hash(self.terms)
        self._negative: Polynomial | None = None
        self._content: Monomial | None = None

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Polynomial) and self.terms == other.terms)

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Polynomial) -> Polynomial:
        if not self.terms:
            return other
        if not other.terms:
            return self
        total = dict(self.terms)
        for monomial, coefficient in other.terms:
            total[monomial] = total.get(monomial, 0) + coefficient
        return Polynomial(total)

    def __neg__(self) -> Polynomial:
        if self._negative is None:
            self._negative = Polynomial({monomial: -coefficient for monomial, coefficient in self.terms})
            self._negative._negative = self
        return self._negative

    def __sub__(self, other: Polynomial) -> Polynomial:
        return self + -other

    def __mul__(self, other: Polynomial) -> Polynomial:
        if self == ONE:
            return other
        if other == ONE:
            return self
        product: dict[Monomial, Coefficient] = {}
        for left, a in self.terms:
            for right, b in other.terms:
                monomial = tuple(sorted(left + right))
                product[monomial] = product.get(monomial, 0) + a * b
        return Polynomial(product)

    @property
    def constant(self) -> Coefficient | None:
        """The value, where no atom is in it."""
        if not self.terms:
            return 0
        return self.terms[0][1] if len(self.terms) == 1 and not self.terms[0][0] else None

    @property
    def content(self) -> Monomial:
        """The atoms that every monomial has."""
        if self._content is None:
            self._content = reduce(_shared, (monomial for monomial, _ in self.terms)) if self.terms else ()
        return self._content

    def without(self, factor: Monomial) -> Polynomial:
        """Divide by a monomial that every term has."""
        if not factor:
            return self
        reduced = {}
        for monomial, coefficient in self.terms:
            atoms = list(monomial)
            for index in factor:
                atoms.remove(index)
            reduced[tuple(atoms)] = coefficient
        return Polynomial(reduced)


def _shared(left: Monomial, right: Monomial) -> Monomial:
    """The atoms that two monomials have in common, as often as both have them."""
    others = list(right)
    shared = []
    for index in left:
        if index in others:
            others.remove(index)
            shared.append(index)
    return tuple(shared)


def number(value: Coefficient) -> Polynomial:
    """A constant."""
    return Polynomial({(): int(value) if value == int(value) else value})


@cache
def atom(index: int) -> Polynomial:
    """A single atom."""
    return Polynomial({(index,): 1})


def total(parts: Iterable[Polynomial]) -> Polynomial:
    """Sum of polynomials."""
    result: dict[Monomial, Coefficient] = {}
    for part in parts:
        for monomial, coefficient in part.terms:
            result[monomial] = result.get(monomial, 0) + coefficient
    return Polynomial(result)


ZERO = number(0)
ONE = number(1)
