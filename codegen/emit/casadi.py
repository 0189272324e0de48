"""CasADi functions: the same program, evaluated over SX."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import casadi

from codegen.ir.evaluate import Domain, evaluate
from codegen.ir.looped import GEOMETRY, Loop, Looped
from codegen.ir.nearest import nearest_double
from codegen.ir.ops import Constant
from codegen.ir.program import Argument, Output, Program
from codegen.passes.flatten import Piece, flatten


def sx_domain() -> Domain:
    """CasADi's scalar expressions."""
    return Domain("casadi.SX", _constant, casadi.sqrt, casadi.sin, casadi.cos, casadi.atan2, select=_select)


def _select(a: Any, b: Any, x: Any, y: Any) -> Any:
    return casadi.if_else(a < b, x, y)


def _constant(constant: Constant) -> Any:
    return casadi.SX(nearest_double(constant))


def casadi_function(name: str, program: Program | Looped) -> Any:
    """Build a ``casadi.Function`` with the arguments and outputs of the program.

    Loops become maps of the function of an instance, so that the graph does not grow with their number.

    Args:
        name: of the function; the C symbol without its storage ending.
        program: what it evaluates.

    Returns:
        Function of dense inputs (matrices 3 x 3, vectors n x 1) with sparse outputs.
    """
    if isinstance(program, Looped):
        return looped_function(name, program)
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


def looped_function(name: str, looped: Looped) -> Any:
    """Build the function of loops, of calls of the functions of their instances."""
    used = looped.used_arguments()
    symbols = {argument.name: casadi.MX.sym(argument.name, *argument.shape) for argument in used}
    stored = {output.name: [casadi.MX(0, 1)] * 0 for output in looped.outputs}
    places: dict[str, list[int]] = {output.name: [] for output in looped.outputs}
    for number, loop in enumerate(looped.loops):
        for piece, values in _mapped(f"{name}_part_{number + 1}", looped, loop, symbols):
            stored[piece.array].append(values)
            places[piece.array] += _places(piece, loop.count)
    outputs = [_ordered(looped, output.name, stored[output.name], places[output.name]) for output in looped.outputs]
    names = [output.name for output in looped.outputs]
    return casadi.Function(name, list(symbols.values()), outputs, list(symbols), names)


def _mapped(name: str, looped: Looped, loop: Loop, symbols: dict[str, Any]) -> Iterator[tuple[Piece, Any]]:
    """The outputs of a loop, instance after instance."""
    flat = flatten(looped, loop)
    if not flat.outputs:
        return
    function = casadi_function(name, flat.program).map(loop.count)
    passed = {piece.name: _taken(symbols[piece.array], piece, loop.count) for piece in flat.inputs}
    passed[GEOMETRY] = casadi.DM([nearest_double(value) for row in loop.geometry for value in row])
    arguments = [
        casadi.reshape(passed[argument.name], argument.length, loop.count) for argument in flat.program.used_arguments()
    ]
    results = function.call(arguments)
    for piece, result in zip(flat.outputs, results, strict=True):
        yield piece, casadi.vec(casadi.densify(result))


def _taken(symbol: Any, piece: Piece, count: int) -> Any:
    """The entries of a piece, instance after instance; a range of them where they follow each other."""
    if piece.stride == piece.length:
        return symbol[piece.start : piece.start + count * piece.length]
    return symbol[_places(piece, count)]


def _places(piece: Piece, count: int) -> list[int]:
    """Places in the whole of the entries of a piece, instance after instance."""
    return [piece.start + piece.stride * instance + k for instance in range(count) for k in range(piece.length)]


def _ordered(looped: Looped, name: str, values: list[Any], places: list[int]) -> Any:
    """Nonzeros in the order of storage, as a matrix."""
    pattern = looped.output(name).sparsity
    sparsity = casadi.Sparsity(pattern.nrow, pattern.ncol, list(pattern.colind), list(pattern.row))
    if not values:
        return casadi.MX(pattern.nrow, pattern.ncol)
    together = casadi.vertcat(*values)
    order = sorted(range(len(places)), key=places.__getitem__)
    return casadi.sparsity_cast(together if order == list(range(len(places))) else together[order], sparsity)


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
