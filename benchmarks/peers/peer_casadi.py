"""CasADi: algorithmic differentiation over SX, `cse`, its C code generation; its virtual machine beside it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import casadi

from benchmarks.peers.linear import Matrix, Vector
from benchmarks.peers.source import Source, signature
from benchmarks.peers.symbolic import FORMS, outputs
from benchmarks.peers.work import Work

NAME = "casadi"
PACKAGE = "casadi"
__all__ = ["FORMS", "NAME", "PACKAGE", "function", "write"]


class CasadiAlgebra:
    """Scalars are 1 x 1 `casadi.SX`."""

    def vector(self, name: str, length: int) -> Vector:
        """Symbols of one argument."""
        return list(casadi.vertsplit(casadi.SX.sym(name, length)))

    def atan2(self, y: Any, x: Any) -> Any:
        """Angle of (x, y)."""
        return casadi.atan2(y, x)

    def jacobian(self, values: Sequence[Any], symbols: Vector) -> Matrix:
        """Derivatives by `casadi.jacobian`."""
        dense = casadi.jacobian(casadi.vertcat(*values), casadi.vertcat(*symbols))
        return [[dense[row, column] for column in range(dense.shape[1])] for row in range(dense.shape[0])]

    def gradient(self, value: Any, symbols: Vector) -> Vector:
        """Derivatives in reverse mode."""
        return list(casadi.vertsplit(casadi.densify(casadi.gradient(value, casadi.vertcat(*symbols)))))

    def at_zero(self, values: Sequence[Any], symbols: Vector) -> Vector:
        """Zeros put in; sums and products evaluate themselves."""
        vector = casadi.vertcat(*symbols)
        moved = casadi.substitute(casadi.densify(casadi.vertcat(*values)), vector, casadi.SX.zeros(vector.shape[0]))
        return list(casadi.vertsplit(casadi.densify(moved)))


def function(work: Work, form: str, name: str) -> Any:
    """Build the CasADi function; its outputs hold the stored entries, sparse like our function's."""
    arguments, stored = outputs(CasadiAlgebra(), work, form)
    inputs = [casadi.vertcat(*symbols) for symbols in arguments.values()]
    results = []
    for output, values in stored.items():
        pattern = work.patterns[output]
        sparsity = casadi.Sparsity(pattern.rows, pattern.columns, list(pattern.starts), list(pattern.row_indices))
        results.append(casadi.SX(sparsity, casadi.densify(casadi.vertcat(*values))))
    return casadi.Function(name, inputs, casadi.cse(results), list(arguments), list(stored))


def write(work: Work, form: str, symbol: str) -> Source:
    """Generate the routine: CasADi's C, called with its own convention.

    The caller is compiled with it and promises that no pointer is null, so that the compiler may drop CasADi's checks
    of every access.
    """
    generator = casadi.CodeGenerator(f"{symbol}_work.c", {"with_header": False, "verbose": False})
    generator.add(function(work, form, "work"))
    names = [*work.arguments, *work.patterns]
    inputs, results = ", ".join(work.arguments), ", ".join(work.patterns)
    attribute = f"__attribute__((nonnull({', '.join(str(k + 1) for k in range(len(names)))})))"
    text = (
        f"#define CASADI_SYMBOL_EXPORT static inline\n{generator.dump()}\n"
        f"{attribute} {signature(work, symbol)}\n{{\n"
        f"    const double *arguments[] = {{{inputs}}};\n    double *results[] = {{{results}}};\n"
        "    work(arguments, results, 0, 0, 0);\n}\n"
    )
    return Source("c", text)
