"""Nodes and alternatives: what has to be known, and the ways to know it.

A node is a quantity at a place: a vector in a frame, a scalar, a block between two frames. An alternative computes it
from other nodes. `codegen.ir.lower.layout` lays out the graph of both.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from typing import Any, NamedTuple

Key = tuple[Any, ...]

Classes = tuple[int, ...]
"""Class of each entry."""

ZERO, UNIT, GENERAL = 0, 1, 2
"""What is known of an entry: it is zero, plus or minus one, or anything."""


class Alternative(NamedTuple):
    """One way to compute a node; a tuple, since there are hundreds of thousands.

    Attributes:
        kind: names the formula, see `codegen.ir.lower.scalarise`.
        children: numbers of the nodes it takes.
        cost: price of its own operations.
        data: what the formula needs besides, such as signs.
        family: alternatives that are alike, such as all that turn vectors from one frame to another.
    """

    kind: str
    children: tuple[int, ...]
    cost: float
    data: Any = None
    family: str = ""


@dataclass(slots=True)
class Node:
    """A quantity at a place.

    Attributes:
        key: kind, quantity and place.
        classes: `ZERO`, `UNIT` or `GENERAL` for each entry.
        alternatives: laid out when first asked for.
    """

    key: Key
    classes: tuple[int, ...]
    alternatives: tuple[Alternative, ...] | None = field(default=None)


class Prices(NamedTuple):
    """Price of an addition, a multiplication and a division."""

    add: float = 1.0
    mul: float = 1.0
    div: float = 1.0


def product_class(a: int, b: int) -> int:
    """Class of a product of two entries."""
    return 0 if not (a and b) else UNIT if a == b == UNIT else GENERAL


def inner_cost(pairs: list[tuple[int, int]], prices: Prices) -> float:
    """Price of a sum of products of entries, from their classes."""
    products = [product for product in pairs if product[0] and product[1]]
    multiplied = sum(1 for a, b in products if a == b == GENERAL)
    return prices.mul * multiplied + prices.add * max(len(products) - 1, 0)


@cache
def dot_cost(a: Classes, b: Classes, prices: Prices) -> float:
    """Price of a scalar product, from the classes of the two vectors."""
    return inner_cost(list(zip(a, b, strict=True)), prices)


@cache
def cross_cost(a: Classes, b: Classes, prices: Prices) -> float:
    """Price of a cross product, from the classes of the two vectors."""
    places = [((k + 1) % 3, (k + 2) % 3) for k in range(3)]
    return sum(inner_cost([(a[p], b[q]), (a[q], b[p])], prices) for p, q in places)


@cache
def turn_cost(axes: tuple[Classes, ...], by: str, components: Classes, prices: Prices) -> float:
    """Price of a rotation, given by its columns or its rows, times a vector, from their classes."""
    rows = zip(*axes, strict=True) if by == "columns" else axes
    return sum(dot_cost(tuple(row), components, prices) for row in rows)


def inner_class(pairs: list[tuple[int, int]]) -> int:
    """Class of a sum of products of entries."""
    classes = [product_class(a, b) for a, b in pairs if a and b]
    return ZERO if not classes else classes[0] if len(classes) == 1 else GENERAL
