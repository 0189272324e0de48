"""Choices on record: what a long search found is kept, so that generating is quick and does not depend on luck.

A record belongs to one graph, told by its fingerprint; where the graph has changed the record is not found and the
search runs anew. It lists the alternatives in the order in which a walk from the outputs meets their nodes.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence

from codegen.errors import InternalError
from codegen.ir.lower.graph import Choice, Graph

Records = Mapping[str, str]
"""Fingerprint of a graph and its outputs -> alternatives, one character each (two for the rare high number)."""

_DIGITS = "0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


def fingerprint(graph: Graph, outputs: Sequence[int]) -> str:
    """Tell a graph and its outputs from others."""
    digest = hashlib.sha256(repr(list(outputs)).encode())
    for alternatives in graph:
        digest.update(repr([alternative[:3] for alternative in alternatives]).encode())  # kind, children, cost
    return digest.hexdigest()[:20]


def recorded(graph: Graph, outputs: Sequence[int], choice: Choice) -> str:
    """Write a choice as a record."""
    words = []
    for node in _walk(graph, outputs, lambda node: choice[node]):
        high, low = divmod(choice[node], len(_DIGITS))
        words.append(("!" + _DIGITS[high] if high else "") + _DIGITS[low])
    return "".join(words)


def replayed(graph: Graph, outputs: Sequence[int], record: str) -> Choice:
    """Read a choice from its record.

    Raises:
        InternalError: the record does not belong to the graph.
    """
    characters = iter(record)
    choice: Choice = {}

    def following(node: int) -> int:
        character = next(characters, "")
        number = 0
        if character == "!":
            number, character = _DIGITS.index(next(characters)) * len(_DIGITS), next(characters)
        choice[node] = number + _DIGITS.index(character or "?")
        return choice[node]

    try:
        for _ in _walk(graph, outputs, following):
            pass
    except (IndexError, StopIteration, ValueError) as error:
        raise InternalError("a record of the search does not fit its graph") from error
    return choice


def _walk(graph: Graph, outputs: Sequence[int], chosen: Callable[[int], int]) -> list[int]:
    """Nodes that the outputs need, each where it is first met."""
    order: list[int] = []
    seen: set[int] = set()
    waiting = list(reversed(outputs))
    while waiting:
        node = waiting.pop()
        if node not in seen:
            seen.add(node)
            order.append(node)
            waiting += reversed(graph[node][chosen(node)].children)
    return order
