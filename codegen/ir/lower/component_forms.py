"""The components of a vector along the axes of a frame as scalar products: a way to know it where they serve twice."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.ir.lower.alternatives import Alternative
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.quantities import Axis, Cross, Given, Primitive, Vector
from codegen.ir.lower.vector_forms import given


def components(layout: Layout, vector: Vector, frame: str) -> Iterator[Alternative]:
    """Scalar products with the axes of the frame, where others need them too.

    Those of an axis serve its own frame as well, and those of cross products with axes of the frame several such.
    """
    if frame not in layout.axes or _is_given(layout, vector, frame):
        return
    products = [layout.space.dot(layout.space.vector(Axis(frame, k)), vector) for k in range(3)]
    needed = any(product.constant is None and layout.has_scalar(product) for product in products)
    if needed or _is_of_axes(layout, vector, frame):
        signs, nodes = zip(*(layout.scalar(product) for product in products), strict=True)
        yield Alternative("components", nodes, 0.0, signs, f"components {frame}")


def _is_of_axes(layout: Layout, vector: Vector, frame: str) -> bool:
    """Whether a vector is an axis, or made of cross products with axes of the frame."""
    parts = [layout.space.primitives[primitive] for primitive, _ in vector.terms]
    is_axis = vector.single is not None and isinstance(parts[0], Axis)
    return is_axis or (bool(parts) and all(_has_axis(layout, part, frame) for part in parts))


def _has_axis(layout: Layout, description: Primitive, frame: str) -> bool:
    """Whether a primitive is a cross product with an axis of the frame."""
    if not isinstance(description, Cross):
        return False
    sides = (layout.space.primitives[p] for p in (description.left, description.right))
    return any(isinstance(side, Axis) and side.frame == frame for side in sides)


def _is_given(layout: Layout, vector: Vector, frame: str) -> bool:
    description = layout.space.primitives[vector.single] if vector.single is not None else None
    return isinstance(description, Axis | Given) and given(layout, description, frame) is not None
