"""Residual and Jacobian compiled into a library whose functions IDA calls without a detour through Python."""

from __future__ import annotations

import ctypes
import textwrap
from dataclasses import dataclass

import codegen
from codegen.emit.c import definition
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.routine import Parameter
from codegen.ir.program import Program
from codegen.simulate.library import library


@dataclass(frozen=True, slots=True)
class Compiled:
    """A library in memory.

    Attributes:
        residual: address of the residual, ``IDAResFn``.
        jacobian: address of the Jacobian, ``IDALsJacFn``.
        size: entries of the state.
        nonzeros: of the Jacobian.
        library: keeps it loaded.
    """

    residual: int
    jacobian: int
    size: int
    nonzeros: int
    library: ctypes.CDLL


def compiled(name: str, residual: Program, jacobian: Program) -> Compiled:
    """Compile the equations of motion.

    Args:
        name: of the scene.
        residual: with the output ``residual``.
        jacobian: with the output ``jacobian``.

    Raises:
        SpecificationError: there is no C compiler.
    """
    loaded = library(ida_source(name, residual, jacobian))
    pattern = jacobian.output("jacobian").sparsity
    addresses = [ctypes.cast(loaded[name], ctypes.c_void_p).value for name in ("jg_ida_residual", "jg_ida_jacobian")]
    return Compiled(addresses[0] or 0, addresses[1] or 0, pattern.ncol, pattern.nonzeros, loaded)


def ida_source(name: str, residual: Program, jacobian: Program) -> str:
    """Write the C source of the functions that IDA calls."""
    pattern = jacobian.output("jacobian").sparsity
    return render(
        "c/ida.c.j2",
        banner=banner(codegen.__version__),
        name=name,
        functions=[definition(*declared(program), program)[0] for program in (residual, jacobian)],
        residual=_call(residual),
        jacobian=_call(jacobian),
        size=pattern.ncol,
        nonzeros=pattern.nonzeros,
        pointers=_numbers(pattern.colind),
        indices=_numbers(pattern.row),
    )


def declared(program: Program) -> tuple[str, tuple[Parameter, ...]]:
    """Symbol and parameters of a function that evaluates a program: arguments it uses, then nonzeros of outputs."""
    words = ("column-major", "", "")
    inputs = [Parameter(a.name, "in", a.shape, a.length, *words) for a in program.used_arguments()]
    outputs = [Parameter(o.name, "out", (len(o.values), 1), len(o.values), *words) for o in program.outputs]
    return f"evaluate_{program.outputs[0].name}", (*inputs, *outputs)


def _call(program: Program) -> str:
    symbol, parameters = declared(program)
    return f"{symbol}({', '.join(parameter.name for parameter in parameters)});"


def _numbers(values: tuple[int, ...]) -> list[str]:
    return textwrap.wrap(", ".join(map(str, values)), 108)
