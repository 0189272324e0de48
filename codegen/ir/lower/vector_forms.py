"""The ways to know a vector in a frame: given, turned from another frame, a sum, a cross product."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from functools import reduce

from codegen.ir.lower.alternatives import GENERAL, UNIT, Alternative, cross_cost, turn_cost
from codegen.ir.lower.collect import cross_products
from codegen.ir.lower.frames import Components
from codegen.ir.lower.layout import Layout, Signed
from codegen.ir.lower.polynomial import ONE, Polynomial
from codegen.ir.lower.quantities import Axis, Cross, Given, Named, Vector, primitive_vector

_KNOWN = 60
"""How many sums are looked through for one that is part of another."""

Parts = list[tuple[Polynomial, Vector]]
"""Coefficient and vector of each part of a sum."""


def alternatives(layout: Layout, vector: Vector, frame: str) -> tuple[Alternative, ...]:
    """Lay out the ways to know a vector in a frame."""
    primitive = vector.single
    description = layout.space.primitives[primitive] if primitive is not None else None
    if isinstance(description, Axis | Given):
        known = given(layout, description, frame)
        if known is not None:
            return (read(layout, known),)
    found: list[Alternative] = []
    if isinstance(description, Axis):
        found += _by_other_axes(layout, description, frame)
    found += _raw(layout, vector, frame)
    if description is None:
        found += sums(layout, vector, frame, "vector")
    if isinstance(description, Named):
        found += sums(layout, layout.space.named[description.name], frame, "vector")
    found += crosses(layout, vector, frame)
    for other in layout.tree.connected(frame):
        if other != frame:
            found += turned(layout, vector, other, frame, description)
    return tuple(dict.fromkeys(found))


def read(layout: Layout, components: Components) -> Alternative:
    """Components that are given; a scalar among them is a node of its own."""
    children: list[int] = []
    data: list[tuple[str, int] | int] = []
    for component in components:
        if isinstance(component, Polynomial):
            sign, node = layout.scalar(component)
            children.append(node)
            data.append(sign)
        else:
            data.append(component)
    return Alternative("given", tuple(children), 0.0, tuple(data))


def given(layout: Layout, description: Axis | Given, frame: str) -> Components | None:
    """Components of a primitive where they are given."""
    if isinstance(description, Given):
        return layout.tree.given[description.frame, description.name] if frame == description.frame else None
    if frame == description.frame:
        return tuple(ONE if k == description.k else Polynomial({}) for k in range(3))
    matrix = layout.tree.matrix(frame, description.frame)
    return None if matrix is None else matrix[description.k]


def _by_other_axes(layout: Layout, axis: Axis, frame: str) -> Iterator[Alternative]:
    """``h = f x g``."""
    first, second = (layout.space.vector(Axis(axis.frame, (axis.k + n) % 3)) for n in (1, 2))
    yield cross(layout, layout.vector(first, frame), layout.vector(second, frame))


def _raw(layout: Layout, vector: Vector, frame: str) -> Iterator[Alternative]:
    """The same vector as a constraint needs it, with the matrices as they are."""
    for kind in ("pushed", "pulled"):
        known = layout.known((kind, vector, frame))
        if known is not None:
            yield Alternative("same", (known,), 0.0, 1)


def crosses(layout: Layout, vector: Vector, frame: str) -> Iterator[Alternative]:
    """Cross products that are known to give the vector, or its negative."""
    primitive = vector.single
    if primitive is not None:
        description = layout.space.primitives[primitive]
        if isinstance(description, Cross):
            left, right = primitive_vector(description.left), primitive_vector(description.right)
            yield cross(layout, layout.vector(left, frame), layout.vector(right, frame))
    else:
        products = cross_products(layout.space, vector)
        if len(products) == 1:
            first, second = products[0]
            yield cross(layout, layout.vector(first, frame), layout.vector(second, frame))
    for key, sign in ((vector, 1), (-vector, -1)):
        for left, right in layout.space.cross_hints.get(key, ()):
            yield cross(layout, layout.vector(left, frame), layout.vector(right, frame), sign)


def cross(layout: Layout, left: Signed, right: Signed, sign: int = 1) -> Alternative:
    """The cross product of two nodes."""
    cost = cross_cost(layout.classes(left[1]), layout.classes(right[1]), layout.prices)
    return Alternative(
        "cross", (left[1], right[1]), cost, sign * left[0] * right[0], f"cross {layout.nodes[left[1]].key[2]}"
    )


def turned(layout: Layout, vector: Vector, start: str, end: str, description: object) -> Iterator[Alternative]:
    """``R v`` with R by its columns (axes of ``start`` seen in ``end``) or by its rows."""
    is_axis_of_start = isinstance(description, Axis) and description.frame == start
    sign, inner = layout.vector(vector, start)
    classes = layout.classes(inner)
    for by in ("rows",) if is_axis_of_start else ("columns", "rows"):
        turn = layout.turn(start, end, by)
        if inner not in turn.axes:
            cost = turn_cost(turn.classes, by, classes, layout.prices)
            yield Alternative("turned", (inner, *turn.axes), cost, (by, sign), turn.family)


def sums(layout: Layout, vector: Vector, frame: str, kind: str) -> Iterator[Alternative]:
    """Sums of parts: one by one, by body, by common coefficient, by product."""
    if vector not in layout.parts:
        layout.parts[vector] = _parts(layout, vector)
    for parts in layout.parts[vector]:
        yield summed(layout, parts, frame, kind)


def _parts(layout: Layout, vector: Vector) -> list[Parts]:
    """The sums of parts, whatever the frame."""
    single: Parts = [(coefficient, primitive_vector(p)) for p, coefficient in vector.terms]
    found = [
        single,
        _by_body(layout, vector),
        _by_coefficient(vector),
        _by_content(vector),
        _by_product(layout, vector),
        *_beside_body(layout, vector),
    ]
    return [
        parts
        for k, parts in enumerate(found)
        if parts and parts not in found[:k] and parts[0][1] not in (vector, -vector)
    ]


def with_known(layout: Layout, kind: str, vector: Vector, frame: str) -> Iterator[Alternative]:
    """Sums with another sum that something has asked for."""
    for known in list(layout.sums)[:_KNOWN]:
        parts = _with_known(layout, vector, known)
        if parts:
            yield summed(layout, parts, frame, kind)


def summed(layout: Layout, parts: Parts, frame: str, kind: str) -> Alternative:
    """Alternative that adds up parts, each times its coefficient."""
    place = {"vector": layout.vector, "pushed": layout.pushed, "pulled": layout.pulled}[kind]
    children: list[int] = []
    signs: list[tuple[int, int]] = []
    cost = 0.0
    counts = [0, 0, 0]
    for coefficient, part in parts:
        sign, node = place(part, frame)
        factor_sign, factor = layout.scalar(coefficient)
        children += [factor, node]
        signs.append((sign * factor_sign, int(coefficient.constant in (1, -1))))
        for k, c in enumerate(layout.classes(node)):
            counts[k] += int(c > 0)
            cost += layout.prices.mul * (c == GENERAL and layout.classes(factor)[0] != UNIT)
    cost += layout.prices.add * sum(max(n - 1, 0) for n in counts)
    return Alternative("sum", tuple(children), cost, tuple(signs), f"sum {frame}")


def _by_body(layout: Layout, vector: Vector) -> Parts:
    return [(ONE, part) for part in _bodies(layout, vector)]


def _beside_body(layout: Layout, vector: Vector) -> list[Parts]:
    """What is fixed in one body, and the rest, which may be added up elsewhere."""
    bodies = _bodies(layout, vector)
    return [[(ONE, vector - part), (ONE, part)] for part in bodies] if len(bodies) > 2 else []


def _bodies(layout: Layout, vector: Vector) -> list[Vector]:
    groups: dict[str, dict[int, Polynomial]] = {}
    for p, coefficient in vector.terms:
        groups.setdefault(_body(layout, p), {})[p] = coefficient
    return [Vector(terms) for terms in groups.values()]


def _body(layout: Layout, primitive: int) -> str:
    """The outermost frame but one that a primitive is fixed in."""
    description = layout.space.primitives[primitive]
    if isinstance(description, Named):
        return description.name
    if isinstance(description, Cross):
        return "+".join(sorted({_body(layout, description.left), _body(layout, description.right)}))
    chain = layout.tree.outward(description.frame)
    return chain[-2] if len(chain) > 1 else chain[-1]


def _by_coefficient(vector: Vector) -> Parts:
    groups: dict[Polynomial, dict[int, Polynomial]] = {}
    for p, coefficient in vector.terms:
        key, sign = (coefficient, ONE) if coefficient.sign > 0 else (-coefficient, -ONE)
        groups.setdefault(key, {})[p] = sign
    return [(key, Vector(terms)) for key, terms in groups.items()]


def _by_content(vector: Vector) -> Parts:
    """Take out what all coefficients have as a factor."""
    common = reduce(lambda a, b: a & b, (Counter(c.content) for _, c in vector.terms))
    content = tuple(sorted(common.elements()))
    if not content:
        return []
    factor = Polynomial({content: 1})
    return [(factor, Vector({p: c.without(content) for p, c in vector.terms}))]


def _by_product(layout: Layout, vector: Vector) -> Parts:
    """Collect the cross products of primitives to as few as possible, beside what is no cross product."""
    is_cross = {p: isinstance(layout.space.primitives[p], Cross) for p, _ in vector.terms}
    plain = Vector({p: c for p, c in vector.terms if not is_cross[p]})
    products = cross_products(layout.space, Vector({p: c for p, c in vector.terms if is_cross[p]}))
    parts = [(ONE, layout.space.cross(left, right)) for left, right in products]
    return [*parts, (ONE, plain)] if plain else parts


def _with_known(layout: Layout, vector: Vector, known: Vector) -> Parts:
    """Write a vector with a known sum inside it, up to sign."""
    inside = dict(known.terms)
    terms = dict(vector.terms)
    if len(inside) >= len(terms) or not inside.keys() <= terms.keys():
        return []
    for part, sign in ((known, ONE), (-known, -ONE)):
        if all(terms[p] == coefficient for p, coefficient in part.terms):
            rest = Vector({p: c for p, c in terms.items() if p not in inside})
            if len(rest.terms) == 1 or rest in layout.sums or -rest in layout.sums:
                return [(sign, known), (ONE, rest)]
    return []
