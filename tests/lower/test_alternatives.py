"""Every way to compute a node computes it, and any acyclic choice of ways computes the outputs."""

from __future__ import annotations

import random
from fractions import Fraction
from functools import cache

import numpy as np

from codegen.ir.builder import Builder
from codegen.ir.evaluate import evaluate
from codegen.ir.lower.alternatives import UNIT, ZERO
from codegen.ir.lower.graph import Choice
from codegen.ir.lower.scalarise import Entries, Scalariser
from codegen.ir.program import Argument, Output, Sparsity
from codegen.passes import simplify
from codegen.spec.request import QUANTITIES, Variant

from .models import VARIANTS, Covered, Laid, every_variant, laid_out, model_of, needed, program_of, random_choice
from .numbers import EXACT, random_inputs, stated_directions
from .truth import exact_truth

KINDS = frozenset(
    {"given", "components", "turned", "sum", "cross", "constant", "input", "function", "dot", "trace", "total"}
    | {"product", "polynomial", "outer", "rotation", "skewed", "joined", "assembled", "deviator"}
    | {"turned block"}
)
"""Every formula of `codegen.ir.lower.scalarise` but ``same``, which only raw matrices ask for."""

SEED = 5
"""Of the rational inputs."""

CHOICES = 2
"""Random choices for each variant."""


class Workbench:
    """Writes single alternatives on children that are inputs, or constants where their entries are known.

    Args:
        laid: the graph.
        values: entries of every node.
    """

    def __init__(self, laid: Laid, values: list[list[Fraction]]) -> None:
        self.builder = Builder()
        self._graph = laid.graph
        self._classes = [node.classes for node in laid.demands.layout.nodes]
        self._values = values
        self._scalariser = Scalariser(self._graph, {}, self.builder, self._scalar, lambda *_: None)

    def _scalar(self, name: str) -> int:
        return self.builder.input(f"symbol {name}", 0)

    def _child(self, node: int) -> Entries:
        known = zip(self._classes[node], self._values[node], strict=True)
        return tuple(
            self.builder.input(f"node {node}", k) if entry_class not in (ZERO, UNIT) else self.builder.constant(value)
            for k, (entry_class, value) in enumerate(known)
        )

    def entries(self, node: int, k: int) -> Entries:
        """Positions of what an alternative of a node gives."""
        alternative = self._graph[node][k]
        return self._scalariser._formula(alternative, [self._child(child) for child in alternative.children])


@cache
def values_of(laid: Laid) -> list[list[Fraction]]:
    """Entries of every node by its meaning."""
    meaning = laid.meaning(random_inputs(laid.model, SEED))
    return [meaning.of(node.key) for node in laid.demands.layout.nodes]


def evaluated(laid: Laid, bench: Workbench, positions: list[int]) -> list[Fraction]:
    """Values at some positions of what stands on a workbench."""
    inputs = random_inputs(laid.model, SEED)
    inputs |= {f"node {node}": values for node, values in enumerate(values_of(laid))}
    meaning = laid.meaning(inputs)
    inputs |= {f"symbol {name}": [value] for name, value in meaning.scalars.items() if isinstance(value, Fraction)}
    arguments = tuple(Argument(name, (len(values), 1)) for name, values in inputs.items())
    pattern = Sparsity(len(positions), 1, (0, len(positions)), tuple(range(len(positions))))
    program = bench.builder.freeze(arguments, (Output("all", pattern, tuple(positions)),))
    return evaluate(program, inputs, EXACT)["all"]


@every_variant
def test_every_alternative_gives_what_its_node_means(variant: Variant) -> None:
    """Checked one by one, from the true values of its children, in exact fractions."""
    for laid in laid_out(variant):
        values, bench = values_of(laid), Workbench(laid, values_of(laid))
        places, positions = [], []
        for node, alternatives in enumerate(laid.graph):
            for k in range(len(alternatives)):
                entries = bench.entries(node, k)
                assert len(entries) == len(values[node]), (node, alternatives[k])
                places += [(node, k, n) for n in range(len(entries))]
                positions += entries
        wrong = {
            place[:2]
            for place, value in zip(places, evaluated(laid, bench, positions), strict=True)
            if value != values[place[0]][place[2]]
        }
        assert not wrong, [(laid.demands.layout.nodes[n].key, laid.graph[n][k]) for n, k in sorted(wrong)[:3]]


@every_variant
def test_entries_that_are_known_as_zero_or_one_are(variant: Variant) -> None:
    for laid in laid_out(variant):
        for node, values in zip(laid.demands.layout.nodes, values_of(laid), strict=True):
            for entry_class, value in zip(node.classes, values, strict=True):
                assert entry_class != ZERO or value == 0, node.key
                assert entry_class != UNIT or abs(value) == 1, node.key


@every_variant
def test_no_alternative_takes_its_own_node(variant: Variant) -> None:
    for laid in laid_out(variant):
        for node, alternatives in enumerate(laid.graph):
            assert all(node not in alternative.children for alternative in alternatives)


@every_variant
def test_every_node_can_be_computed(variant: Variant) -> None:
    for laid in laid_out(variant):
        assert len(random_choice(laid.graph, random.Random(0), set())) == len(laid.graph)


def test_every_kind_of_alternative_is_met() -> None:
    met = {alternative.kind for laid in every_part() for ways in laid.graph for alternative in ways}
    assert met == KINDS


def every_part() -> list[Laid]:
    return [laid for variant in VARIANTS for laid in laid_out(variant)]


@cache
def choices_of(variant: Variant) -> tuple[tuple[Choice, ...], ...]:
    """Random choices for every part of a variant; each prefers alternatives that none before it took."""
    source = random.Random(1)
    covered: list[Covered] = [set() for _ in laid_out(variant)]
    found = []
    for _ in range(CHOICES):
        choices = []
        for laid, seen in zip(laid_out(variant), covered, strict=True):
            choices.append(random_choice(laid.graph, source, seen))
            seen |= {(node, choices[-1][node]) for node in needed(laid.graph, choices[-1], laid.roots)}
        found.append(tuple(choices))
    return tuple(found)


@every_variant
def test_any_acyclic_choice_computes_the_outputs(variant: Variant) -> None:
    """Random choices against the reference, exactly, at poses off the manifold."""
    for seed, choices in enumerate(choices_of(variant)):
        inputs = random_inputs(model_of(variant), seed)
        truth = exact_truth(variant, inputs)
        program = simplify(program_of(laid_out(variant), choices))
        values = evaluate(program, inputs, EXACT)
        assert {output.name for output in program.outputs} == set(QUANTITIES)
        for output in program.outputs:
            expected = truth[output.name].reshape(output.sparsity.nrow, output.sparsity.ncol)
            dense = np.full(expected.shape, Fraction(0), dtype=object)
            for place, value in zip(output.sparsity.entries(), values[output.name], strict=True):
                dense[place] = value
            if output.name == "phi_q_t_lambda_q":
                dense, expected = (matrix @ stated_directions(variant, inputs) for matrix in (dense, expected))
            assert np.array_equal(dense, expected), (output.name, seed, np.argwhere(dense != expected))


def test_every_kind_of_alternative_is_part_of_a_random_choice() -> None:
    met = set()
    for variant in VARIANTS:
        for choices in choices_of(variant):
            for laid, choice in zip(laid_out(variant), choices, strict=True):
                met |= {laid.graph[node][choice[node]].kind for node in needed(laid.graph, choice, laid.roots)}
    assert met == KINDS
