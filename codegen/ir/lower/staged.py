"""Lower scalar expressions (sympy) that are derived in named stages: chains and platforms.

Where `lower` chooses among ways to evaluate vectors, this takes every entry as it is written, stage after stage.
Input: matrices of expressions. Output: a `Program` that is not simplified.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

import sympy

from codegen.errors import InternalError
from codegen.ir.builder import Builder
from codegen.ir.ops import Constant, Op
from codegen.ir.program import Argument, Output, Program, Sparsity


class Select(sympy.Function):
    """``Select(a, b, x, y)``: ``x`` where ``a < b``, ``y`` elsewhere; sympy leaves it as it is."""

    nargs = 4


_FUNCTIONS: dict[Any, Op] = {
    sympy.sin: Op.SIN,
    sympy.cos: Op.COS,
    sympy.atan2: Op.ATAN2,
    sympy.Abs: Op.ABS,
    Select: Op.SELECT,
}


class Stages:
    """A symbolic model under construction: arguments, then stages, then outputs.

    Args:
        is_paired: whether the terms of a sum are added in pairs, and these in pairs, so that few wait for others.
    """

    def __init__(self, is_paired: bool = False) -> None:
        self._is_paired = is_paired
        self._builder = Builder()
        self._builder.constant(0)
        self._values: dict[Any, int] = {sympy.pi: self._builder.constant(Constant(Fraction(1), 1))}
        self._arguments: list[Argument] = []
        self._outputs: list[Output] = []
        self._legend: dict[str, str] = {}

    def argument(self, name: str, rows: int, columns: int = 1) -> sympy.Matrix:
        """Declare an array of the signature.

        Args:
            name: as in the C signature.
            rows: of the array.
            columns: of the array, which is column-major.

        Returns:
            ``[rows, columns]`` symbols for its entries.
        """
        self._arguments.append(Argument(name, (rows, columns)))
        return sympy.Matrix(rows, columns, lambda i, j: self._input(name, rows * int(j) + int(i)))

    def stage(self, name: str, value: sympy.MatrixBase, definition: str) -> sympy.Matrix:
        """Name a matrix, so that it is evaluated once and read as symbols.

        Args:
            name: for readers of the emitted code.
            value: entries are expressions in symbols of arguments and of stages before this one.
            definition: in the notation of the papers.

        Returns:
            Symbols in the place of entries; constants and plus or minus single symbols stay as they are.

        Raises:
            InternalError: the name is taken.
        """
        if name in self._legend:
            raise InternalError(f"two stages have the name {name}")
        self._legend[name] = definition
        entries = [self._named(name, k, entry) for k, entry in enumerate(value.T)]
        return sympy.Matrix(value.cols, value.rows, entries).T

    def output(self, name: str, value: sympy.MatrixBase) -> None:
        """Add an output; entries that are identically zero leave its pattern when the program is simplified."""
        places = [(row, column) for column in range(value.cols) for row in range(value.rows)]
        values = tuple(self._value(value[place]) for place in places)
        self._outputs.append(Output(name, Sparsity.of_entries(value.rows, value.cols, places), values))

    def program(self) -> Program:
        """The program of all outputs, in the order in which they were added."""
        return self._builder.freeze(tuple(self._arguments), tuple(self._outputs), self._legend)

    def _input(self, name: str, index: int) -> sympy.Symbol:
        symbol = sympy.Symbol(f"{name}[{index}]", real=True)
        self._values[symbol] = self._builder.input(name, index)
        return symbol

    def _named(self, name: str, index: int, entry: Any) -> Any:
        if _is_plain(entry):
            return entry
        symbol = sympy.Symbol(f"{name}({index})", real=True)
        self._values[symbol] = self._value(entry)
        self._builder.label(self._values[symbol], (name, index))
        return symbol

    # --- expressions

    def _value(self, expression: Any) -> int:
        position = self._values.get(expression)
        if position is None:
            position = self._values[expression] = self._evaluated(sympy.sympify(expression))
        return position

    def _evaluated(self, expression: Any) -> int:
        if expression.is_Rational:
            return self._builder.constant(Fraction(int(expression.p), int(expression.q)))
        if expression.is_Add:
            return self._sum(expression.args)
        if expression.is_Mul:
            return self._product(expression)
        if expression.is_Pow:
            return self._power(*expression.args)
        if expression.func in _FUNCTIONS:
            return self._builder.emit(_FUNCTIONS[expression.func], *map(self._value, expression.args))
        raise InternalError(f"no operation for {expression}")

    def _sum(self, terms: Sequence[Any]) -> int:
        """Terms with a minus sign are subtracted, and come after one without."""
        if self._is_paired:
            return self._pairs(terms)
        ordered = sorted(terms, key=lambda term: bool(term.could_extract_minus_sign()))
        total = self._value(ordered[0])
        for term in ordered[1:]:
            negative = term.could_extract_minus_sign()
            operand = self._value(-term if negative else term)
            total = self._builder.emit(Op.SUBTRACT if negative else Op.ADD, total, operand)
        return total

    def _pairs(self, terms: Sequence[Any]) -> int:
        signed = [(bool(term.could_extract_minus_sign()), term) for term in terms]
        values = [(is_negative, self._value(-term if is_negative else term)) for is_negative, term in signed]
        while len(values) > 1:
            found = [self._pair(*values[k : k + 2]) for k in range(0, len(values) - 1, 2)]
            values = found + values[2 * len(found) :]
        ((is_negative, total),) = values
        return self._builder.emit(Op.NEGATE, total) if is_negative else total

    def _pair(self, first: tuple[bool, int], second: tuple[bool, int]) -> tuple[bool, int]:
        """The sum of two values with signs: whether its sign is minus, and its value."""
        if first[0] == second[0]:
            return first[0], self._builder.emit(Op.ADD, first[1], second[1])
        positive, negative = (second, first) if first[0] else (first, second)
        return False, self._builder.emit(Op.SUBTRACT, positive[1], negative[1])

    def _product(self, expression: Any) -> int:
        if expression.could_extract_minus_sign():
            return self._builder.emit(Op.NEGATE, self._value(-expression))
        if any(factor.is_Pow for factor in expression.args):
            numerator, denominator = expression.as_numer_denom()
            if denominator != 1 and not denominator.is_Rational:
                return self._builder.emit(Op.DIVIDE, self._value(numerator), self._value(denominator))
        return self._multiplied([self._value(factor) for factor in expression.args])

    def _multiplied(self, factors: Sequence[int]) -> int:
        product = factors[0]
        for factor in factors[1:]:
            product = self._builder.emit(Op.MULTIPLY, product, factor)
        return product

    def _power(self, base: Any, exponent: Any) -> int:
        if not (2 * exponent).is_Integer:
            raise InternalError(f"no operation for the power {exponent}")
        if exponent < 0:
            return self._builder.emit(Op.DIVIDE, self._builder.constant(1), self._value(base**-exponent))
        root = [self._builder.emit(Op.SQRT, self._value(base))] if not exponent.is_Integer else []
        whole = int(exponent)
        if whole > 1 and whole % 2 == 0 and not root:
            half = self._value(base ** (whole // 2))
            return self._builder.emit(Op.MULTIPLY, half, half)
        return self._multiplied([self._value(base)] * whole + root)


def _is_plain(entry: Any) -> bool:
    return bool(entry.is_Symbol or entry.is_number or (entry.is_Mul and (-entry).is_Symbol))
