"""wrenfold: its own derivatives and optimisation, its C++ generator with plain column-major spans."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from wrenfold import code_generation, sym, type_info

from benchmarks.peers.linear import Matrix, Vector
from benchmarks.peers.source import Source, signature
from benchmarks.peers.symbolic import FORMS, outputs
from benchmarks.peers.work import Work

NAME = "wrenfold"
PACKAGE = "wrenfold"
__all__ = ["FORMS", "NAME", "PACKAGE", "write"]

_SPANS = """#include <cmath>
namespace {
namespace wf {
template <typename T, int Rows> struct span {
    T *data;
    T &operator()(int row, int column) const { return data[Rows * column + row]; }
};
template <int Rows, int Columns> inline span<const double, Rows> make_input_span(const double *data) { return {data}; }
template <int Rows, int Columns> inline span<double, Rows> make_output_span(double *data) { return {data}; }
}
"""


class WrenfoldAlgebra:
    """Scalars are `wrenfold.sym.Expr`; the arguments are inputs of a function description."""

    def __init__(self, description: Any) -> None:
        self._description = description

    def vector(self, name: str, length: int) -> Vector:
        """Entries of an argument, or free symbols for virtual displacements."""
        if name in ("delta", "epsilon"):
            return [sym.symbol(f"{name}_{k}") for k in range(length)]
        shape = type_info.MatrixType(length, 1)
        argument = self._description.add_input_argument(name, shape)
        return [argument[k] for k in range(length)]

    def atan2(self, y: Any, x: Any) -> Any:
        """Angle of (x, y)."""
        return sym.atan2(y, x)

    def jacobian(self, values: Sequence[Any], symbols: Vector) -> Matrix:
        """Derivatives by `wrenfold.sym.jacobian`."""
        dense = sym.jacobian(sym.vector(*values), sym.vector(*symbols))
        return [[dense[row, column] for column in range(len(symbols))] for row in range(len(values))]

    def gradient(self, value: Any, symbols: Vector) -> Vector:
        """Derivatives by `wrenfold.sym.jacobian`."""
        return self.jacobian([value], symbols)[0]

    def at_zero(self, values: Sequence[Any], symbols: Vector) -> Vector:
        """Zeros put in; sums and products evaluate themselves."""
        moved = sym.vector(*values).subs([(symbol, sym.zero) for symbol in symbols])
        return [moved[k] for k in range(len(values))]


def write(work: Work, form: str, symbol: str) -> Source:
    """Generate the routine."""
    description = code_generation.FunctionDescription(name="work")
    _, stored = outputs(WrenfoldAlgebra(description), work, form)
    for name, values in stored.items():
        description.add_output_argument(name, False, sym.vector(*values))
    text = code_generation.CppGenerator().generate(code_generation.transpile(description))
    names = ", ".join([*work.arguments, *work.patterns])
    caller = f'extern "C" {signature(work, symbol, "__restrict")}\n{{\n    work<double>({names});\n}}\n'
    return Source("c++", f"{_SPANS}\n{text}\n}}\n{caller}")
