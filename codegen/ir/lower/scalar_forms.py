"""The ways to know a scalar: given, defined, a scalar product in some frame, a polynomial of other scalars."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from codegen.ir.lower.alternatives import Alternative, Prices, dot_cost
from codegen.ir.lower.collect import scalar_products
from codegen.ir.lower.layout import Layout, Signed
from codegen.ir.lower.polynomial import ONE, Coefficient, Polynomial, atom, number
from codegen.ir.lower.quantities import Vector, primitive_vector

_KNOWN = 20
"""How many products are looked through for one that is a factor of another."""


@dataclass(frozen=True, slots=True)
class Product:
    """A rational times atoms times plans."""

    coefficient: Coefficient
    factors: tuple[int | Sum, ...]


@dataclass(frozen=True, slots=True)
class Sum:
    """A sum of products."""

    terms: tuple[Product, ...]


def alternatives(layout: Layout, value: Polynomial) -> tuple[Alternative, ...]:
    """Lay out the ways to know a scalar."""
    if value.constant is not None:
        return (Alternative("constant", (), 0.0, value.constant),)
    found: list[Alternative] = []
    monomial, coefficient = value.terms[0]
    if len(value.terms) == 1 and len(monomial) == 1 and coefficient == 1:
        found += _of_atom(layout, monomial[0])
    else:
        found.append(_polynomial(layout, value))
        found += _collected(layout, value)
    for key, sign in ((value, 1), (-value, -1)):
        for left, right in layout.space.dot_hints.get(key, ()):
            found += dots(layout, left, right, sign)
        for parts in layout.space.sum_hints.get(key, ()):
            found.append(_sum(layout, parts, sign))
        for left_factor, right_factor in layout.space.product_hints.get(key, ()):
            found.append(_product(layout, left_factor, right_factor, sign))
    return tuple(dict.fromkeys(found))


def with_known(layout: Layout, value: Polynomial) -> Iterator[Alternative]:
    """Ways that take what something else has asked for: a factor, or the pairs of which the scalar is the trace."""
    yield from _by_known_factor(layout, value)
    for key, sign in ((value, 1), (-value, -1)):
        for trace_sign, pairs in layout.traces.get(key, ()):
            yield Alternative("trace", (pairs,), 2 * layout.prices.add, sign * trace_sign)


def _of_atom(layout: Layout, index: int) -> Iterator[Alternative]:
    description = layout.space.atoms[index]
    if description.kind == "symbol":
        yield Alternative("input", (), 0.0, description.key[0])
    elif description.kind == "stage":
        function, arguments = layout.definitions[description.key[0]]
        children = [layout.scalar(argument) for argument in arguments]
        prices = {"ratio": layout.prices.div, "same": 0.0}
        cost = prices.get(function, 1.0)
        yield Alternative(
            "function", tuple(node for _, node in children), cost, (function, tuple(s for s, _ in children))
        )
    elif description.kind == "dot":
        left, right = (primitive_vector(p) for p in description.key)
        yield from dots(layout, left, right, 1)
        raw = layout.known(("scalar", layout.space.raw_dot(left, right)))
        if raw is not None:
            yield Alternative("same", (raw,), 0.0, 1)
    elif description.kind == "triple":
        yield from _triple(layout, *description.key)
    elif description.kind == "raw":
        yield from _raw(layout, *description.key)


def _triple(layout: Layout, a: int, b: int, c: int) -> Iterator[Alternative]:
    for p, q, r in ((a, b, c), (b, c, a), (c, a, b)):
        first, second, third = (primitive_vector(x) for x in (p, q, r))
        yield from dots(layout, layout.space.cross(first, second), third, 1)


def _raw(layout: Layout, left: Vector, right: Vector) -> Iterator[Alternative]:
    """``(R u) . (R w)`` in the outermost frame, or ``u . (R^T R w)`` in the frame of one of them."""
    outermost = layout.tree.frames[0]
    yield _dot(layout, layout.pushed(left, outermost), layout.pushed(right, outermost), 1)
    for still, moving in ((left, right), (right, left)):
        home = layout.home(still)
        if home is not None:
            yield _dot(layout, layout.pushed(still, home), layout.pulled(moving, home), 1)


def dots(layout: Layout, left: Vector, right: Vector, sign: int) -> Iterator[Alternative]:
    """Scalar products in every frame."""
    left_at, right_at, nodes, prices = layout.at(left), layout.at(right), layout.nodes, layout.prices
    for frame, family in layout.dot_families:
        (left_sign, a), (right_sign, b) = left_at[frame], right_at[frame]
        cost = dot_cost(nodes[a].classes, nodes[b].classes, prices)
        yield Alternative("dot", (a, b), cost, sign * left_sign * right_sign, family)


def _dot(layout: Layout, left: Signed, right: Signed, sign: int) -> Alternative:
    cost = dot_cost(layout.classes(left[1]), layout.classes(right[1]), layout.prices)
    family = f"dot {layout.nodes[left[1]].key[2]}"
    return Alternative("dot", (left[1], right[1]), cost, sign * left[0] * right[0], family)


def _collected(layout: Layout, value: Polynomial) -> Iterator[Alternative]:
    """Scalar products collected: ``a . (b + c)``, and ``l a . b + m c . b = (l a + m c) . b``."""
    products = scalar_products(layout.space, value)
    if len(products) == 1:
        yield from dots(layout, *products[0], 1)
        for still, moving in (products[0], products[0][::-1]):
            apart = _apart(layout, still, moving)
            if apart:
                yield _sum(layout, tuple(layout.space.dot(still, part) for part in apart), 1)
    elif products and len(products) < len(value.terms):
        yield _sum(layout, tuple(layout.space.dot(left, right) for left, right in products), 1)


def _apart(layout: Layout, still: Vector, moving: Vector) -> list[Vector]:
    """Split a vector into what is fixed in the body of another and the rest: their products suit different frames."""
    home = layout.home(still)
    fixed = Vector({p: c for p, c in moving.terms if layout.home(Vector({p: c})) == home})
    rest = moving - fixed
    return [rest, fixed] if home is not None and fixed and rest else []


def _sum(layout: Layout, parts: tuple[Polynomial, ...], sign: int) -> Alternative:
    children = [layout.scalar(part) for part in parts]
    return Alternative(
        "total",
        tuple(node for _, node in children),
        layout.prices.add * (len(parts) - 1),
        tuple(sign * s for s, _ in children),
    )


def _product(layout: Layout, left: Polynomial, right: Polynomial, sign: int) -> Alternative:
    (left_sign, a), (right_sign, b) = layout.scalar(left), layout.scalar(right)
    cost = dot_cost(layout.classes(a), layout.classes(b), layout.prices)
    return Alternative("product", (a, b), cost, sign * left_sign * right_sign)


def _by_known_factor(layout: Layout, value: Polynomial) -> Iterator[Alternative]:
    """A product one factor of which is known as a product itself."""
    if len(value.terms) != 1 or len(value.terms[0][0]) < 2:
        return
    monomial, coefficient = value.terms[0]
    for known in list(layout.products)[:_KNOWN]:
        if len(known) >= len(monomial) or not set(known) <= set(monomial):
            continue
        rest = Counter(monomial)
        rest.subtract(known)
        if min(rest.values()) >= 0:
            other = Polynomial({tuple(sorted(rest.elements())): coefficient})
            yield _product(layout, Polynomial({known: 1}), other, 1)


def _polynomial(layout: Layout, value: Polynomial) -> Alternative:
    plan = plan_of(value)
    atoms = sorted({index for monomial, _ in value.terms for index in monomial})
    children = tuple(layout.scalar(atom(index))[1] for index in atoms)
    return Alternative("polynomial", children, _cost(plan, layout.prices), (plan, tuple(atoms)))


def plan_of(value: Polynomial) -> Sum:
    """Factor a polynomial by what most of its terms share, again and again."""
    if not value.terms:
        return Sum(())
    content = value.content
    rest = value.without(content)
    first = rest.terms[0][1]
    common: Coefficient = first if first > 0 else -first
    if common != 1 and all(abs(c) == common for _, c in rest.terms):
        rest = rest * number(Fraction(1, common))
    else:
        common = 1
    if rest == ONE or len(rest.terms) == 1:
        monomial, coefficient = rest.terms[0]
        return Sum((Product(coefficient * common, (*content, *monomial)),))
    inner = _sum_plan(rest)
    if content or common != 1:
        return Sum((Product(common, (*content, inner)),))
    return inner


def _sum_plan(value: Polynomial) -> Sum:
    """Plan of a polynomial whose terms have no common factor."""
    counts = Counter(index for monomial, _ in value.terms for index in set(monomial))
    index, count = min(counts.items(), key=lambda item: (-item[1], item[0])) if counts else (0, 0)
    if count < 2:
        return Sum(tuple(Product(c, m) for m, c in value.terms))
    having = Polynomial({m: c for m, c in value.terms if index in m})
    others = Polynomial({m: c for m, c in value.terms if index not in m})
    return Sum(plan_of(having).terms + (plan_of(others).terms if others else ()))


def _cost(plan: Sum, prices: Prices) -> float:
    cost = prices.add * (len(plan.terms) - 1)
    for term in plan.terms:
        factors = len(term.factors) + (abs(term.coefficient) != 1)
        cost += prices.mul * max(factors - 1, 0)
        cost += sum(_cost(factor, prices) for factor in term.factors if isinstance(factor, Sum))
    return cost
