"""The ways to know a map between two frames: sums of outer products, grouped one way or another, beside the identity.

``a~ b~`` has become ``b a^T - (a . b) I`` by now (`codegen.ir.lower.space`), so a block is a matrix of low rank, a
scalar times the rotation between its two frames, and the skew map of a vector.
"""

from __future__ import annotations

from collections.abc import Iterator

from codegen.ir.lower.alternatives import GENERAL, Alternative, cross_cost
from codegen.ir.lower.collect import common_coefficient
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.polynomial import ONE, Polynomial, total
from codegen.ir.lower.quantities import Axis, Dyadic, Vector, primitive_vector

_KNOWN = 24
"""How many blocks between the same frames are looked through."""

Outers = tuple[tuple[Vector, Vector], ...]
"""A sum of outer products."""


def alternatives(layout: Layout, dyadic: Dyadic, rows: str, columns: str) -> tuple[Alternative, ...]:
    """Lay out the ways to know a block: its pairs, beside the identity and the skew map."""
    found = list(_assembled(layout, dyadic, rows, columns))
    for whole in _identity_spread(layout, dyadic):
        found += _assembled(layout, whole, rows, columns)
    return tuple(dict.fromkeys(found))


def with_known(layout: Layout, kind: str, dyadic: Dyadic, rows: str, columns: str) -> Iterator[Alternative]:
    """Ways that take pairs which something else has asked for between the same frames."""
    for known in layout.blocks.get((rows, columns), ())[:_KNOWN]:
        if kind == "pairs":
            yield from _from_known(layout, dyadic, known, rows, columns)
        elif rows == columns:
            for whole in _skewed(layout, dyadic, known):
                yield from _assembled(layout, whole, rows, columns)


def _skewed(layout: Layout, dyadic: Dyadic, known: Dyadic) -> Iterator[Dyadic]:
    """Write a block with known pairs that differ from its own by a skew map, ``a b^T - b a^T = (b x a)~``."""
    own = Dyadic(dict(dyadic.pairs))
    for base in (known, -known, known.transposed, -known.transposed):
        rest = own - base
        if rest and not (rest + rest.transposed):
            vector = Vector({})
            for (a, b), c in rest.pairs:
                if a < b:
                    left, right = (primitive_vector(p) for p in (b, a))
                    vector += layout.space.cross(left, right).times(c)
            yield base + Dyadic({}, dyadic.identity, dyadic.tilde + vector)


def pair_alternatives(layout: Layout, pairs: Dyadic, rows: str, columns: str) -> tuple[Alternative, ...]:
    """Lay out the ways to know a sum of outer products."""
    return tuple(dict.fromkeys(_outers(layout, outers, rows, columns) for outers in groupings(pairs)))


def groupings(dyadic: Dyadic) -> list[Outers]:
    """Write the pairs of a dyadic as few outer products: collected by left or by right vector."""
    if not dyadic.pairs:
        return [()]
    by_left: dict[int, dict[int, Polynomial]] = {}
    by_right: dict[int, dict[int, Polynomial]] = {}
    for (a, b), c in dyadic.pairs:
        by_left.setdefault(a, {})[b] = c
        by_right.setdefault(b, {})[a] = c
    left = tuple((primitive_vector(a), Vector(terms)) for a, terms in by_left.items())
    right = tuple((Vector(terms), primitive_vector(b)) for b, terms in by_right.items())
    found = [left, right]
    for start, side in ((left, 1), (right, 0)):
        joined = _merged(start, side)
        found += [joined, _merged(joined, 1 - side), _merged(_merged(joined, 1 - side), side)]
    return list(dict.fromkeys(found))


def _merged(outers: Outers, side: int) -> Outers:
    """Join outer products whose vectors on one side differ in a coefficient only."""
    groups: dict[Vector, Vector] = {}
    for pair in outers:
        coefficient, shared = common_coefficient(pair[side])
        groups[shared] = groups.get(shared, Vector({})) + pair[1 - side].times(coefficient)
    return tuple((other, shared) if side else (shared, other) for shared, other in groups.items())


def _identity_spread(layout: Layout, dyadic: Dyadic) -> Iterator[Dyadic]:
    """Write the identity as ``f f^T + g g^T + h h^T`` of a frame whose axes the pairs have already."""
    if not dyadic.identity:
        return
    frames = {
        layout.space.primitives[p].frame  # type: ignore[union-attr]
        for pair, _ in dyadic.pairs
        for p in pair
        if isinstance(layout.space.primitives[p], Axis)
    }
    for frame in sorted(frames):
        axes = [layout.space.primitive(Axis(frame, k)) for k in range(3)]
        spread = Dyadic({(a, a): dyadic.identity for a in axes})
        yield dyadic + spread - Dyadic({}, dyadic.identity)


def _outers(layout: Layout, outers: Outers, rows: str, columns: str) -> Alternative:
    nodes = [layout.outer(left, right, rows, columns) for left, right in outers]
    counts = [0] * 9
    for _, node in nodes:
        counts = [n + (c > 0) for n, c in zip(counts, layout.classes(node), strict=True)]
    cost = layout.prices.add * sum(max(n - 1, 0) for n in counts)
    return Alternative("joined", tuple(node for _, node in nodes), cost, tuple((sign, False) for sign, _ in nodes))


def _assembled(layout: Layout, dyadic: Dyadic, rows: str, columns: str) -> Iterator[Alternative]:
    """Pairs, identity and skew map added up."""
    parts = [layout.pairs(Dyadic(dict(dyadic.pairs)), rows, columns)] if dyadic.pairs else []
    add = layout.prices.add
    if rows == columns:
        skews = [layout.vector(dyadic.tilde, rows)] if dyadic.tilde else []
        skew = 6 * add * bool(skews) * bool(parts)
        tail = tuple(node for _, node in skews)
        tilde_sign = skews[0][0] if skews else 0
        base = tuple((sign, turned) for sign, _, turned in parts)
        nodes = tuple(node for _, node, _ in parts)
        if dyadic.identity and parts and dyadic.identity == -trace(layout, dyadic):
            layout.traces.setdefault(dyadic.identity, []).append((-base[0][0], nodes[0]))
            yield Alternative("deviator", (*nodes, *tail), skew + 3 * add, (base, tilde_sign))
        if dyadic.identity:
            sign, kappa = layout.scalar(dyadic.identity)
            cost = skew + 3 * add * bool(parts)
            yield Alternative("assembled", (*nodes, kappa, *tail), cost, (base, sign, tilde_sign))
        else:
            yield Alternative("assembled", (*nodes, *tail), skew, (base, 0, tilde_sign))
        return
    if dyadic.identity:
        parts.append((*layout.rotation(dyadic.identity, rows, columns), False))
    if dyadic.tilde:
        parts.append((*layout.tilde(dyadic.tilde, rows, columns), False))
    cost = 9 * add * (len(parts) - 1)
    signs = tuple((sign, turned) for sign, _, turned in parts)
    yield Alternative("joined", tuple(node for _, node, _ in parts), cost, signs)


def trace(layout: Layout, dyadic: Dyadic) -> Polynomial:
    """The trace of the pairs of a dyadic."""
    one = [(layout.space.primitives[a], layout.space.primitives[b], c) for (a, b), c in dyadic.pairs]
    return total(layout.space.dot(layout.space.vector(a), layout.space.vector(b)) * c for a, b, c in one)


def _from_known(layout: Layout, pairs: Dyadic, known: Dyadic, rows: str, columns: str) -> Iterator[Alternative]:
    """Another sum of outer products between the same frames plus one; negated, and transposed where frames agree."""
    if known == pairs:
        return
    for turned in (False, True) if rows == columns else (False,):
        base = known.transposed if turned else known
        for sign, rest in ((1, pairs - base), (-1, pairs + base)):
            for outers in groupings(rest) if _may_be_one(rest) else ():
                if len(outers) == 1:
                    own_sign, node, own_turned = layout.pairs(known, rows, columns)
                    extra_sign, extra = layout.outer(*outers[0], rows, columns)
                    cost = layout.prices.add * sum(c > 0 for c in layout.classes(extra))
                    signs = ((sign * own_sign, turned != own_turned), (extra_sign, False))
                    yield Alternative("joined", (node, extra), cost, signs)


def _may_be_one(dyadic: Dyadic) -> bool:
    """Whether pairs may be those of a single outer product: every left with every right."""
    lefts, rights = ({pair[side] for pair, _ in dyadic.pairs} for side in (0, 1))
    return len(dyadic.pairs) == len(lefts) * len(rights)


def outer_alternatives(layout: Layout, left: Vector, right: Vector, rows: str, columns: str) -> tuple[Alternative, ...]:
    """An outer product, entry by entry; a common coefficient of one side may go to the other."""
    found = []
    for u, v in dict.fromkeys(((left, right), *_scalings(left, right))):
        (u_sign, u_node), (v_sign, v_node) = layout.vector(u, rows), layout.vector(v, columns)
        products = [(a, b) for a in layout.classes(u_node) for b in layout.classes(v_node)]
        cost = layout.prices.mul * sum(a == b == GENERAL for a, b in products)
        found.append(Alternative("outer", (u_node, v_node), cost, u_sign * v_sign))
    return tuple(found)


def _scalings(left: Vector, right: Vector) -> Iterator[tuple[Vector, Vector]]:
    for one, other, swapped in ((left, right, False), (right, left, True)):
        if len(one.terms) == 1 and one.terms[0][1].constant is None:
            plain = Vector({one.terms[0][0]: ONE})
            scaled = other.times(one.terms[0][1])
            yield (scaled, plain) if swapped else (plain, scaled)


def rotation_alternatives(layout: Layout, factor: Polynomial, rows: str, columns: str) -> tuple[Alternative, ...]:
    """A scalar times the rotation between two frames, from its columns or from its rows."""
    sign, scalar = layout.scalar(factor)
    found = []
    for by in ("columns", "rows"):
        axes = layout.axes_between(columns, rows, by)
        entries = [c for node in axes for c in layout.classes(node)]
        cost = layout.prices.mul * sum(c == layout.classes(scalar)[0] == GENERAL for c in entries)
        found.append(Alternative("rotation", (scalar, *axes), cost, (by, sign)))
    return tuple(found)


def tilde_alternatives(layout: Layout, vector: Vector, rows: str, columns: str) -> tuple[Alternative, ...]:
    """``w~ R`` by columns, ``R w~`` by rows: cross products of the vector with axes of one frame seen in the other."""
    found = []
    for by in ("columns", "rows"):
        axes = layout.axes_between(columns, rows, by)
        sign, node = layout.vector(vector, rows if by == "columns" else columns)
        cost = sum(cross_cost(layout.classes(node), layout.classes(axis), layout.prices) for axis in axes)
        found.append(Alternative("skewed", (node, *axes), cost, (by, sign)))
    return tuple(found)
