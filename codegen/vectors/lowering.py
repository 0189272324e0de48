"""Lower symbolic outputs to a scalar program by way of vectors: read, lay out, search, write."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy

from codegen.ir.builder import Builder
from codegen.ir.lower.lowering import Block, SymbolicOutput
from codegen.ir.ops import Constant
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.vectors.frames import Components, FrameTree, Matrix
from codegen.vectors.layout import Layout
from codegen.vectors.nodes import Prices
from codegen.vectors.polynomial import Polynomial
from codegen.vectors.read import Reader, Symbols, is_matrix
from codegen.vectors.scalarise import Entries, Scalariser
from codegen.vectors.search import cheapest
from codegen.vectors.space import Axis, Space, Vector


@dataclass(frozen=True)
class Places:
    """Where the symbols of a model live.

    Attributes:
        rotations: rotation symbol -> (a, b): it turns components in frame b to components in frame a.
        given: rotations whose matrices are known; others are products.
        explicit: given rotations that are written out, not arguments.
        frames: vector symbol -> frame.
        stages: symbol -> definition.
        bodies: frame -> body, the outermost frame first.
        axes: frames whose axes have names.
        columns: first column and frame of each virtual displacement that is a vector.
        rows: first row and frame of each vector among the rows of the constraint.
        axis_names: frame -> names of its axes.
        vector_names: stage symbol -> name.
        whole: stages that are vectors of their own, not the sums that define them.
        is_raw: whether ``phi`` takes the rotation matrices as they are, orthonormal or not.
    """

    rotations: Mapping[Any, tuple[str, str]]
    given: tuple[Any, ...]
    explicit: Mapping[Any, Any]
    frames: Mapping[Any, str]
    stages: Mapping[Any, Any]
    bodies: Mapping[str, str]
    axes: frozenset[str]
    columns: tuple[tuple[int, str], ...]
    rows: Mapping[int, str]
    axis_names: Mapping[str, tuple[str, ...]]
    vector_names: Mapping[Any, str]
    whole: frozenset[Any] = frozenset()
    is_raw: bool = False


Demand = tuple[int, int, str, Any]
"""Row, column, how its entries lie (``scalar``, ``row``, ``column``, ``matrix``) and what `Layout` gave."""


class Session:
    """The vector level of one model in one set of frames: reads outputs, searches, and writes them to a builder."""

    def __init__(self, places: Places, inputs: Mapping[Any, tuple[str, int]], prices: Prices) -> None:
        self._places = places
        self._inputs = inputs
        self.reader = Reader(
            Space(self._relation),
            Symbols(places.rotations, places.frames, places.stages, places.axes, places.whole),
        )
        self._tree_rotations: dict[tuple[str, str], Matrix] = {}
        for symbol in places.given:
            self._tree_rotations[places.rotations[symbol]] = self._matrix(symbol)
        for symbol, frame in places.frames.items():
            name, offset = inputs[symbol]
            self.reader.given[frame, symbol.name] = tuple((name, offset + k) for k in range(3))
        self.tree = FrameTree(self._tree_rotations, self.reader.given, places.bodies)
        self.layout = Layout(self.reader.space, self.tree, self.reader.definitions, prices, places.axes)

    def _matrix(self, symbol: Any) -> Matrix:
        if symbol in self._places.explicit:
            matrix = self._places.explicit[symbol]
            return tuple(tuple(self._entry(symbol, matrix, i, k) for i in range(3)) for k in range(3))
        name, offset = self._inputs[symbol]
        return tuple(tuple((name, offset + i + 3 * k) for i in range(3)) for k in range(3))

    def _entry(self, symbol: Any, matrix: Any, i: int, k: int) -> Polynomial:
        """An entry of a written-out rotation; one that takes arithmetic has a name of its own."""
        value = self.reader.scalar(matrix[i, k])
        if len(value.terms) <= 1 and all(len(monomial) <= 1 for monomial, _ in value.terms):
            return value
        name = f"{symbol.name}_{i}{k}"
        self.reader.definitions[name] = ("same", (value,))
        return self.reader.space.scalar("stage", name)

    def _relation(self, left: Axis, right: Axis) -> Polynomial | None:
        """Entries of a written-out rotation are scalar products of axes."""
        for symbol in self._places.explicit:
            a, b = self._places.rotations[symbol]
            for first, second in ((left, right), (right, left)):
                if (first.frame, second.frame) == (a, b):
                    entry = self._tree_rotations[a, b][second.k][first.k]
                    return entry if isinstance(entry, Polynomial) else None
        return None

    # --- demands

    def demands(self, output: SymbolicOutput) -> list[Demand]:
        """Read an output and say which nodes it takes."""
        self.reader.raw = self._places.is_raw and output.name == "phi"
        by_displacement = output.name in ("phi_q_t_lambda_q", "phi_q_t_lambda")
        columns = dict(self._places.columns)
        rows = columns if by_displacement else self._places.rows
        return [demand for block in output.blocks for demand in self._demand(block, rows, columns, output.shape[1])]

    def _demand(
        self, block: Block, rows: Mapping[int, str], columns: Mapping[int, str], width: int
    ) -> list[Demand]:
        expression, place = block.expression, (block.row, block.column)
        if not is_matrix(expression):
            value = self.reader.scalar(expression)
            return [(*place, "scalar", self.layout.scalar(value))] if value else []
        if expression.shape == (1, 3):
            vector = self.reader.vector(_transposed(expression), columns[block.column])
            return [(*place, "row", self.layout.vector(vector, columns[block.column]))] if vector else []
        if expression.shape == (3, 1):
            vector = self.reader.vector(expression, rows[block.row])
            place_vector = self._raw_vector if self.reader.raw else self.layout.vector
            return [(*place, "column", place_vector(vector, rows[block.row]))] if vector else []
        dyadic = self.reader.map(expression, rows[block.row], columns[block.column])
        if not dyadic:
            return []
        return [(*place, "matrix", self.layout.block(dyadic, rows[block.row], columns[block.column]))]

    def _raw_vector(self, vector: Vector, frame: str) -> tuple[int, int]:
        outermost = self.tree.frames[0]
        return self.layout.pushed(vector, frame) if frame == outermost else self.layout.pulled(vector, frame)


def _transposed(expression: Any) -> Any:
    return expression.arg if isinstance(expression, sympy.Transpose) else expression.T


def lower_vectors(
    arguments: tuple[Argument, ...],
    inputs: Mapping[Any, tuple[str, int]],
    parts: list[tuple[Places, tuple[SymbolicOutput, ...]]],
    prices: Prices | None = None,
) -> Program:
    """Lower outputs to one program, each group of them in its own frames.

    Args:
        arguments: the arrays of the signature, in order.
        inputs: symbol -> argument and offset of its first entry (column-major).
        parts: frames, and the outputs that are written in them.
        prices: of operations; one each if left out.

    Returns:
        The program, outputs dense, not simplified.
    """
    builder = Builder()
    places = {symbol.name: place for symbol, place in inputs.items() if isinstance(symbol, sympy.Symbol)}

    def read(name: str) -> int:
        from fractions import Fraction

        return builder.constant(Constant(Fraction(1), 1)) if name == "pi" else builder.input(*places[name])

    results: dict[str, Output] = {}
    order = [output.name for _, outputs in parts for output in outputs]
    for described, outputs in parts:
        session = Session(described, inputs, prices or Prices())
        demands = {output.name: session.demands(output) for output in outputs}
        graph = session.layout.lay_out()
        nodes = list(dict.fromkeys(demand[3][1] for found in demands.values() for demand in found))
        choice = cheapest(graph, nodes)
        scalariser = Scalariser(graph, choice, builder, read, lambda node, entries: None)
        for output in outputs:
            results[output.name] = _written(output, demands[output.name], scalariser, builder)
    return builder.freeze(arguments, tuple(results[name] for name in order), {})


def _written(output: SymbolicOutput, demands: list[Demand], scalariser: Scalariser, builder: Builder) -> Output:
    nrow, ncol = output.shape
    zero = builder.constant(0)
    entries = [[zero] * ncol for _ in range(nrow)]
    for row, column, kind, (sign, node, *turned) in demands:
        for k, value in enumerate(_laid(scalariser.entries(node), kind, bool(turned and turned[0]))):
            i, j = {"scalar": (0, 0), "row": (0, k), "column": (k, 0), "matrix": divmod(k, 3)}[kind]
            entries[row + i][column + j] = scalariser.signed(sign, value)
    everything = [(row, column) for row in range(nrow) for column in range(ncol)]
    values = tuple(entries[row][column] for column in range(ncol) for row in range(nrow))
    return Output(output.name, Sparsity.of_entries(nrow, ncol, everything), values)


def _laid(entries: Entries, kind: str, turned: bool) -> Entries:
    if kind == "matrix" and turned:
        return tuple(entries[3 * (k % 3) + k // 3] for k in range(9))
    return entries


__all__ = ["Components", "Places", "lower_vectors"]
