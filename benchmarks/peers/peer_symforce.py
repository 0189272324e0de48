"""SymForce: its own derivatives and C++ generator (Eigen matrices); integer powers written out."""

from __future__ import annotations

import logging
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import symforce

symforce.set_epsilon_to_number()

import symforce.symbolic as sf  # noqa: E402
from symforce import codegen  # noqa: E402
from symforce.values import Values  # noqa: E402

from benchmarks.peers.eigen import eigen_include  # noqa: E402
from benchmarks.peers.linear import Matrix, Vector  # noqa: E402
from benchmarks.peers.source import Source, integer_powers, signature  # noqa: E402
from benchmarks.peers.symbolic import FORMS, outputs  # noqa: E402
from benchmarks.peers.work import Work  # noqa: E402

NAME = "symforce"
PACKAGE = "symforce"
__all__ = ["FORMS", "NAME", "PACKAGE", "write"]


class SymforceAlgebra:
    """Scalars are SymForce's expressions."""

    def __init__(self) -> None:
        self.arguments: dict[str, Any] = {}

    def vector(self, name: str, length: int) -> Vector:
        """Entries of an argument, or free symbols for virtual displacements."""
        self.arguments[name] = sf.Matrix(length, 1, [sf.Symbol(f"{name}_{k}") for k in range(length)])
        return list(self.arguments[name].to_flat_list())

    def atan2(self, y: Any, x: Any) -> Any:
        """Angle of (x, y); at the origin there is none, hence no epsilon."""
        return sf.atan2(y, x, epsilon=0)

    def jacobian(self, values: Sequence[Any], symbols: Vector) -> Matrix:
        """Derivatives by ``diff``."""
        return [[sf.S(value).diff(symbol) for symbol in symbols] for value in values]

    def gradient(self, value: Any, symbols: Vector) -> Vector:
        """Derivatives by ``diff``."""
        return self.jacobian([value], symbols)[0]

    def at_zero(self, values: Sequence[Any], symbols: Vector) -> Vector:
        """Zeros put in; sums and products evaluate themselves."""
        zeros = {symbol: 0 for symbol in symbols}
        return [sf.S(value).subs(zeros) for value in values]


def write(work: Work, form: str, symbol: str) -> Source:
    """Generate the routine; the arrays are handed over as Eigen matrices without a copy."""
    logging.disable(logging.WARNING)
    algebra = SymforceAlgebra()
    arguments, stored = outputs(algebra, work, form)
    inputs = Values(**{name: algebra.arguments[name] for name in arguments})
    results = Values(**{name: sf.Matrix(len(values), 1, values) for name, values in stored.items()})
    generated = codegen.Codegen(inputs=inputs, outputs=results, config=codegen.CppConfig(), name="work")
    with tempfile.TemporaryDirectory() as folder:
        generated.generate_function(output_dir=folder, skip_directory_nesting=True)
        text = (
            (Path(folder) / "work.h").read_text().replace("#pragma once", "").replace("namespace sym {", "namespace {")
        )
    views = [f"*reinterpret_cast<const Eigen::Matrix<double, {n}, 1> *>({name})" for name, n in work.arguments.items()]
    views += [f"reinterpret_cast<Eigen::Matrix<double, {n}, 1> *>({name})" for name, n in work.lengths.items()]
    caller = f'extern "C" {signature(work, symbol, "__restrict")}\n{{\n    Work<double>({", ".join(views)});\n}}\n'
    return Source("c++", f"{integer_powers(text)}\n{caller}", (str(eigen_include()),))
