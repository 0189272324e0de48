"""The ways to know a block from finished ones: turned from other frames, or with one more outer product.

They are laid out last, over the blocks that something has asked for.
"""

from __future__ import annotations

from collections.abc import Iterator

from codegen.ir.lower.alternatives import GENERAL, Alternative, Classes, Key, inner_cost
from codegen.ir.lower.block_forms import groupings, trace
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.polynomial import ZERO
from codegen.ir.lower.quantities import Dyadic


def in_parts(layout: Layout, key: Key) -> Iterator[Alternative]:
    """A block with a skew map beside identity and pairs: without the identity first, or without the skew map."""
    if key[0] != "block" or key[2] != key[3]:
        return
    _, dyadic, rows, columns = key
    if not (dyadic.pairs and dyadic.tilde and dyadic.identity):
        return
    sign, core, turned = layout.block(_core(dyadic), rows, columns)
    base, cost = ((sign, turned),), 3 * layout.prices.add
    if dyadic.identity == -trace(layout, dyadic):
        yield Alternative("deviator", (core,), cost, (base, 0))
    else:
        identity_sign, identity = layout.scalar(dyadic.identity)
        yield Alternative("assembled", (core, identity), cost, (base, identity_sign, 0))
    sign, plain, turned = layout.block(_plain(dyadic), rows, columns)
    skew_sign, skew = layout.vector(dyadic.tilde, rows)
    yield Alternative("assembled", (plain, skew), 6 * layout.prices.add, (((sign, turned),), 0, skew_sign))


def with_finished(layout: Layout, key: Key) -> Iterator[Alternative]:
    """Ways that take a finished block."""
    if key[0] in ("block", "pairs"):
        kind, dyadic, rows, columns = key
        if rows != columns:
            yield from _beside_skew(layout, dyadic, rows, columns)
            yield from _turned(layout, kind, dyadic, rows, columns)
        elif kind == "block" and dyadic == _core(dyadic):
            yield from _from_cores(layout, dyadic, rows)


def _core(dyadic: Dyadic) -> Dyadic:
    return Dyadic(dict(dyadic.pairs), ZERO, dyadic.tilde)


def _plain(dyadic: Dyadic) -> Dyadic:
    return Dyadic(dict(dyadic.pairs), dyadic.identity)


def _turned(layout: Layout, kind: str, dyadic: Dyadic, rows: str, columns: str) -> Iterator[Alternative]:
    """``R M`` and ``M R`` of the same map between other frames."""
    for side, frame, start, end in (("left", columns, columns, rows), ("right", rows, columns, rows)):
        known = layout.known_map(kind, dyadic, frame, frame)
        if known is None:
            continue
        sign, node, turned = known
        for by in ("columns", "rows"):
            axes = layout.axes_between(start, end, by)
            classes = layout.axis_classes(start, end, by)
            cost = _product_cost(layout, classes, by, side)
            yield Alternative("turned block", (node, *axes), cost, ((sign, turned), by, side), f"blocks {start} {end}")


def _product_cost(layout: Layout, axes: tuple[Classes, ...], by: str, side: str) -> float:
    """Price of a rotation times a general matrix, or of the matrix times the rotation."""
    rows = axes if by == "rows" else tuple(zip(*axes, strict=True))
    lines = rows if side == "left" else tuple(zip(*rows, strict=True))
    return 3 * sum(inner_cost([(c, GENERAL) for c in line], layout.prices) for line in lines)


def _beside_skew(layout: Layout, dyadic: Dyadic, rows: str, columns: str) -> Iterator[Alternative]:
    """The same block without its skew map, and that."""
    known = layout.known_map("block", _plain(dyadic), rows, columns) if dyadic.tilde else None
    if known is not None:
        sign, node, turned = known
        skew_sign, skew = layout.tilde(dyadic.tilde, rows, columns)
        yield Alternative("joined", (node, skew), 9 * layout.prices.add, ((sign, turned), (skew_sign, False)))


def _from_cores(layout: Layout, core: Dyadic, frame: str) -> Iterator[Alternative]:
    """Another core plus one outer product; negated or transposed."""
    for node in list(layout.nodes):
        kind, other, *frames = node.key
        if kind != "block" or frames != [frame, frame] or other == core or other != _core(other):
            continue
        for turned, base in ((False, other), (True, other.transposed)):
            for sign, rest in ((1, core - base), (-1, core + base)):
                outers = groupings(rest) if rest.pairs and not rest.tilde else []
                for outer in (found[0] for found in outers if len(found) == 1):
                    own_sign, own, own_turned = layout.block(other, frame, frame)
                    extra_sign, extra = layout.outer(*outer, frame, frame)
                    cost = layout.prices.add * sum(c > 0 for c in layout.classes(extra))
                    signs = ((sign * own_sign, turned != own_turned), (extra_sign, False))
                    yield Alternative("joined", (own, extra), cost, signs)
