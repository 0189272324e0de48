"""Real models laid out: the graph of each part, choices at random, and the program of a choice."""

from __future__ import annotations

import heapq
import random
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

import pytest

from codegen import models
from codegen.ir.builder import Builder
from codegen.ir.lower.demands import Demand, Demands
from codegen.ir.lower.graph import Choice, Graph
from codegen.ir.lower.lowering import Part, _Searched
from codegen.ir.program import Output, Program
from codegen.mechanics import frames
from codegen.spec.request import QUANTITIES, Variant

from .meaning import Meaning
from .numbers import Inputs, of_symbols

VARIANTS = (
    Variant("revolute", "conventional", None),
    Variant("translational", "conventional", None, variation="world"),
    Variant("screw", "conventional", None),
    Variant("revolute", "parametric", "regular"),
    Variant("translational", "parametric", "regular", "substituted"),
    Variant("ball", "parametric", "quaternion", "substituted"),
)
"""Both forms, both variations, both derivatives, regular and quaternion rows, an arc tangent."""

Covered = set[tuple[int, int]]
"""Nodes with one of their alternatives."""


@dataclass(frozen=True, eq=False)
class Laid:
    """A part of a model, laid out.

    Attributes:
        model: the symbolic model.
        part: outputs and frames.
        searched: the part as `codegen.ir.lower.lowering` has it, without any search.
    """

    model: models.Model
    part: Part
    searched: _Searched

    @property
    def graph(self) -> Graph:
        """Alternatives of every node."""
        return self.searched._graph

    @property
    def demands(self) -> Demands:
        """What was read."""
        return self.searched._demands

    def found(self, output: str) -> list[Demand]:
        """What an output demands."""
        return self.searched._found[output]

    @property
    def roots(self) -> list[int]:
        """Nodes that the outputs take."""
        found = (demand for output in self.part.outputs for demand in self.found(output.name))
        return list(dict.fromkeys(demand[3][1] for demand in found))

    def meaning(self, inputs: Inputs) -> Meaning:
        """Values at some inputs."""
        layout = self.demands.layout
        return Meaning(layout.space, layout.tree, layout.definitions, inputs, of_symbols(self.model, inputs))

    def written(self, choice: Choice, builder: Builder, legend: dict[str, str]) -> list[Output]:
        """Write the outputs with a choice."""
        self.searched.choices = [choice]
        form = self.model.form
        return self.searched.written(0, builder, frames.inputs(form.coordinates, form.row_count), legend)


@cache
def model_of(variant: Variant) -> models.Model:
    """The symbolic model of a variant."""
    return models.model(variant)


@cache
def laid_out(variant: Variant, names: tuple[str, ...] = QUANTITIES) -> tuple[Laid, ...]:
    """Lay out the parts of some quantities."""
    model = model_of(variant)
    inputs = frames.inputs(model.form.coordinates, model.form.row_count)
    parts = model._parts(model.outputs(names), None)
    return tuple(Laid(model, part, _Searched(part, inputs, models.PRICES, lambda *_: [])) for part in parts)


def program_of(parts: tuple[Laid, ...], choices: Iterable[Choice]) -> Program:
    """Write one program of several parts, not simplified."""
    builder, legend = Builder(), {}
    outputs = [
        output for laid, choice in zip(parts, choices, strict=True) for output in laid.written(choice, builder, legend)
    ]
    form = parts[0].model.form
    arguments = frames.arguments(parts[0].model.joint, form.coordinates, form.row_count)
    return builder.freeze(arguments, tuple(outputs), legend)


def random_choice(graph: Graph, source: random.Random, covered: Covered) -> Choice:
    """Choose an alternative of every node so that none depends on itself; those not covered yet come first.

    Nodes are settled one by one: at any time one of the alternatives whose children are settled is taken at random.
    """
    users: list[list[tuple[int, int]]] = [[] for _ in graph]
    missing: dict[tuple[int, int], int] = {}
    queue: list[tuple[bool, float, int, int]] = []

    def ready(node: int, k: int) -> None:
        heapq.heappush(queue, ((node, k) in covered, source.random(), node, k))

    for node, alternatives in enumerate(graph):
        for k, alternative in enumerate(alternatives):
            children = set(alternative.children)
            missing[node, k] = len(children)
            for child in children:
                users[child].append((node, k))
            if not children:
                ready(node, k)
    choice: Choice = {}
    while queue:
        _, _, node, k = heapq.heappop(queue)
        if node in choice:
            continue
        choice[node] = k
        for user in users[node]:
            missing[user] -= 1
            if not missing[user]:
                ready(*user)
    return choice


def needed(graph: Graph, choice: Choice, roots: Iterable[int]) -> list[int]:
    """The nodes that the roots take by a choice."""
    seen: dict[int, None] = {}
    waiting = list(roots)
    while waiting:
        node = waiting.pop()
        if node not in seen:
            seen[node] = None
            waiting += graph[node][choice[node]].children
    return list(seen)


def each(*variants: Variant) -> pytest.MarkDecorator:
    """Run a test for each of the variants."""
    return pytest.mark.parametrize("variant", variants, ids=lambda variant: variant.file_stem)


every_variant = each(*VARIANTS)
