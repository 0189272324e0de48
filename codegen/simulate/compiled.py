"""Residual and Jacobian compiled into a library whose functions IDA calls without a detour through Python."""

from __future__ import annotations

import ctypes
import textwrap
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import codegen
from codegen.emit.c import any_definition
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.routine import Parameter, Subject
from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.simulate.factors import blocks, lu_headers
from codegen.simulate.library import library
from codegen.simulate.straight import Pivots, Straight, straight_blocks
from codegen.simulate.sundials import VECTOR_OPERATIONS
from codegen.simulate.vectors import vector_headers

Array = NDArray[np.float64]

WEIGHT = 1e4
"""1/s, of the rates in the Jacobian whose pivots are taken: between those of the first step and of the usual ones."""


@dataclass(frozen=True, slots=True)
class Compiled:
    """A library in memory.

    Attributes:
        residual: address of the residual, ``IDAResFn``.
        jacobian: address of the Jacobian, ``IDALsJacFn``.
        start: address of what makes room for the factors of the Jacobian.
        end: address of what gives it back.
        setup: address of the factorisation, an operation of a linear solver.
        solve: address of the solution with the factors, an operation of a linear solver.
        straight: blocks of the Jacobian in straight-line code.
        operations: addresses of operations on vectors, as `codegen.simulate.sundials.VECTOR_OPERATIONS`.
        size: entries of the state.
        nonzeros: of the Jacobian.
        library: keeps it loaded.
    """

    residual: int
    jacobian: int
    start: int
    end: int
    setup: int
    solve: int
    straight: Straight
    operations: tuple[int, ...]
    size: int
    nonzeros: int
    library: ctypes.CDLL


def compiled(
    subject: Subject, residual: Program | Looped, jacobian: Program | Looped, y: Array, ydot: Array
) -> Compiled:
    """Compile the equations of motion.

    Args:
        subject: what they are of.
        residual: with the output ``residual``.
        jacobian: with the output ``jacobian``.
        y: [n] a state; the Jacobian there tells good pivots.
        ydot: [n] its rate.

    Raises:
        SpecificationError: there is no C compiler.
    """
    pattern = jacobian.output("jacobian").sparsity
    loaded = library(ida_source(subject, residual, jacobian), lu_headers() | vector_headers(pattern.ncol))
    residual_at, jacobian_at, start, end, setup, solve = (
        ctypes.cast(loaded[f"jg_ida_{name}"], ctypes.c_void_p).value or 0
        for name in ("residual", "jacobian", "start", "end", "setup", "solve")
    )
    size, nonzeros = pattern.ncol, pattern.nonzeros
    straight = straight_blocks(pattern, _pivots(loaded, pattern.nonzeros, y, ydot))
    operations = (ctypes.c_void_p * len(VECTOR_OPERATIONS)).in_dll(loaded, "jg_vector_operations")
    return Compiled(
        residual_at, jacobian_at, start, end, setup, solve, straight, tuple(operations), size, nonzeros, loaded
    )


def _pivots(equations: ctypes.CDLL, nonzeros: int, y: Array, ydot: Array) -> Callable[[int, int], Pivots | None]:
    """Find pivots that are good at a state, block by block."""
    values, turns = np.zeros(max(1, nonzeros)), np.zeros(len(y))
    addresses = [ctypes.c_void_p(array.ctypes.data) for array in (y, ydot, turns, values)]
    equations.jg_ida_values(ctypes.c_double(0.0), ctypes.c_double(WEIGHT), *addresses)

    def found(block: int, size: int) -> Pivots | None:
        rows, columns = (ctypes.c_int * size)(), (ctypes.c_int * size)()
        code = equations.jg_ida_pivots(ctypes.c_int(block), ctypes.c_void_p(values.ctypes.data), rows, columns)
        return None if code else (tuple(rows), tuple(columns))

    return found


def ida_source(subject: Subject, residual: Program | Looped, jacobian: Program | Looped) -> str:
    """Write the C source of the functions that IDA calls."""
    pattern = jacobian.output("jacobian").sparsity
    found = blocks(pattern)
    return render(
        "c/ida.c.j2",
        banner=banner(codegen.__version__),
        name=subject.stem,
        functions=[any_definition(*declared(p), p, subject, "static void")[0] for p in (residual, jacobian)],
        residual=call(residual),
        jacobian=call(jacobian),
        size=pattern.ncol,
        nonzeros=pattern.nonzeros,
        blocks=len(found.starts) - 1,
        tables={
            name: _numbers(values)
            for name, values in (
                ("pointers", pattern.colind),
                ("indices", pattern.row),
                ("starts", found.starts),
                ("columns", found.columns),
                ("rows", found.rows),
            )
        },
    )


def declared(program: Program | Looped) -> tuple[str, tuple[Parameter, ...]]:
    """Symbol and parameters of a function that evaluates a program: arguments it uses, then nonzeros of outputs."""
    words = ("column-major", "", "")
    inputs = [Parameter(a.name, "in", a.shape, a.length, *words) for a in program.used_arguments()]
    sizes = [(output.name, output.sparsity.nonzeros) for output in program.outputs]
    outputs = [Parameter(name, "out", (size, 1), size, *words) for name, size in sizes]
    return f"evaluate_{program.outputs[0].name}", (*inputs, *outputs)


def call(program: Program | Looped) -> str:
    """A call of that function, with names of parameters as arguments."""
    symbol, parameters = declared(program)
    return f"{symbol}({', '.join(parameter.name for parameter in parameters)});"


def _numbers(values: tuple[int, ...]) -> list[str]:
    return textwrap.wrap(", ".join(map(str, values)), 108)
