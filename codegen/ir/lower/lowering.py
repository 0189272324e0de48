"""Lower symbolic outputs to a scalar program: read, lay out, search, write."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from codegen.ir.builder import Builder
from codegen.ir.lower.alternatives import Prices
from codegen.ir.lower.demands import Demand, Demands
from codegen.ir.lower.graph import Choice, Graph
from codegen.ir.lower.outputs import SymbolicOutput
from codegen.ir.lower.places import Places
from codegen.ir.lower.scalarise import Entries, Scalariser
from codegen.ir.lower.ways import lay_out
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Output, Program, Sparsity


@dataclass(frozen=True)
class Part:
    """Outputs that are written in the same frames."""

    places: Places
    outputs: tuple[SymbolicOutput, ...]


Inputs = Mapping[Any, tuple[str, int]]
"""Symbol -> argument and offset of its first entry (column-major)."""


Choose = Callable[[Graph, Sequence[int]], Sequence[Choice]]
"""Graph and outputs -> one choice or several."""


def lower(
    arguments: tuple[Argument, ...],
    inputs: Inputs,
    parts: Sequence[Part],
    prices: Prices,
    choose: Choose,
) -> list[Program]:
    """Lower outputs to a program, in each of the ways that are chosen among all.

    Args:
        arguments: the arrays of the signature, in order.
        inputs: where symbols are read.
        parts: the outputs, by the frames they are written in; they come in this order. An output that several parts
            have is the sum of theirs.
        prices: of operations.
        choose: gives the choices for a graph; what they share as scalars is only seen in the program.

    Returns:
        Programs of the same outputs; not simplified, every output dense.
    """
    searched = [_Searched(part, inputs, prices, choose) for part in parts]
    programs = []
    for k in range(max(len(found.choices) for found in searched)):
        builder = Builder()
        builder.constant(0)
        legend: dict[str, str] = {}
        written = [output for found in searched for output in found.written(k, builder, inputs, legend)]
        programs.append(builder.freeze(arguments, _added(written, builder), legend))
    return programs


def _added(written: Sequence[Output], builder: Builder) -> tuple[Output, ...]:
    """Add up the outputs of one name; where none has an entry it is zero."""
    zero = builder.constant(0)
    found: dict[str, dict[tuple[int, int], int]] = {}
    shapes = {output.name: (output.sparsity.nrow, output.sparsity.ncol) for output in written}
    for output in written:
        entries = found.setdefault(output.name, {})
        for place, value in zip(output.sparsity.entries(), output.values, strict=True):
            before = entries.get(place, zero)
            entries[place] = (
                value if before == zero else before if value == zero else builder.emit(Op.ADD, before, value)
            )
    return tuple(_dense(name, shapes[name], entries, zero) for name, entries in found.items())


def _dense(name: str, shape: tuple[int, int], entries: Mapping[tuple[int, int], int], zero: int) -> Output:
    nrow, ncol = shape
    places = [(row, column) for column in range(ncol) for row in range(nrow)]
    return Output(name, Sparsity.of_entries(nrow, ncol, places), tuple(entries.get(place, zero) for place in places))


def structural_rows(part: Part, inputs: Inputs) -> set[int]:
    """The rows of the first output of a part that are not identically zero, from the entries known to be zero."""
    demands = Demands(part.places, inputs, Prices())
    found = set()
    for row, _, kind, (_, node, *_) in demands.of(part.outputs[0]):
        classes = demands.layout.classes(node)
        found |= {row + (k if kind == "column" else 0) for k, c in enumerate(classes) if c}
    return found


class _Searched:
    """One part with the choices for it."""

    def __init__(self, part: Part, inputs: Inputs, prices: Prices, choose: Choose) -> None:
        self._outputs = part.outputs
        self._demands = Demands(part.places, inputs, prices)
        self._found = {output.name: self._demands.of(output) for output in part.outputs}
        self._graph: Graph = lay_out(self._demands.layout)
        nodes = list(dict.fromkeys(demand[3][1] for found in self._found.values() for demand in found))
        self.choices = choose(self._graph, nodes)

    def written(self, k: int, builder: Builder, inputs: Inputs, legend: dict[str, str]) -> list[Output]:
        """Write the outputs with the k-th choice, or the last there is."""
        naming = self._demands.naming
        nodes = self._demands.layout.nodes
        places = {symbol.name: place for symbol, place in inputs.items() if isinstance(symbol, sympy.Symbol)}
        taken = frozenset(legend)

        def read(name: str) -> int:
            return builder.constant(Constant(Fraction(1), 1)) if name == "pi" else builder.input(*places[name])

        def finished(node: int, entries: Entries) -> None:
            named = naming.of(nodes[node].key)
            if named is not None and named[0] not in taken:  # by another part, for another value
                name, definition, first = named
                legend.setdefault(name, definition)
                for position, entry in enumerate(entries):
                    builder.label(entry, (name, first + position))

        choice = self.choices[min(k, len(self.choices) - 1)]
        scalariser = Scalariser(self._graph, choice, builder, read, finished)
        return [_written(output, self._found[output.name], scalariser) for output in self._outputs]


def _written(output: SymbolicOutput, demands: list[Demand], scalariser: Scalariser) -> Output:
    entries: dict[tuple[int, int], int] = {}
    for row, column, kind, (sign, node, *turned) in demands:
        for k, value in enumerate(_laid(scalariser.entries(node), kind, bool(turned and turned[0]))):
            i, j = {"scalar": (0, 0), "row": (0, k), "column": (k, 0), "matrix": divmod(k, 3)}[kind]
            entries[row + i, column + j] = scalariser.signed(sign, value)
    pattern = Sparsity.of_entries(*output.shape, entries)
    return Output(output.name, pattern, tuple(entries[place] for place in pattern.entries()))


def _laid(entries: Entries, kind: str, turned: bool) -> Entries:
    if kind == "matrix" and turned:
        return tuple(entries[3 * (k % 3) + k // 3] for k in range(9))
    return entries
