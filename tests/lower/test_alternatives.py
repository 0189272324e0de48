"""Every way to compute a node computes it, and any acyclic choice of ways computes the outputs."""

from __future__ import annotations

import random
from collections import Counter
from fractions import Fraction
from functools import cache

import numpy as np
import pytest

from codegen.ir.builder import Builder
from codegen.ir.evaluate import evaluate
from codegen.ir.lower.alternatives import UNIT, ZERO
from codegen.ir.lower.scalarise import Entries, Scalariser
from codegen.ir.program import Argument, Output, Sparsity
from codegen.passes import simplify
from codegen.spec.request import QUANTITIES, Variant
from tests.truth.cases import SPOTS, inputs_at, largest, natural_scale, truth_at

from .models import VARIANTS, Covered, Laid, every_variant, laid_out, needed, program_of, random_choice
from .numbers import EXACT, random_inputs

KINDS = frozenset(
    {"given", "components", "turned", "sum", "cross", "constant", "input", "function", "dot", "trace", "total"}
    | {"product", "polynomial", "outer", "rotation", "skewed", "joined", "assembled", "deviator"}
)
"""Every formula of `codegen.ir.lower.scalarise` but ``same``, which only raw matrices ask for."""

EXACTLY = tuple(variant for variant in VARIANTS if variant.form == "conventional")
"""Variants without a sine."""

SEED = 5
"""Of the rational inputs."""

CHOICES = 12
"""Random choices for each variant."""

TOLERANCE = 1e-9

LEAST_COVERED = 0.3
KINDS_OF_CHOICES = frozenset({"given", "components", "turned", "sum", "cross"})


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


@every_variant
def test_any_acyclic_choice_computes_the_outputs(variant: Variant) -> None:
    """Random choices, most of all the alternatives at last, against the reference; general poses, off the manifold too."""
    parts = laid_out(variant)
    source = random.Random(1)
    covered: list[Covered] = [set() for _ in parts]
    used: Counter[str] = Counter()
    for turn in range(CHOICES):
        choices = [random_choice(laid.graph, source, seen) for laid, seen in zip(parts, covered, strict=True)]
        for laid, choice, seen in zip(parts, choices, covered, strict=True):
            seen |= {(node, choice[node]) for node in needed(laid.graph, choice, laid.roots)}
            used.update(laid.graph[node][choice[node]].kind for node in needed(laid.graph, choice, laid.roots))
        program = simplify(program_of(parts, choices))
        spot = SPOTS[turn % len(SPOTS)]
        inputs = {name: np.ravel(values, order="F") for name, values in inputs_at(variant, spot).items()}
        values = evaluate(program, inputs)
        for output in program.outputs:
            dense = np.zeros((output.sparsity.nrow, output.sparsity.ncol))
            for place, value in zip(output.sparsity.entries(), values[output.name], strict=True):
                dense[place] = value
            truth = truth_at(variant, spot)[output.name].reshape(dense.shape)
            error = largest(dense - truth) / natural_scale(variant, output.name, truth)
            assert error < TOLERANCE, (output.name, spot, error)
    print(variant, program.output, sum(map(len, covered)), sum(len(a) for laid in parts for a in laid.graph), used)
    total = sum(len(alternatives) for laid in parts for alternatives in laid.graph)
    assert sum(map(len, covered)) > LEAST_COVERED * total
    assert set(used) >= KINDS_OF_CHOICES
