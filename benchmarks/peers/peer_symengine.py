"""SymEngine: its own derivatives, `cse` and C printer; integer powers written out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import symengine

from benchmarks.peers.linear import Matrix, Vector
from benchmarks.peers.source import Source, c_function, integer_powers
from benchmarks.peers.symbolic import FORMS, outputs
from benchmarks.peers.work import Work

NAME = "symengine"
PACKAGE = "symengine"
__all__ = ["FORMS", "NAME", "PACKAGE", "write"]


class SymengineAlgebra:
    """Scalars are `symengine.Expr`."""

    def vector(self, name: str, length: int) -> Vector:
        """Symbols that print as array entries."""
        return [symengine.Symbol(f"{name}[{k}]") for k in range(length)]

    def atan2(self, y: Any, x: Any) -> Any:
        """Angle of (x, y)."""
        return symengine.atan2(y, x)

    def jacobian(self, values: Sequence[Any], symbols: Vector) -> Matrix:
        """Derivatives by `symengine.diff`."""
        return [[symengine.diff(symengine.sympify(value), symbol) for symbol in symbols] for value in values]

    def gradient(self, value: Any, symbols: Vector) -> Vector:
        """Derivatives by `symengine.diff`."""
        return self.jacobian([value], symbols)[0]

    def at_zero(self, values: Sequence[Any], symbols: Vector) -> Vector:
        """Zeros put in; sums and products evaluate themselves."""
        zeros = dict.fromkeys(symbols, symengine.Integer(0))
        return [symengine.sympify(value).subs(zeros) for value in values]


def write(work: Work, form: str, symbol: str) -> Source:
    """Generate the routine."""
    _, stored = outputs(SymengineAlgebra(), work, form)
    targets = [f"{name}[{k}]" for name, values in stored.items() for k in range(len(values))]
    expressions = [symengine.sympify(value) for values in stored.values() for value in values]
    replacements, reduced = symengine.cse(expressions)
    statements = [f"const double {name} = {symengine.ccode(value)};" for name, value in replacements]
    statements += [f"{target} = {symengine.ccode(value)};" for target, value in zip(targets, reduced, strict=True)]
    return c_function(work, symbol, [integer_powers(statement) for statement in statements])
