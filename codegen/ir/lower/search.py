"""The cheapest way to compute the outputs: choose one alternative for every node that is needed.

A node that several others use is paid once, so the choice is made over the whole graph. It starts from the cheapest
tree of each output and is improved by moves that are kept when the total falls: another alternative for a node, with
everything that profits from what it brings switched to it; a node closed, with everything that used it switched away.
A seed changes where the search starts; from the same seed it always ends the same.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Iterable, Sequence
from itertools import compress

from codegen.errors import InternalError
from codegen.ir.lower.graph import Choice, Graph, Index, price, weighted

_Logged = tuple[int, int, int]
"""A node, how often it was used, and the number of its alternative."""

_NONE = -1
"""Number of the alternative of a node that is not in use, or that nothing leads to."""

_LEAST_GAIN = 1e-9

PATIENCE = 2
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
    return _searched(Index(graph), outputs, seed, sweeps, switches)


def _searched(
    index: Index,
    outputs: Sequence[int],
    seed: int,
    sweeps: int = 12,
    switches: float = math.inf,
    patience: int = PATIENCE,
) -> Choice:
    search = _Search(index, outputs, seed, switches)
    idle = 0
    for _ in range(sweeps):
        before = search.total
        search.sweep()
        idle = idle + 1 if search.total > before - _LEAST_GAIN else 0
        if idle == patience:
            break
    return search.choice()


def searched(
    graph: Graph, outputs: Sequence[int], seeds: Iterable[int], best: int = 2, patience: int = PATIENCE
) -> list[Choice]:
    """Search from several starts.

    Args:
        graph: alternatives of every node.
        outputs: nodes that must be computed.
        seeds: of the starts.
        best: how many of the choices are given at most.
        patience: sweeps without a gain after which a search ends.

    Returns:
        The cheapest of the choices found, each once, the cheapest first.
    """
    ends: dict[tuple[tuple[int, int], ...], Choice] = {}
    index = Index(graph)
    for seed in seeds:
        choice = _searched(index, outputs, seed, patience=patience)
        ends.setdefault(tuple(choice.items()), choice)
    return sorted(ends.values(), key=lambda choice: price(graph, choice))[:best]


class _Search:
    """A choice under improvement, with counts of how often each node is used.

    What changes is logged, so that a move is taken back at the price of what it did.
    """

    def __init__(self, index: Index, outputs: Sequence[int], seed: int, switches: float) -> None:
        self._index, self._children, self._costs = index, index.children, index.costs
        self._weighted = [cost for costs in weighted(index.graph, seed) for cost in costs]
        self._chosen = [_NONE] * len(index.graph)
        self._uses = [0] * len(index.graph)
        self._log: list[_Logged] = []
        self._switches = switches
        self._outputs = list(outputs)
        self._sideways: set[int] = set()
        self.total = 0.0
        for position, output in enumerate(self._outputs):
            if position % 4 == 0:
                self._replan()
            self._use((output,))
        self._weighted = index.costs

    def choice(self) -> Choice:
        """The choice of every node in use, in ascending order."""
        first = self._index.first
        return {node: number - first[node] for node, number in enumerate(self._chosen) if number != _NONE}

    def sweep(self) -> None:
        """Try every move once."""
        for move in (self._close, self._others):
            self._replan()
            for node in [node for node, count in enumerate(self._uses) if count]:
                if self._switches > 0:
                    self._attempt(move, node)

    # --- moves

    def _attempt(self, move: Callable[[int], None], node: int) -> None:
        """Make a move, and take it back if the total rises or something depends on itself."""
        self._log.clear()
        before = self.total
        move(node)
        if self.total > before + _LEAST_GAIN or not self._is_acyclic(self._changed(0)):
            self._return_to(0, before)

    def _others(self, node: int) -> None:
        """Take another alternative of a node, and use what it brings wherever that is cheaper.

        One that leaves the total as it is is taken too, but never twice: it may open the way for others.
        """
        if not self._uses[node]:
            return
        start, mark, best = self.total, len(self._log), self.total
        found: list[_Logged] = []
        for number in self._index.numbers(node):
            if number == self._chosen[node] or self._missing[number]:
                continue
            self._switch(node, number)
            for child in self._opened(mark):
                self._exploit(child, node)
            limit = best + (_LEAST_GAIN if not found and number not in self._sideways else -_LEAST_GAIN)
            if self.total < limit and self._is_acyclic(self._changed(mark)):
                if self.total > start - _LEAST_GAIN:
                    self._sideways.add(number)
                best = self.total
                found = [(n, self._uses[n], self._chosen[n]) for n in self._before(mark)]
            self._return_to(mark, start)
        for state in found:
            self._set(*state)
        self.total = best

    def _exploit(self, node: int, spared: int) -> None:
        """Use a node wherever that is cheaper, trying alternatives that take little that is not there yet."""
        uses, chosen, costs, children = self._uses, self._chosen, self._costs, self._children
        missing, prices = self._missing, self._price
        for user, numbers in list(compress(*self._index.used_by(node, uses))):
            if user == spared:
                continue
            for number in numbers:
                old = chosen[user]
                if old == _NONE:
                    break
                room = costs[old] + _REACH - costs[number]
                if room < 0 or number == old or missing[number]:
                    continue
                for child in children[number]:
                    if not uses[child]:
                        room -= prices[child]
                if room >= 0:
                    if costs[number] >= costs[old] and self._frees_nothing(old):
                        self._switches -= 1  # as if it were tried
                    else:
                        self._improve(user, number)

    def _frees_nothing(self, number: int) -> bool:
        """Whether what an alternative takes is used by others too."""
        uses, children = self._uses, self._children[number]
        return len(children) == self._index.sizes[number] and all([uses[child] > 1 for child in children])

    def _improve(self, node: int, number: int) -> None:
        """Switch a node to an alternative, if that lowers the total."""
        before, mark = self.total, len(self._log)
        self._switch(node, number)
        if self.total > before - _LEAST_GAIN or not self._is_acyclic([node]):
            self._return_to(mark, before)

    def _close(self, node: int) -> None:
        """Switch everything that uses a node to its best alternative without it."""
        index = self._index
        for number in index.users[node] if self._uses[node] else ():
            user = index.owner[number]
            if self._chosen[user] == number:
                others = [
                    other
                    for other in index.numbers(user)
                    if not self._missing[other] and node not in self._children[other]
                ]
                if others:
                    self._switch(user, min(others, key=self._estimate))

    # --- bookkeeping

    def _set(self, node: int, count: int, number: int) -> None:
        self._log.append((node, self._uses[node], self._chosen[node]))
        self._uses[node], self._chosen[node] = count, number

    def _return_to(self, mark: int, total: float) -> None:
        """Take back everything after a place in the log."""
        uses, chosen, log = self._uses, self._chosen, self._log
        for node, count, number in reversed(log[mark:]):
            uses[node], chosen[node] = count, number
        del log[mark:]
        self.total = total

    def _before(self, mark: int) -> dict[int, _Logged]:
        """Nodes that were touched after a place in the log, as they were there."""
        found: dict[int, _Logged] = {}
        for state in self._log[mark:]:
            found.setdefault(state[0], state)
        return found

    def _opened(self, mark: int) -> list[int]:
        """The nodes in use that were not at a place in the log, in ascending order."""
        return sorted(node for node, state in self._before(mark).items() if self._uses[node] and not state[1])

    def _changed(self, mark: int) -> list[int]:
        """The nodes with another alternative than at a place in the log: a new cycle goes through one of them."""
        chosen = self._chosen
        return [n for n, state in self._before(mark).items() if chosen[n] != _NONE and chosen[n] != state[2]]

    def _use(self, nodes: Sequence[int]) -> None:
        uses, chosen, log = self._uses, self._chosen, self._log
        stack = [*reversed(nodes)]
        while stack:
            node = stack.pop()
            count = uses[node]
            log.append((node, count, chosen[node]))
            uses[node] = count + 1
            if not count:
                number = chosen[node] = self._plan[node]
                self.total += self._costs[number]
                stack += reversed(self._children[number])

    def _release(self, nodes: Sequence[int]) -> None:
        uses, chosen, log = self._uses, self._chosen, self._log
        stack = [*reversed(nodes)]
        while stack:
            node = stack.pop()
            count, number = uses[node], chosen[node]
            log.append((node, count, number))
            uses[node] = count - 1
            if count == 1:
                chosen[node] = _NONE
                self.total -= self._costs[number]
                stack += reversed(self._children[number])

    def _switch(self, node: int, number: int) -> None:
        self._switches -= 1
        old = self._chosen[node]
        self._use(self._children[number])
        self._set(node, self._uses[node], number)
        self.total += self._costs[number] - self._costs[old]
        self._release(self._children[old])

    def _is_acyclic(self, roots: Sequence[int]) -> bool:
        """Whether nothing below the roots depends on itself."""
        done: set[int] = set()
        on_path: set[int] = set()
        stack = list(roots)
        children, chosen = self._children, self._chosen
        while stack:
            node = stack[-1]
            if chosen[node] == _NONE:
                return False
            if node in done:
                stack.pop()
            elif node in on_path:
                on_path.discard(node)
                done.add(node)
                stack.pop()
            else:
                on_path.add(node)
                for child in children[chosen[node]]:
                    if child in on_path:
                        return False
                    if child not in done:
                        stack.append(child)
        return True

    # --- plans: the cheapest tree of every node, nodes in use being free

    def _estimate(self, number: int) -> float:
        """What an alternative costs with the trees of what is not there yet."""
        uses, prices = self._uses, self._price
        return self._costs[number] + sum([prices[child] for child in self._children[number] if not uses[child]])

    def _replan(self) -> None:
        """Knuth's generalisation of Dijkstra's algorithm over the whole graph."""
        index, size = self._index, len(self._uses)
        owner, users = index.owner, index.users
        price, plan = [math.inf] * size, [_NONE] * size
        missing, sums = index.sizes.copy(), self._weighted.copy()
        queue = [(0.0, number) for number in self._chosen if number != _NONE]
        queue += [(sums[number], number) for number in index.leaves if not self._uses[owner[number]]]
        heapq.heapify(queue)
        pop, push = heapq.heappop, heapq.heappush
        waiting = price.copy()  # the least that is in the queue of each node; less than anything once it is planned
        while queue:
            cost, number = pop(queue)
            node = owner[number]
            if plan[node] != _NONE:
                continue
            price[node], plan[node], waiting[node] = cost, number, -math.inf
            for user in users[node]:
                missing[user] -= 1
                sums[user] += cost
                if not missing[user] and sums[user] <= waiting[owner[user]]:
                    waiting[owner[user]] = sums[user]
                    push(queue, (sums[user], user))
        self._plan, self._price, self._missing = plan, price, missing
        if any(plan[output] == _NONE for output in self._outputs):
            raise InternalError("an output cannot be computed from the inputs")
