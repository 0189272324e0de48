"""Read the matrix expressions of the symbolic model free of frames.

Rotations only say in which frame a vector is written, so they drop out: ``A_ij h_j`` is h_j, ``A_i s_i~`` is s_i~
between the world and body i. What is left are vectors, their products, and scalars.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import product
from typing import Any

import sympy
from sympy.matrices.matrixbase import MatrixBase

from codegen.errors import InternalError
from codegen.ir.lower.factors import Factors, Symbols, is_power, transposed_factor
from codegen.ir.lower.frames import Components
from codegen.ir.lower.operators import Dot, Tilde
from codegen.ir.lower.places import stand_in
from codegen.ir.lower.polynomial import ONE, ZERO, Polynomial, number
from codegen.ir.lower.quantities import Axis, Dyadic, Given, Named, Vector, combined
from codegen.ir.lower.space import Space

Definitions = dict[str, tuple[str, tuple[Polynomial, ...]]]
"""Stage scalar -> function and arguments."""


class Reader:
    """Reads expressions into a space.

    Args:
        space: where vectors and scalars are numbered.
        symbols: what the symbols are.

    Attributes:
        given: components of vectors that an expression writes out, by frame and name.
        definitions: scalars that are no polynomials: quotients, sines, arc tangents.
        factors: what rotations among the factors of a product say of frames.
        raw: whether scalar products are taken with the rotation matrices as they are.
    """

    def __init__(self, space: Space, symbols: Symbols) -> None:
        self.space = space
        self.given: dict[tuple[str, str], Components] = {}
        self.definitions: Definitions = {}
        self.raw = False
        self.factors = Factors(symbols)
        self._symbols = symbols
        self._vectors: dict[Any, Vector] = {}

    # --- vectors

    def vector(self, expression: Any, frame: str | None = None) -> Vector:
        """Read a [3] expression whose components are in ``frame``, or in the frame that its factors say."""
        frame = frame or self.factors.frame_of(expression)
        if isinstance(expression, sympy.MatAdd):
            return combined((ONE, self.vector(term, frame)) for term in expression.args)
        if isinstance(expression, sympy.MatMul):
            coefficient, factors = expression.as_coeff_matrices()
            return self._chain(tuple(factors), frame).times(self.scalar(coefficient))
        if isinstance(expression, sympy.MatrixSymbol):
            return self._symbol(expression)
        if isinstance(expression, sympy.ZeroMatrix):
            return Vector({})
        if isinstance(expression, MatrixBase):
            return self._explicit(list(expression), frame)
        return self._chain((expression,), frame)

    def _symbol(self, symbol: Any) -> Vector:
        if symbol not in self._vectors:
            if symbol in self._symbols.stages:
                self._vectors[symbol] = self._of_stage(symbol)
            elif symbol in self._symbols.constants:
                self._vectors[symbol] = self._known(symbol)
            else:
                self._vectors[symbol] = self.space.vector(Given(self._symbols.frames[symbol], symbol.name))
        return self._vectors[symbol]

    def _known(self, symbol: Any) -> Vector:
        """A vector of numbers or scalar symbols; a sum of axes where all are numbers, or where there is one only."""
        frame = self._symbols.frames[symbol]
        values = [self.scalar(entry) for entry in self._symbols.constants[symbol]]
        if all(value.constant is not None for value in values) or sum(map(bool, values)) == 1:
            return combined((value, self._axis(frame, k)) for k, value in enumerate(values))
        self.given[frame, symbol.name] = tuple(values)
        return self.space.vector(Given(frame, symbol.name))

    def _of_stage(self, symbol: Any) -> Vector:
        definition = self.vector(self._symbols.stages[symbol])
        if symbol not in self._symbols.whole or len(definition.terms) < 2:
            return definition
        self.space.named[symbol.name] = definition
        return self.space.vector(Named(symbol.name))

    def _chain(self, factors: Sequence[Any], frame: str | None) -> Vector:
        if not factors:
            raise InternalError("a product of no factors is no vector")
        first, rest = factors[0], factors[1:]
        if not rest:
            return self.vector(first, frame)
        if isinstance(first, Tilde):
            frame = frame or self.factors.frame_of(sympy.MatMul(*factors))
            return self.space.cross(self.vector(first.vector, frame), self._chain(rest, frame))
        if self.factors.turn(first) is not None:
            return self._chain(rest, self.factors.turn(first)[1])  # type: ignore[index]
        if first.shape[1] == 1:
            raise InternalError("a column inside a product that is a vector")
        inner = self.factors.frame_within(rest, frame)
        return self.space.apply(self.map(first, frame, inner), self._chain(rest, inner))

    def _explicit(self, entries: list[Any], frame: str | None) -> Vector:
        if frame is None:
            raise InternalError(f"in which frame are {entries}?")
        values = [self.scalar(entry) for entry in entries]
        axes = [self._axis(frame, k) for k in range(3)]
        if frame in self._symbols.axes or all(value.constant is not None for value in values):
            return combined(zip(values, axes, strict=True))
        sign = next(value.sign for value in values if value)
        components = tuple(value if sign > 0 else -value for value in values)
        name = next((n for (f, n), known in self.given.items() if f == frame and known == components), None)
        if name is None:
            name = self._name_of(components)
            self.given[frame, name] = components
        vector = self.space.vector(Given(frame, name))
        return vector if sign > 0 else -vector

    def _axis(self, frame: str, k: int) -> Vector:
        """An axis of a frame, or what stands for it."""
        sign, frame, k = stand_in(self._symbols.same_axes, frame, k)
        axis = self.space.vector(Axis(frame, k))
        return axis if sign > 0 else -axis

    def _name_of(self, components: Sequence[Polynomial]) -> str:
        """Name a written-out vector after its components: ``lambda_0_1_2``."""
        terms = [term for component in components for term in component.terms if len(component.terms) == 1]
        atoms = [self.space.atoms[m[0]].key[0] for m, factor in terms if len(m) == 1 and factor == 1]
        prefixes = {str(atom).rpartition("_")[0] for atom in atoms}
        if len(atoms) == 3 and len(prefixes) == 1 and min(prefixes):
            return "_".join([*prefixes, *(str(atom).rpartition("_")[2] for atom in atoms)])
        return f"vector_{len(self.given)}"

    # --- maps

    def map(self, expression: Any, rows: str | None, columns: str | None) -> Dyadic:
        """Read a [3, 3] expression between two frames."""
        if isinstance(expression, sympy.MatAdd):
            result = Dyadic({})
            for term in expression.args:
                result += self.map(term, rows, columns)
            return result
        if isinstance(expression, sympy.MatMul):
            coefficient, factors = expression.as_coeff_matrices()
            return self._map_chain(tuple(factors), rows, columns).times(self.scalar(coefficient))
        if self.factors.turn(expression) is not None or isinstance(expression, sympy.Identity):
            return Dyadic({}, ONE)
        if isinstance(expression, sympy.Transpose):
            return self.map(expression.arg, columns, rows).transposed
        if expression in self._symbols.stages:
            return self.map(self._symbols.stages[expression], rows, columns)
        if isinstance(expression, Tilde):
            return self.space.tilde(self.vector(expression.vector, rows or columns))
        if isinstance(expression, sympy.ZeroMatrix):
            return Dyadic({})
        if isinstance(expression, MatrixBase):
            return self._explicit_map(expression, rows or columns, columns or rows)
        raise InternalError(f"no reading of {type(expression).__name__}")

    def _explicit_map(self, matrix: Any, rows: str | None, columns: str | None) -> Dyadic:
        if rows is None or columns is None:
            raise InternalError("in which frame is an explicit matrix?")
        if rows == columns and (matrix + matrix.T).is_zero_matrix:
            return self.space.tilde(self._explicit([matrix[2, 1], matrix[0, 2], matrix[1, 0]], rows))
        result = Dyadic({})
        for k, n in product(range(3), repeat=2):
            outer = self.space.outer(self._axis(rows, k), self._axis(columns, n))
            result += outer.times(self.scalar(matrix[k, n]))
        return result

    def _map_chain(self, factors: Sequence[Any], rows: str | None, columns: str | None) -> Dyadic:
        for k, factor in enumerate(factors[:-1]):
            if factor.shape[1] == 1:
                right = sympy.MatMul(*(transposed_factor(f) for f in reversed(factors[k + 1 :])))
                left = factors[: k + 1]
                return self.space.outer(self._chain(left, rows), self.vector(right, columns))
        result = Dyadic({}, ONE)
        frame = rows
        for k, factor in enumerate(factors):
            turn = self.factors.turn(factor)
            if turn is not None:
                frame = turn[1]
            else:
                frame = frame or self.factors.frame_of(factor)
                inner = self.factors.frame_within(factors[k + 1 :], frame)
                result = self.space.compose(result, self.map(factor, frame, inner))
                frame = inner
        return result

    # --- scalars

    def scalar(self, expression: Any) -> Polynomial:
        """Read a scalar expression."""
        if isinstance(expression, sympy.Rational):
            return number(Fraction(int(expression.p), int(expression.q)))
        if isinstance(expression, Dot):
            return self._dot(*expression.args)
        if isinstance(expression, sympy.Add):
            return self._sum([self.scalar(term) for term in expression.args])
        if isinstance(expression, sympy.Mul):
            return self._product(expression)
        if isinstance(expression, sympy.Symbol) and expression in self._symbols.stages:
            return self._stage(expression)
        if isinstance(expression, sympy.Symbol) or expression is sympy.pi:
            return self.space.scalar("symbol", str(expression))
        return self._function(expression)

    def _dot(self, left: Any, right: Any) -> Polynomial:
        frame = self.factors.frame_of(left) or self.factors.frame_of(right)
        u, w = self.vector(left, frame), self.vector(right, frame)
        return self.space.raw_dot(u, w) if self.raw else self.space.dot(u, w)

    def _sum(self, parts: list[Polynomial]) -> Polynomial:
        result = ZERO
        for part in parts:
            result += part
        hints = self.space.sum_hints.setdefault(result, [])
        if len(parts) > 1 and tuple(parts) not in hints:
            hints.append(tuple(parts))
        return result

    def _product(self, expression: Any) -> Polynomial:
        dots = [factor for factor in expression.args if isinstance(factor, Dot)]
        others = ONE
        for factor in expression.args:
            if not isinstance(factor, Dot):
                others *= self.scalar(factor)
        result = others
        for dot in dots:
            value = self.scalar(dot)
            hints = self.space.product_hints.setdefault(result * value, [])
            if (result, value) not in hints and result.constant not in (1, -1):
                hints.append((result, value))
            result *= value
        return result

    def _stage(self, symbol: Any) -> Polynomial:
        definition = self._symbols.stages[symbol]
        if isinstance(definition, sympy.Pow | sympy.Function) and not is_power(definition):
            return self._named(symbol.name, definition)
        if symbol not in self._symbols.whole:
            return self.scalar(definition)
        if symbol.name not in self.definitions:
            self.definitions[symbol.name] = ("same", (self.scalar(definition),))
        return self.space.scalar("stage", symbol.name)

    def _function(self, expression: Any) -> Polynomial:
        if is_power(expression):
            base, result = self.scalar(expression.base), ONE
            for _ in range(int(expression.exp)):
                result *= base
            return result
        return self._named(str(expression), expression)

    def _named(self, name: str, expression: Any) -> Polynomial:
        """A scalar that is no polynomial, under a name."""
        if name not in self.definitions:
            if isinstance(expression, sympy.Pow):
                self.definitions[name] = self._power(expression.exp, self.scalar(expression.base))
            else:
                arguments = tuple(self.scalar(argument) for argument in expression.args)
                self.definitions[name] = (type(expression).__name__, arguments)
        return self.space.scalar("stage", name)

    def _power(self, exponent: Any, base: Polynomial) -> tuple[str, tuple[Polynomial, ...]]:
        if exponent == -1:
            return "ratio", (ONE, base)
        if exponent == sympy.Rational(1, 2):
            return "sqrt", (base,)
        raise InternalError(f"no reading of exponent {exponent}")
