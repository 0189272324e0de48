"""CasADi functions: the same program, evaluated over SX."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import casadi

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant
from codegen.ir.program import Argument, Output, Program


def sx_domain() -> Domain:
    """CasADi's scalar expressions."""
    return Domain("casadi.SX", _constant, casadi.sqrt, casadi.sin, casadi.cos, casadi.atan2)


def _constant(constant: Constant) -> Any:
    return casadi.SX(nearest_double(constant))


def casadi_function(name: str, program: Program) -> Any:
    """Build a ``casadi.Function`` with the arguments and outputs of the program.

    Args:
        name: of the function; the C symbol without its storage ending.
        program: what it evaluates.

    Returns:
        Function of dense inputs (matrices 3 x 3, vectors n x 1) with sparse outputs.
    """
    used = program.used_arguments()
    symbols = [casadi.SX.sym(argument.name, *argument.shape) for argument in used]
    inputs = {argument.name: _entries(symbol, argument) for argument, symbol in zip(used, symbols, strict=True)}
    values = evaluate(program, inputs, sx_domain())
    outputs = [_sparse(output, values[output.name]) for output in program.outputs]
    return casadi.Function(
        name,
        symbols,
        outputs,
        [argument.name for argument in used],
        [output.name for output in program.outputs],
    )


def serialised(function: Any) -> bytes:
    """Give what ``Function.save`` writes and ``casadi.Function.load`` reads; ``serialize`` has another framing."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "function.casadi"
        function.save(str(path))
        return path.read_bytes()


def _entries(symbol: Any, argument: Argument) -> list[Any]:
    return [symbol.nz[k] for k in range(argument.length)]


def _sparse(output: Output, values: list[Any]) -> Any:
    pattern = output.sparsity
    sparsity = casadi.Sparsity(pattern.nrow, pattern.ncol, list(pattern.colind), list(pattern.row))
    return casadi.SX(sparsity, casadi.vertcat(*values)) if values else casadi.SX(pattern.nrow, pattern.ncol)
