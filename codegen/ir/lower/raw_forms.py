"""Vectors turned with the rotation matrices as they are, orthonormal or not: for constraints, never for derivatives."""

from __future__ import annotations

from codegen.ir.lower.alternatives import Alternative, turn_cost
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.polynomial import ONE
from codegen.ir.lower.quantities import Cross, Named, Vector
from codegen.ir.lower.vector_forms import given, read, sums


def alternatives(layout: Layout, kind: str, vector: Vector, frame: str) -> tuple[Alternative, ...]:
    """Lay out the ways to know a vector with raw matrices.

    ``pushed``: products of the given matrices from the inside out. ``pulled``: the transposed matrix of ``frame`` times
    the vector in the frame around it.
    """
    found: list[Alternative] = []
    if kind == "pulled":
        outer = layout.tree.outward(frame)[1]
        found.append(_turned(layout, layout.pushed(vector, outer), outer, frame))
        if vector.single is None:
            found += sums(layout, vector, frame, "pulled")
        return tuple(found)
    if vector.single is None:
        found += sums(layout, vector, frame, "pushed")
    inner = inside(layout, vector, frame)
    description = layout.space.primitives[vector.terms[0][0]]
    if vector.single is not None and not isinstance(description, Cross | Named):
        known = given(layout, description, frame)
        if known is not None and frame in layout.tree.outward(description.frame):
            return (read(layout, known),)
    if inner is not None:
        found.append(_turned(layout, layout.pushed(vector, inner), inner, frame))
    return tuple(found)


def offset_alternatives(layout: Layout, pulled: Vector, frame: str, plain: Vector) -> tuple[Alternative, ...]:
    """Lay out the sum of a pulled vector and of one in the frame itself."""
    _, one = layout.scalar(ONE)
    (pulled_sign, first), (plain_sign, second) = layout.pulled(pulled, frame), layout.pushed(plain, frame)
    cost = layout.prices.add * sum(c > 0 for c in layout.classes(second))
    return (Alternative("sum", (one, first, one, second), cost, ((pulled_sign, 1), (plain_sign, 1))),)


def inside(layout: Layout, vector: Vector, frame: str) -> str | None:
    """The frame next inside ``frame`` that all parts of a vector come through, if there is one."""
    through: set[str] = set()
    for primitive, _ in vector.terms:
        description = layout.space.primitives[primitive]
        if isinstance(description, Cross | Named):
            return None
        chain = layout.tree.outward(description.frame)
        if frame not in chain or chain.index(frame) == 0:
            return None
        through.add(chain[chain.index(frame) - 1])
    return through.pop() if len(through) == 1 else None


def _turned(layout: Layout, inner: tuple[int, int], start: str, end: str) -> Alternative:
    """The given matrix between neighbouring frames times a vector; its columns are given nodes."""
    by = "columns" if layout.tree.outward(start)[1:2] == [end] else "rows"
    axes = layout.axes_between(start, end, by)
    cost = turn_cost(layout.axis_classes(start, end, by), by, layout.classes(inner[1]), layout.prices)
    return Alternative("turned", (inner[1], *axes), cost, (by, inner[0]))
