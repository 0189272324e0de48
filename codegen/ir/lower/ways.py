"""Every way to compute every node of a graph."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial

from codegen.errors import InternalError
from codegen.ir.lower import (
    block_forms,
    component_forms,
    finished_blocks,
    raw_forms,
    scalar_forms,
    scaled_vectors,
    vector_forms,
)
from codegen.ir.lower.alternatives import Alternative, Key
from codegen.ir.lower.layout import Layout

Ways = Callable[[Layout, Key], Iterable[Alternative]]
"""Some of the alternatives of a node."""


def lay_out(layout: Layout) -> list[tuple[Alternative, ...]]:
    """Give the alternatives of every node that the demands may need.

    Vectors with raw matrices are laid out first, so that others find them. What takes known scalars, sums, products
    or blocks is added when all of these are known, and what turns or adds to finished blocks at the very end.
    """
    _extend(layout, partial(_is_raw, layout))
    _extend(layout, lambda key: True)
    _add(layout, _alternatives, _components)
    _add(layout, _alternatives, _with_known)
    _add(layout, _early, finished_blocks.in_parts)
    _add(layout, _early, finished_blocks.with_finished)
    _add(layout, _early, scaled_vectors.by_factors)
    _add(layout, _early, scaled_vectors.with_scaled)
    return [node.alternatives or () for node in layout.nodes]


def _extend(layout: Layout, includes: Callable[[Key], bool]) -> None:
    position = 0
    while position < len(layout.nodes):
        node = layout.nodes[position]
        if node.alternatives is None and includes(node.key):
            node.alternatives = _alternatives(layout, node.key)
        position += 1


def _add(layout: Layout, first: Ways, further: Ways) -> None:
    """Add further alternatives to those of every node; ``first`` gives those of nodes that are asked for meanwhile."""
    position = 0
    while position < len(layout.nodes):
        node = layout.nodes[position]
        base = node.alternatives or tuple(first(layout, node.key))
        added = tuple(further(layout, node.key))
        node.alternatives = tuple(dict.fromkeys((*base, *added))) if added else base
        position += 1


def _early(layout: Layout, key: Key) -> Iterable[Alternative]:
    yield from _alternatives(layout, key)
    yield from _components(layout, key)
    yield from _with_known(layout, key)


def _components(layout: Layout, key: Key) -> Iterable[Alternative]:
    return component_forms.components(layout, key[1], key[2]) if key[0] == "vector" else ()


def _with_known(layout: Layout, key: Key) -> Iterable[Alternative]:
    match key[0]:
        case "vector" | "pushed" | "pulled" if len(key[1].terms) > 1:
            return vector_forms.with_known(layout, *key)
        case "scalar":
            return scalar_forms.with_known(layout, key[1])
        case "pairs" | "block":
            return block_forms.with_known(layout, *key)
    return ()


def _is_raw(layout: Layout, key: Key) -> bool:
    """Whether a node leads to vectors turned with raw matrices."""
    if key[0] != "scalar":
        return key[0] in ("pushed", "pulled", "offset")
    return any(layout.space.atoms[a].kind in ("raw", "stage") for monomial, _ in key[1].terms for a in monomial)


def _alternatives(layout: Layout, key: Key) -> tuple[Alternative, ...]:
    match key[0]:
        case "vector":
            return vector_forms.alternatives(layout, key[1], key[2])
        case "pushed" | "pulled":
            return raw_forms.alternatives(layout, *key)
        case "offset":
            return raw_forms.offset_alternatives(layout, *key[1:])
        case "scalar":
            return scalar_forms.alternatives(layout, key[1])
        case "outer":
            return block_forms.outer_alternatives(layout, *key[1:])
        case "rotation":
            return block_forms.rotation_alternatives(layout, *key[1:])
        case "tilde":
            return block_forms.tilde_alternatives(layout, *key[1:])
        case "pairs":
            return block_forms.pair_alternatives(layout, *key[1:])
        case "block":
            return block_forms.alternatives(layout, *key[1:])
    raise InternalError(f"no alternatives for {key[0]}")
