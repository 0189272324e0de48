"""What the outputs of a model demand of the vector level."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy

from codegen.errors import InternalError
from codegen.ir.lower.alternatives import Prices
from codegen.ir.lower.factors import Symbols, is_matrix, transposed_factor
from codegen.ir.lower.frames import FrameTree, Matrix
from codegen.ir.lower.layout import Layout
from codegen.ir.lower.naming import Naming
from codegen.ir.lower.outputs import Block, SymbolicOutput
from codegen.ir.lower.places import Places, stand_in
from codegen.ir.lower.polynomial import ZERO, Polynomial
from codegen.ir.lower.quantities import Axis, Given, Vector
from codegen.ir.lower.read import Reader
from codegen.ir.lower.space import Space

Demand = tuple[int, int, str, Any]
"""Row, column, how its entries lie (``scalar``, ``row``, ``column``, ``matrix``) and what `Layout` gave."""

BY_DISPLACEMENT = frozenset({"phi_q_t_lambda_q", "phi_q_t_lambda", "force", "force_q", "force_v"})
"""Outputs whose rows are displacements, not constraints."""


class Demands:
    """Reads the outputs of one model in one set of frames, and says which nodes they take.

    Args:
        places: the frames.
        inputs: symbol -> argument and offset of its first entry (column-major).
        prices: of operations.

    Attributes:
        layout: the graph of the nodes.
        naming: of its nodes.
    """

    def __init__(self, places: Places, inputs: Mapping[Any, tuple[str, int]], prices: Prices) -> None:
        self._places = places
        self._inputs = inputs
        self._reader = Reader(
            Space(self._relation),
            Symbols(
                places.rotations,
                places.frames,
                places.stages,
                places.axes,
                places.whole,
                places.constants,
                places.same_axes,
            ),
        )
        self._tree_rotations: dict[tuple[str, str], Matrix] = {}
        for symbol in places.given:
            self._tree_rotations[places.rotations[symbol]] = self._matrix(symbol)
        for symbol, frame in places.frames.items():
            if symbol in places.constants:
                continue
            name, offset = inputs[symbol]
            self._reader.given[frame, symbol.name] = tuple((name, offset + k) for k in range(3))
        tree = FrameTree(self._tree_rotations, self._reader.given, places.bodies, places.near)
        self.layout = Layout(self._reader.space, tree, self._reader.definitions, prices, places.axes)
        names = {self._reader.vector(symbol): name for symbol, name in places.vector_names.items()}
        self.naming = Naming(self._reader.space, places.axis_names, names)

    def _matrix(self, symbol: Any) -> Matrix:
        if symbol in self._places.explicit:
            matrix = self._places.explicit[symbol]
            return tuple(tuple(self._entry(symbol, matrix, i, k) for i in range(3)) for k in range(3))
        name, offset = self._inputs[symbol]
        return tuple(tuple((name, offset + i + 3 * k) for i in range(3)) for k in range(3))

    def _entry(self, symbol: Any, matrix: Any, i: int, k: int) -> Polynomial:
        """An entry of a written-out rotation; one that takes arithmetic has a name of its own."""
        value = self._reader.scalar(matrix[i, k])
        if len(value.terms) <= 1 and all(len(monomial) <= 1 for monomial, _ in value.terms):
            return value
        name = f"{symbol.name}_{i}{k}"
        self._reader.definitions[name] = ("same", (value,))
        return self._reader.space.scalar("stage", name)

    def _relation(self, left: Axis | Given, right: Axis | Given) -> Polynomial | None:
        """Entries of a written-out rotation are scalar products of axes; a given component may be zero."""
        if isinstance(left, Given) or isinstance(right, Given):
            found = self._zero_component(left, right)
            return self._zero_component(right, left) if found is None else found
        for symbol in self._places.explicit:
            a, b = self._places.rotations[symbol]
            for first, second in ((left, right), (right, left)):
                if (first.frame, second.frame) == (a, b):
                    entry = self._tree_rotations[a, b][second.k][first.k]
                    return entry if isinstance(entry, Polynomial) else None
        return ZERO if self._is_across(left, right) or self._is_across(right, left) else None

    def _is_across(self, axis: Axis, other: Axis) -> bool:
        """Whether the other axis stands for one of the two that are perpendicular to this one."""
        same = self._places.same_axes
        stand_ins = (stand_in(same, axis.frame, k)[1:] for k in range(3) if k != axis.k)
        return (other.frame, other.k) in stand_ins

    def _zero_component(self, vector: Axis | Given, axis: Axis | Given) -> Polynomial | None:
        if not (isinstance(vector, Given) and isinstance(axis, Axis) and vector.frame == axis.frame):
            return None
        component = self._reader.given[vector.frame, vector.name][axis.k]
        return ZERO if component == ZERO else None

    # --- demands

    def of(self, output: SymbolicOutput) -> list[Demand]:
        """Read an output and say which nodes it takes."""
        self._reader.raw = self._places.is_raw and output.name == "phi"
        by_displacement = output.name in BY_DISPLACEMENT
        columns = dict(self._places.columns)
        rows: Mapping[int, str] = columns if by_displacement else self._places.rows
        return [demand for block in output.blocks for demand in self._demand(block, rows, columns, output.shape[1])]

    def _demand(self, block: Block, rows: Mapping[int, str], columns: Mapping[int, str], width: int) -> list[Demand]:
        expression, place = block.expression, (block.row, block.column)
        if not is_matrix(expression):
            value = self._reader.scalar(expression)
            return [(*place, "scalar", self.layout.scalar(value))] if value else []
        if expression.shape == (1, 3):
            vector = self._reader.vector(_transposed(expression), columns[block.column])
            return [(*place, "row", self.layout.vector(vector, columns[block.column]))] if vector else []
        if expression.shape == (3, 1):
            frame = rows.get(block.row) or self._reader.factors.frame_of(expression)
            if frame is None:
                raise InternalError(f"in which frame is {expression}?")
            if self._reader.raw:
                return [(*place, "column", self._raw_column(expression, frame))]
            vector = self._reader.vector(expression, frame)
            return [(*place, "column", self.layout.vector(vector, frame))] if vector else []
        if width > 3:
            row_frame, column_frame = rows.get(block.row), columns.get(block.column)
        else:
            row_frame, column_frame = (
                self._reader.factors.frame_of(expression),
                self._reader.factors.frame_of(_transposed(expression)),
            )
        if row_frame is None or column_frame is None:
            raise InternalError(f"between which frames is {expression}?")
        dyadic = self._reader.map(expression, row_frame, column_frame)
        return [(*place, "matrix", self.layout.block(dyadic, row_frame, column_frame))] if dyadic else []

    def _raw_column(self, expression: Any, frame: str) -> tuple[int, int]:
        """A vector of ``phi`` with raw matrices; what does not come through a stage is in its frame already."""
        terms = expression.args if isinstance(expression, sympy.MatAdd) else (expression,)
        through, plain = Vector({}), Vector({})
        for term in terms:
            vector = self._reader.vector(term, frame)
            if term.atoms(sympy.MatrixSymbol) & self._places.stages.keys():
                through += vector
            else:
                plain += vector
        if frame == self.layout.tree.frames[0]:
            return self.layout.pushed(through + plain, frame)
        return self.layout.offset(through, plain, frame) if plain else self.layout.pulled(through, frame)


def _transposed(expression: Any) -> Any:
    if isinstance(expression, sympy.Transpose):
        return expression.arg
    if isinstance(expression, sympy.MatMul):
        return sympy.MatMul(*(transposed_factor(factor) for factor in reversed(expression.as_coeff_matrices()[1])))
    if isinstance(expression, sympy.MatAdd):
        return sympy.MatAdd(*map(_transposed, expression.args))
    return transposed_factor(expression)
