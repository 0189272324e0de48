"""Vectors and dyadics free of frames, as sums over primitive vectors: the data of `codegen.ir.lower.space`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from operator import itemgetter
from typing import Any

from codegen.ir.lower.polynomial import ONE, ZERO, Polynomial


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
    """A sum of scalars times primitive vectors, in ascending order of the primitives.

    Attributes:
        terms: primitives and their coefficients.
        sign: of the first coefficient; 0 for the zero vector.
    """

    __slots__ = ("_hash", "_negative", "sign", "terms")

    def __init__(self, terms: Mapping[int, Polynomial]) -> None:
        left = [(p, c) for p, c in terms.items() if c.terms]
        if len(left) > 1:
            left.sort(key=itemgetter(0))
        self.terms: tuple[tuple[int, Polynomial], ...] = tuple(left)
        self.sign = left[0][1].sign if left else 0
        self._hash = hash(self.terms)
        self._negative: Vector | None = None

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return self is other or (isinstance(other, Vector) and self.terms == other.terms)

    def __bool__(self) -> bool:
        return bool(self.terms)

    def __add__(self, other: Vector) -> Vector:
        result = dict(self.terms)
        for primitive, coefficient in other.terms:
            result[primitive] = result.get(primitive, ZERO) + coefficient
        return Vector(result)

    def __neg__(self) -> Vector:
        if self._negative is None:
            self._negative = Vector({primitive: -coefficient for primitive, coefficient in self.terms})
            self._negative._negative = self
        return self._negative

    def __sub__(self, other: Vector) -> Vector:
        return self + -other

    def times(self, factor: Polynomial) -> Vector:
        """Multiply by a scalar."""
        return Vector({primitive: factor * coefficient for primitive, coefficient in self.terms})

    @property
    def single(self) -> int | None:
        """The primitive, where the vector is one with coefficient 1."""
        return self.terms[0][0] if len(self.terms) == 1 and self.terms[0][1] == ONE else None


@cache
def primitive_vector(primitive: int) -> Vector:
    """A primitive by its number, as a vector."""
    return Vector({primitive: ONE})


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


def combined(parts: Iterable[tuple[Polynomial, Vector]]) -> Vector:
    """Linear combination of vectors."""
    result = Vector({})
    for coefficient, vector in parts:
        result += vector.times(coefficient)
    return result
