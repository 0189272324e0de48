"""The graph that a search chooses in: nodes with their alternatives, and what every search looks up."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable, Sequence
from operator import itemgetter

from codegen.ir.lower.alternatives import Alternative

Choice = dict[int, int]
"""Node -> position of its alternative."""

Graph = Sequence[tuple[Alternative, ...]]
"""Alternatives of each node, by its number."""


def price(graph: Graph, choice: Choice) -> float:
    """What a choice costs."""
    return sum(graph[node][k].cost for node, k in choice.items())


def weighted(graph: Graph, seed: int) -> list[list[float]]:
    """Prices for a start: alternatives of one family are cheap or dear together."""
    noise = random.Random(seed)
    families: dict[str, float] = {}
    weighted: list[list[float]] = []
    for alternatives in graph:
        weighted.append([])
        for alternative in alternatives:
            family = alternative.family or alternative.kind
            if family not in families:
                families[family] = math.exp(noise.uniform(-1.2, 1.2)) if seed else 1.0
            weighted[-1].append(alternative.cost * families[family] * (1.0 + 0.3 * noise.random() * (seed > 0)))
    return weighted


class Index:
    """A graph with what every search in it looks up; alternatives are numbered through, node after node.

    Attributes:
        graph: alternatives of each node.
        first: number of the first alternative of each node.
        owner: of each alternative, its node.
        sizes: of each alternative, how many nodes it takes.
        leaves: alternatives that take none.
        users: of each node, the alternatives that take it.
        users_of: the same by the node they belong to, nodes in ascending order.
        children: of each alternative, the nodes it takes.
        costs: of each alternative.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.first: list[int] = []
        self.owner: list[int] = []
        self.sizes: list[int] = []
        self.users: list[list[int]] = [[] for _ in graph]
        self.users_of: list[dict[int, list[int]]] = [{} for _ in graph]
        self.children = [alternative.children for alternatives in graph for alternative in alternatives]
        self.costs = [alternative.cost for alternatives in graph for alternative in alternatives]
        for node, alternatives in enumerate(graph):
            self.first.append(len(self.owner))
            for alternative in alternatives:
                children = set(alternative.children)
                for child in children:
                    self.users[child].append(len(self.owner))
                    self.users_of[child].setdefault(node, []).append(len(self.owner))
                self.owner.append(node)
                self.sizes.append(len(children))
        self._getters: dict[int, Callable[[Sequence[int]], Sequence[int]]] = {}
        self.leaves = [number for number, size in enumerate(self.sizes) if not size]

    def used_by(self, node: int, uses: Sequence[int]) -> tuple[Iterable[tuple[int, list[int]]], Sequence[int]]:
        """Give `users_of` of a node, node by node, and how often each of these is used."""
        users = self.users_of[node]
        if not users:
            return (), ()
        if node not in self._getters:
            self._getters[node] = itemgetter(*users, node)  # one more, since a getter of one gives no tuple
        return users.items(), self._getters[node](uses)

    def numbers(self, node: int) -> range:
        """Numbers of the alternatives of a node."""
        return range(self.first[node], self.first[node] + len(self.graph[node]))
