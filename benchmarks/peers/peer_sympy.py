"""SymPy: `cse` and the C99 printer; integer powers written out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy
from sympy.codegen.rewriting import create_expand_pow_optimization

from benchmarks.peers.linear import Matrix, Vector
from benchmarks.peers.source import Source, c_function, integer_powers
from benchmarks.peers.symbolic import FORMS, outputs
from benchmarks.peers.work import Work

NAME = "sympy"
PACKAGE = "sympy"
__all__ = ["FORMS", "NAME", "PACKAGE", "write"]


class SympyAlgebra:
    """Scalars are `sympy.Expr`."""

    def vector(self, name: str, length: int) -> Vector:
        """Real symbols that print as array entries."""
        return [sympy.Symbol(f"{name}[{k}]", real=True) for k in range(length)]

    def atan2(self, y: Any, x: Any) -> Any:
        """Angle of (x, y)."""
        return sympy.atan2(y, x)

    def jacobian(self, values: Sequence[Any], symbols: Vector) -> Matrix:
        """Derivatives by `sympy.diff`."""
        return [[sympy.diff(value, symbol) for symbol in symbols] for value in values]

    def gradient(self, value: Any, symbols: Vector) -> Vector:
        """Derivatives by `sympy.diff`."""
        return self.jacobian([value], symbols)[0]

    def at_zero(self, values: Sequence[Any], symbols: Vector) -> Vector:
        """Zeros put in; sums and products evaluate themselves."""
        zeros = {symbol: sympy.Integer(0) for symbol in symbols}
        return [sympy.sympify(value).xreplace(zeros) for value in values]


def write(work: Work, form: str, symbol: str) -> Source:
    """Generate the routine."""
    _, stored = outputs(SympyAlgebra(), work, form)
    targets = [f"{name}[{k}]" for name, values in stored.items() for k in range(len(values))]
    expressions = [sympy.sympify(value) for values in stored.values() for value in values]
    temporaries = sympy.numbered_symbols("t")
    replacements, reduced = sympy.cse(expressions, symbols=temporaries)
    expand = create_expand_pow_optimization(4)
    statements = [f"const double {name} = {sympy.ccode(expand(value))};" for name, value in replacements]
    statements += [f"{target} = {sympy.ccode(expand(value))};" for target, value in zip(targets, reduced, strict=True)]
    return c_function(work, symbol, [integer_powers(statement) for statement in statements])
