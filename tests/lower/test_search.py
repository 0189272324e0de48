"""The search gives an acyclic, complete choice, never dearer than its start, and always the same."""

from __future__ import annotations

import hashlib
import itertools
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.errors import InternalError
from codegen.ir.lower.alternatives import Alternative
from codegen.ir.lower.record import fingerprint, recorded, replayed
from codegen.ir.lower.search import Choice, Graph, cheapest, price, searched
from codegen.spec.request import Variant

from .models import laid_out, needed

REVOLUTE = Variant("revolute", "conventional", None)

few = settings(max_examples=60, deadline=None)


@st.composite
def graphs(draw: st.DrawFn, largest: int = 7) -> tuple[Graph, list[int]]:
    """Graphs that may have cycles but whose outputs can be computed: each node has an alternative on smaller nodes."""
    size = draw(st.integers(2, largest))
    costs = st.sampled_from([0.0, 1.0, 2.0, 3.0, 5.0])
    graph = []
    for node in range(size):
        below = st.lists(st.integers(0, node - 1), max_size=3, unique=True) if node else st.just([])
        others = st.lists(st.sampled_from([n for n in range(size) if n != node]), max_size=3, unique=True)
        ways = [(draw(below), draw(costs)), *draw(st.lists(st.tuples(others, costs), max_size=2))]
        graph.append(tuple(Alternative("way", tuple(children), cost) for children, cost in draw(st.permutations(ways))))
    outputs = draw(st.lists(st.integers(0, size - 1), min_size=1, max_size=3, unique=True))
    return graph, outputs


def is_acyclic(graph: Graph, choice: Choice) -> bool:
    """Whether the chosen alternatives can be computed one after another."""
    done: set[int] = set()
    while True:
        ready = {n for n, k in choice.items() if n not in done and done.issuperset(graph[n][k].children)}
        if not ready:
            return len(done) == len(choice)
        done |= ready


def optimum(graph: Graph, outputs: Sequence[int]) -> float:
    """Least price over all choices, one by one."""
    best = float("inf")
    for ways in itertools.product(*(range(len(alternatives)) for alternatives in graph)):
        nodes = needed(graph, dict(enumerate(ways)), outputs)
        choice = {node: ways[node] for node in nodes}
        if is_acyclic(graph, choice):
            best = min(best, price(graph, choice))
    return best


def cheapest_trees(graph: Graph, outputs: Sequence[int]) -> float:
    """Price of the outputs one by one, nothing shared."""
    least = [float("inf")] * len(graph)
    for _ in graph:
        for node, ways in enumerate(graph):
            least[node] = min(way.cost + sum(least[child] for child in way.children) for way in ways)
    return sum(least[output] for output in outputs)


@few
@given(graphs(), st.integers(0, 3))
def test_a_choice_is_complete_and_acyclic_and_holds_nothing_else(case: tuple[Graph, list[int]], seed: int) -> None:
    graph, outputs = case
    choice = cheapest(graph, outputs, seed)
    assert set(choice) == set(needed(graph, choice, outputs))
    assert is_acyclic(graph, choice)


@few
@given(graphs())
def test_a_choice_costs_at_least_the_optimum_and_at_most_the_outputs_one_by_one(case: tuple[Graph, list[int]]) -> None:
    graph, outputs = case
    found = price(graph, cheapest(graph, outputs))
    assert optimum(graph, outputs) <= found <= cheapest_trees(graph, outputs)


@few
@given(graphs(), st.integers(0, 3), st.integers(0, 4))
def test_more_sweeps_never_make_a_choice_dearer(case: tuple[Graph, list[int]], seed: int, sweeps: int) -> None:
    graph, outputs = case
    before = price(graph, cheapest(graph, outputs, seed, sweeps))
    assert price(graph, cheapest(graph, outputs, seed, sweeps + 1)) <= before


@few
@given(graphs(), st.integers(0, 20))
def test_a_search_that_may_switch_a_few_times_only_gives_a_choice_as_good_as_its_start(
    case: tuple[Graph, list[int]], switches: int
) -> None:
    graph, outputs = case
    choice = cheapest(graph, outputs, switches=switches)
    assert set(choice) == set(needed(graph, choice, outputs))
    assert is_acyclic(graph, choice)
    assert price(graph, choice) <= price(graph, cheapest(graph, outputs, switches=0))
    assert cheapest(graph, outputs, switches=0) == cheapest(graph, outputs, sweeps=0)


@few
@given(graphs(), st.lists(st.integers(0, 5), min_size=1, max_size=4))
def test_of_several_starts_the_best_ends_come_first(case: tuple[Graph, list[int]], seeds: list[int]) -> None:
    graph, outputs = case
    ends = [price(graph, cheapest(graph, outputs, seed)) for seed in seeds]
    prices = [price(graph, choice) for choice in searched(graph, outputs, seeds)]
    assert prices == sorted(prices)
    assert prices[0] == min(ends)


def test_the_cheaper_of_two_ways_is_taken_where_it_is_shared() -> None:
    """A detour of price 3 that serves two outputs beats two direct ways of price 2."""
    direct, detour = Alternative("direct", (), 2.0), Alternative("by way of", (2,), 0.0)
    graph = [(direct, detour), (direct, detour), (Alternative("detour", (), 3.0),)]
    assert cheapest(graph, [0, 1]) == {0: 1, 1: 1, 2: 0}
    assert cheapest(graph, [0]) == {0: 0}


def test_an_output_that_needs_itself_is_refused() -> None:
    graph = [(Alternative("round", (1,), 1.0),), (Alternative("round", (0,), 1.0),)]
    with pytest.raises(InternalError):
        cheapest(graph, [0])


def test_a_real_model_gets_a_choice_that_is_complete_and_acyclic() -> None:
    (laid,) = laid_out(REVOLUTE, ("phi", "phi_q"))
    choice = cheapest(laid.graph, laid.roots)
    assert set(choice) == set(needed(laid.graph, choice, laid.roots))
    assert is_acyclic(laid.graph, choice)
    assert price(laid.graph, choice) <= cheapest_trees(laid.graph, laid.roots)


_PRINT_CHOICES = f"""
from codegen.spec.request import Variant
from tests.lower.test_search import digest
print(digest({REVOLUTE!r}))
"""


def digest(variant: Variant) -> str:
    """Tell the graph of a model and the choices of two starts from others."""
    (laid,) = laid_out(variant, ("phi", "phi_q"))
    choices = [cheapest(laid.graph, laid.roots, seed) for seed in (0, 1)]
    return hashlib.sha256(repr((laid.graph, laid.roots, choices)).encode()).hexdigest()


def test_graph_and_choice_do_not_depend_on_the_seed_of_hashes() -> None:
    root = Path(__file__).parents[2]
    found = {digest(REVOLUTE)}
    for seed in ("1", "2"):
        environment = {**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(root)}
        run = subprocess.run(
            [sys.executable, "-c", _PRINT_CHOICES],
            cwd=root,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        found.add(run.stdout.strip())
    assert len(found) == 1


@few
@given(graphs(), st.integers(0, 3))
def test_a_choice_is_read_back_from_its_record(case: tuple[Graph, list[int]], seed: int) -> None:
    graph, outputs = case
    choice = cheapest(graph, outputs, seed)
    assert replayed(graph, outputs, recorded(graph, outputs, choice)) == choice


def test_a_high_number_is_read_back_from_its_record() -> None:
    """Records write one character for most numbers."""
    ways = tuple(Alternative("way", (), float(100 - k)) for k in range(200))
    graph = [ways, ways[:62], ways[:63], ways[:125]]
    for numbers in ((199, 61, 62, 124), (0, 0, 0, 0), (62, 9, 10, 63)):
        choice = dict(enumerate(numbers))
        assert replayed(graph, [0, 1, 2, 3], recorded(graph, [0, 1, 2, 3], choice)) == choice


@few
@given(graphs())
def test_a_record_of_another_graph_is_refused_or_gives_a_choice_of_this_one(case: tuple[Graph, list[int]]) -> None:
    graph, outputs = case
    for record in ("", "9", "00", "!"):
        try:
            choice = replayed(graph, outputs, record)
        except InternalError:
            continue
        assert set(choice) == set(needed(graph, choice, outputs))


@few
@given(graphs(), graphs())
def test_graphs_of_one_fingerprint_are_equal(one: tuple[Graph, list[int]], other: tuple[Graph, list[int]]) -> None:
    assert (fingerprint(*one) == fingerprint(*other)) == (one == other)
