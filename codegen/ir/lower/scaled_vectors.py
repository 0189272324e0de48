"""Vectors with a coefficient of several factors: one factor after another, so that what is scaled by one serves twice.

``(p lambda) h = lambda (p h)`` saves a product where a sum takes ``p h`` too.
"""

from __future__ import annotations

from collections.abc import Iterator

from codegen.ir.lower.alternatives import Alternative, Key
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.polynomial import ONE, Polynomial
from codegen.ir.lower.quantities import Vector, primitive_vector
from codegen.ir.lower.vector_forms import Parts, summed


def by_factors(layout: Layout, key: Key) -> Iterator[Alternative]:
    """Take one factor out of the coefficient of a single vector."""
    if key[0] != "vector" or len(key[1].terms) != 1:
        return
    _, vector, frame = key
    primitive, coefficient = vector.terms[0]
    monomial = coefficient.content
    if len(coefficient.terms) == 1 and len(monomial) > 1:
        for factor in dict.fromkeys(monomial):
            scaled = Vector({primitive: coefficient.without((factor,))})
            layout.scaled.setdefault(scaled if scaled.sign > 0 else -scaled)
            yield summed(layout, [(Polynomial({(factor,): 1}), scaled)], frame, "vector")


def with_scaled(layout: Layout, key: Key) -> Iterator[Alternative]:
    """A sum in which the vectors that are scaled for others anyway are parts of their own."""
    if key[0] != "vector" or len(key[1].terms) < 2:
        return
    _, vector, frame = key
    parts: Parts = []
    for primitive, coefficient in vector.terms:
        scaled = Vector({primitive: coefficient})
        is_scaled = scaled in layout.scaled or -scaled in layout.scaled
        parts.append((ONE, scaled) if is_scaled else (coefficient, primitive_vector(primitive)))
    if any(part == Vector({p: c}) and c != ONE for (_, part), (p, c) in zip(parts, vector.terms, strict=True)):
        yield summed(layout, parts, frame, "vector")
