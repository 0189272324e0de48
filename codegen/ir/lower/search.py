"""The cheapest way to compute the outputs: choose one alternative for every node that is needed.

A node that several others use is paid once, so the choice is made over the whole graph. It starts from the cheapest
tree of each output and is improved by moves that are kept when the total falls: another alternative for a node, with
everything that profits from what it brings switched to it; a node closed, with everything that used it switched away.
A seed changes where the search starts; from the same seed it always ends the same.
"""

from __future__ import annotations

import heapq
import math
import random
from collections.abc import Callable, Iterable, Sequence

from codegen.errors import InternalError
from codegen.ir.lower.alternatives import Alternative

Choice = dict[int, int]
"""Node -> position of its alternative."""

Graph = Sequence[tuple[Alternative, ...]]
"""Alternatives of each node, by its number."""

_State = tuple[Choice, dict[int, int], float]
"""Choice, number of uses of each node, total."""

_LEAST_GAIN = 1e-9

_PATIENCE = 2
"""Sweeps without a gain after which the search ends."""

_REACH = 10.0
"""How much dearer an alternative may look, before what it frees, to be tried beside others."""


def cheapest(
    graph: Graph, outputs: Sequence[int], seed: int = 0, sweeps: int = 12, switches: float = math.inf
) -> Choice:
    """Search the cheapest acyclic choice for the outputs.

    Args:
        graph: alternatives of every node.
        outputs: nodes that must be computed.
        seed: changes where the search starts; 0 starts from the prices as they are.
        sweeps: how often all moves are tried at most.
        switches: of a node to another alternative, tried or kept, after which no further move is made.

    Returns:
        The choice of every node that the outputs need.
    """
    return _searched(_Index(graph), outputs, seed, sweeps, switches)


def _searched(index: _Index, outputs: Sequence[int], seed: int, sweeps: int = 12, switches: float = math.inf) -> Choice:
    search = _Search(index, outputs, seed, switches)
    idle = 0
    for _ in range(sweeps):
        before = search.total
        search.sweep()
        idle = idle + 1 if search.total > before - _LEAST_GAIN else 0
        if idle == _PATIENCE:
            break
    return dict(sorted(search.choice.items()))


def searched(graph: Graph, outputs: Sequence[int], seeds: Iterable[int], best: int = 2) -> list[Choice]:
    """Search from several starts.

    Args:
        graph: alternatives of every node.
        outputs: nodes that must be computed.
        seeds: of the starts.
        best: how many of the choices are given at most.

    Returns:
        The cheapest of the choices found, each once, the cheapest first.
    """
    ends: dict[tuple[tuple[int, int], ...], Choice] = {}
    index = _Index(graph)
    for seed in seeds:
        choice = _searched(index, outputs, seed)
        ends.setdefault(tuple(choice.items()), choice)
    return sorted(ends.values(), key=lambda choice: price(graph, choice))[:best]


def price(graph: Graph, choice: Choice) -> float:
    """What a choice costs."""
    return sum(graph[node][k].cost for node, k in choice.items())


def _weighted(graph: Graph, seed: int) -> list[list[float]]:
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


class _Index:
    """A graph with what every search in it looks up; alternatives are numbered through, node after node.

    Attributes:
        graph: alternatives of each node.
        first: number of the first alternative of each node.
        owner: of each alternative, its node.
        sizes: of each alternative, how many nodes it takes.
        leaves: alternatives that take none.
        users: of each node, the alternatives that take it.
        users_of: the same by node, as positions among its alternatives.
    """

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.first: list[int] = []
        self.owner: list[int] = []
        self.sizes: list[int] = []
        self.users: list[list[int]] = [[] for _ in graph]
        self.users_of: list[dict[int, list[int]]] = [{} for _ in graph]
        for node, alternatives in enumerate(graph):
            self.first.append(len(self.owner))
            for k, alternative in enumerate(alternatives):
                children = set(alternative.children)
                for child in children:
                    self.users[child].append(len(self.owner))
                    self.users_of[child].setdefault(node, []).append(k)
                self.owner.append(node)
                self.sizes.append(len(children))
        self.leaves = [number for number, size in enumerate(self.sizes) if not size]


class _Search:
    """A choice under improvement, with counts of how often each node is used."""

    def __init__(self, index: _Index, outputs: Sequence[int], seed: int, switches: float) -> None:
        graph = index.graph
        self._weighted = [cost for costs in _weighted(graph, seed) for cost in costs]
        self.choice: Choice = {}
        self.total = 0.0
        self._graph = graph
        self._switches = switches
        self._outputs = list(outputs)
        self._sideways: set[tuple[int, int]] = set()
        self._uses: dict[int, int] = {}
        self._index, self._users_of = index, index.users_of
        for position, output in enumerate(self._outputs):
            if position % 4 == 0:
                self._replan()
            self._use(output)
        self._weighted = [alternative.cost for alternatives in graph for alternative in alternatives]

    def active(self) -> list[int]:
        """The nodes in use, in ascending order."""
        return sorted(self._uses)

    def sweep(self) -> None:
        """Try every move once."""
        for move in (self._close, self._others):
            self._replan()
            for node in self.active():
                if self._switches > 0:
                    self._attempt(move, node)

    # --- moves

    def _attempt(self, move: Callable[[int], None], node: int) -> None:
        """Make a move, and take it back if the total rises or something depends on itself."""
        saved = self._state()
        move(node)
        if self.total > saved[2] + _LEAST_GAIN or not self._is_acyclic(self._changed(saved)):
            self.choice, self._uses, self.total = saved

    def _others(self, node: int) -> None:
        """Take another alternative of a node, and use what it brings wherever that is cheaper.

        One that leaves the total as it is is taken too, but never twice: it may open the way for others.
        """
        if node not in self._uses:
            return
        start = best = self._state()
        for k, alternative in enumerate(self._graph[node]):
            if k == start[0][node] or not self._is_planned(alternative):
                continue
            self._switch(node, k)
            for child in sorted(self._uses.keys() - start[1].keys()):
                self._exploit(child, node)
            limit = best[2] + (_LEAST_GAIN if best is start and (node, k) not in self._sideways else -_LEAST_GAIN)
            if self.total < limit and self._is_acyclic(self._changed(start)):
                if self.total > start[2] - _LEAST_GAIN:
                    self._sideways.add((node, k))
                best = self._state()
            self._return_to(start)
        self._return_to(best)

    def _exploit(self, node: int, spared: int) -> None:
        """Use a node wherever that is cheaper."""
        users = self._users_of[node]
        for user in sorted(users.keys() & self._uses.keys()):
            if user != spared:
                for k in users[user]:
                    if user in self._uses and k != self.choice[user] and self._is_promising(user, k):
                        self._improve(user, k)

    def _is_promising(self, node: int, k: int) -> bool:
        """Whether an alternative takes little that is not there yet."""
        new, old = self._graph[node][k], self._graph[node][self.choice[node]]
        return self._is_planned(new) and self._estimate(new) <= old.cost + _REACH

    def _improve(self, node: int, k: int) -> None:
        """Switch a node to an alternative, if that lowers the total."""
        start = self._state()
        self._switch(node, k)
        if self.total > start[2] - _LEAST_GAIN or not self._is_acyclic([node]):
            self.choice, self._uses, self.total = start

    def _close(self, node: int) -> None:
        """Switch everything that uses a node to its best alternative without it."""
        index = self._index
        for number in index.users[node] if node in self._uses else ():
            user = index.owner[number]
            if user in self._uses and self.choice[user] == number - index.first[user]:
                others = [
                    other
                    for other, alternative in enumerate(self._graph[user])
                    if node not in alternative.children and self._is_planned(alternative)
                ]
                if others:
                    self._switch(user, min(others, key=lambda other: self._estimate(self._graph[user][other])))

    # --- bookkeeping

    def _state(self) -> _State:
        return dict(self.choice), dict(self._uses), self.total

    def _return_to(self, state: _State) -> None:
        self.choice, self._uses, self.total = dict(state[0]), dict(state[1]), state[2]

    def _use(self, node: int) -> None:
        count = self._uses.get(node, 0)
        self._uses[node] = count + 1
        if not count:
            self.choice[node] = self._plan[node]
            alternative = self._graph[node][self.choice[node]]
            self.total += alternative.cost
            for child in alternative.children:
                self._use(child)

    def _release(self, node: int) -> None:
        self._uses[node] -= 1
        if not self._uses[node]:
            del self._uses[node]
            alternative = self._graph[node][self.choice.pop(node)]
            self.total -= alternative.cost
            for child in alternative.children:
                self._release(child)

    def _switch(self, node: int, k: int) -> None:
        self._switches -= 1
        old, new = self._graph[node][self.choice[node]], self._graph[node][k]
        for child in new.children:
            self._use(child)
        self.choice[node] = k
        self.total += new.cost - old.cost
        for child in old.children:
            self._release(child)

    def _changed(self, before: _State) -> list[int]:
        """The nodes with another alternative than before: a new cycle goes through one of them."""
        known = before[0]
        return [node for node, k in self.choice.items() if known.get(node) != k]

    def _is_acyclic(self, roots: Sequence[int]) -> bool:
        """Whether nothing below the roots depends on itself."""
        done: set[int] = set()
        on_path: set[int] = set()
        stack = list(roots)
        graph, choice = self._graph, self.choice
        while stack:
            node = stack[-1]
            if node not in choice:
                return False
            if node in done:
                stack.pop()
            elif node in on_path:
                on_path.discard(node)
                done.add(node)
                stack.pop()
            else:
                on_path.add(node)
                for child in graph[node][choice[node]].children:
                    if child in on_path:
                        return False
                    if child not in done:
                        stack.append(child)
        return True

    # --- plans: the cheapest tree of every node, nodes in use being free

    def _is_planned(self, alternative: Alternative) -> bool:
        plan = self._plan
        return all([child in plan for child in alternative.children])

    def _estimate(self, alternative: Alternative) -> float:
        uses, prices = self._uses, self._price
        return alternative.cost + sum([prices[child] for child in alternative.children if child not in uses])

    def _replan(self) -> None:
        """Knuth's generalisation of Dijkstra's algorithm over the whole graph."""
        first, owner, users = self._index.first, self._index.owner, self._index.users
        price: dict[int, float] = {}
        plan: Choice = {}
        missing, sums = self._index.sizes.copy(), self._weighted.copy()
        queue = [(0.0, first[node] + self.choice[node]) for node in self._uses]
        queue += [(sums[number], number) for number in self._index.leaves if owner[number] not in self._uses]
        heapq.heapify(queue)
        while queue:
            cost, number = heapq.heappop(queue)
            node = owner[number]
            if node in price:
                continue
            price[node], plan[node] = cost, number - first[node]
            for user in users[node]:
                missing[user] -= 1
                sums[user] += cost
                if not missing[user] and owner[user] not in price:
                    heapq.heappush(queue, (sums[user], user))
        self._plan, self._price = plan, price
        if any(output not in plan for output in self._outputs):
            raise InternalError("an output cannot be computed from the inputs")
