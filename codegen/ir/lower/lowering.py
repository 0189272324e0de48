"""Lower staged matrix expressions to a scalar program.

Input: the symbols that are arguments, the named stages with their definitions, and for each output its blocks.
Output: a plain `Program`; simplification is left to the passes. Stage names survive as labels of the values they name.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy
from sympy.matrices.expressions.matexpr import MatrixExpr
from sympy.matrices.matrixbase import MatrixBase

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.lower.chain import Chains, Factors
from codegen.ir.lower.grid import Grid, add, multiply, skew, total, transpose
from codegen.ir.lower.nodes import Dot, Tilde
from codegen.ir.lower.notation import chain_notation, definition_notation, product_name
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Output, Program, Sparsity


@dataclass(frozen=True, slots=True)
class Block:
    """A part of an output: a scalar or matrix expression and the place of its first entry."""

    row: int
    column: int
    expression: Any


@dataclass(frozen=True, slots=True)
class SymbolicOutput:
    """An output matrix as blocks; blocks may not overlap, what no block covers is zero."""

    name: str
    shape: tuple[int, int]
    blocks: tuple[Block, ...]


def lower(
    arguments: tuple[Argument, ...],
    inputs: Mapping[Any, tuple[str, int]],
    stages: Mapping[Any, Any],
    outputs: tuple[SymbolicOutput, ...],
    aliases: Mapping[Factors, str] | None = None,
) -> Program:
    """Lower the outputs to one program.

    Args:
        arguments: the arrays of the signature, in order.
        inputs: symbol -> argument and offset of its first entry (column-major).
        stages: symbol -> its definition in terms of inputs and other stages.
        outputs: what to compute.
        aliases: names of products, for readers.

    Returns:
        The program, every output dense; `eliminate_zeros` and `compress` find the structural nonzeros.
    """
    lowering = _Lowering(inputs, stages, aliases or {})
    results = tuple(lowering.output(output) for output in outputs)
    return lowering.builder.freeze(arguments, results, lowering.legend)


class _Lowering:
    """State of one lowering: the builder and everything that has a value already."""

    def __init__(
        self, inputs: Mapping[Any, tuple[str, int]], stages: Mapping[Any, Any], aliases: Mapping[Factors, str]
    ) -> None:
        self.builder = Builder()
        self.legend: dict[str, str] = {}
        self._inputs = inputs
        self._stages = stages
        self._aliases = aliases
        self._matrices: dict[Any, Grid] = {}
        self._scalars: dict[Any, int] = {}
        self._chains = Chains(self.builder, {}, self._name_product)

    def output(self, output: SymbolicOutput) -> Output:
        """Lower one output, every entry of it."""
        zero = self.builder.constant(0)
        nrow, ncol = output.shape
        entries = [[zero] * ncol for _ in range(nrow)]
        for block in output.blocks:
            is_matrix = isinstance(block.expression, MatrixExpr | MatrixBase)
            grid = self.matrix(block.expression) if is_matrix else ((self.scalar(block.expression),),)
            for i, row in enumerate(grid):
                for j, entry in enumerate(row):
                    entries[block.row + i][block.column + j] = entry
        places = [(row, column) for row in range(nrow) for column in range(ncol)]
        values = tuple(entries[row][column] for column in range(ncol) for row in range(nrow))
        return Output(output.name, Sparsity.of_entries(nrow, ncol, places), values)

    def matrix(self, expression: Any) -> Grid:
        """Lower a matrix expression, or find the value it has already."""
        known = self._matrices.get(expression)
        if known is None:
            known = self._matrices[expression] = self._new_matrix(expression)
        return known

    def _new_matrix(self, expression: Any) -> Grid:
        if isinstance(expression, sympy.MatrixSymbol):
            return self._symbol(expression)
        if isinstance(expression, sympy.Transpose):
            return transpose(self.matrix(expression.arg))
        if isinstance(expression, Tilde):
            return skew(self.matrix(expression.vector), self.builder)
        if isinstance(expression, sympy.MatAdd):
            return add([self.matrix(term) for term in expression.args], self.builder)
        if isinstance(expression, sympy.MatMul):
            return self._product(expression)
        if isinstance(expression, sympy.Identity | sympy.ZeroMatrix):
            expression = expression.as_explicit()
        if isinstance(expression, MatrixBase):
            nrow, ncol = expression.shape
            return tuple(tuple(self.scalar(expression[i, j]) for j in range(ncol)) for i in range(nrow))
        raise InternalError(f"no lowering for {type(expression).__name__}")

    def _symbol(self, symbol: Any) -> Grid:
        nrow, ncol = (int(size) for size in symbol.shape)
        place = self._inputs.get(symbol)
        if place is not None:
            name, offset = place
            return tuple(
                tuple(self.builder.input(name, offset + i + nrow * j) for j in range(ncol)) for i in range(nrow)
            )
        grid = self.matrix(self._stages[symbol])
        self._name(symbol.name, definition_notation(symbol.name, self._stages[symbol], self._aliases), grid)
        return grid

    def _name(self, name: str, definition: str, grid: Grid) -> None:
        nrow = len(grid)
        self.legend.setdefault(name, definition)
        for i, row in enumerate(grid):
            for j, entry in enumerate(row):
                self.builder.label(entry, (name, i + nrow * j))

    def _product(self, expression: Any) -> Grid:
        coefficient, factors = expression.as_coeff_matrices()
        grids = [self.matrix(factor) for factor in factors]
        if coefficient == 1:
            return self._chains.product(tuple(factors), grids)
        return self._chains.scaled(coefficient, self.scalar(coefficient), tuple(factors), grids)

    def _name_product(self, factors: Factors, grid: Grid) -> None:
        """Label short products of plain symbols, as ``A_ij_h_j``, for readers."""
        name = product_name(factors, self._aliases)
        if name:
            others = {chain: alias for chain, alias in self._aliases.items() if alias != name}
            self._name(name, chain_notation(factors, others), grid)

    def scalar(self, expression: Any) -> int:
        """Lower a scalar expression, or find the value it has already."""
        known = self._scalars.get(expression)
        if known is None:
            known = self._scalars[expression] = self._new_scalar(expression)
        return known

    def _new_scalar(self, expression: Any) -> int:
        builder = self.builder
        if isinstance(expression, sympy.Rational):
            return builder.constant(Fraction(int(expression.p), int(expression.q)))
        if expression is sympy.pi:
            return builder.constant(Constant(Fraction(1), 1))
        if isinstance(expression, sympy.Symbol):
            return self._scalar_symbol(expression)
        if isinstance(expression, Dot):
            left, right = (self.matrix(side) for side in expression.args)
            return multiply(transpose(left), right, builder)[0][0]
        if isinstance(expression, sympy.Add):
            return total([self.scalar(term) for term in expression.args], builder)
        if isinstance(expression, sympy.Mul):
            return self._scalar_product(expression)
        if isinstance(expression, sympy.Pow):
            return self._power(expression)
        for function, op in ((sympy.sin, Op.SIN), (sympy.cos, Op.COS), (sympy.atan2, Op.ATAN2)):
            if isinstance(expression, function):
                return builder.emit(op, *(self.scalar(argument) for argument in expression.args))
        raise InternalError(f"no lowering for {type(expression).__name__}")

    def _scalar_symbol(self, symbol: Any) -> int:
        place = self._inputs.get(symbol)
        if place is not None:
            return self.builder.input(*place)
        value = self.scalar(self._stages[symbol])
        self._name(symbol.name, definition_notation(symbol.name, self._stages[symbol], self._aliases), ((value,),))
        return value

    def _scalar_product(self, expression: Any) -> int:
        """Product from the left; a sign is taken out so that it costs nothing."""
        coefficient, rest = expression.as_coeff_Mul()
        if coefficient == -1:
            return self.builder.emit(Op.NEGATE, self.scalar(rest))
        values = [self.scalar(factor) for factor in expression.args]
        result = values[0]
        for value in values[1:]:
            result = self.builder.emit(Op.MULTIPLY, result, value)
        return result

    def _power(self, expression: Any) -> int:
        base, exponent = self.scalar(expression.base), expression.exp
        if exponent == sympy.Rational(1, 2):
            return self.builder.emit(Op.SQRT, base)
        if not exponent.is_Integer or exponent == 0:
            raise InternalError(f"no lowering for exponent {exponent}")
        result = base
        for _ in range(abs(int(exponent)) - 1):
            result = self.builder.emit(Op.MULTIPLY, result, base)
        return self.builder.emit(Op.DIVIDE, self.builder.constant(1), result) if exponent < 0 else result
