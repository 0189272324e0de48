"""Residual and Jacobian compiled into a library whose functions IDA calls without a detour through Python."""

from __future__ import annotations

import ctypes
import subprocess
import tempfile
import textwrap
from dataclasses import dataclass
from pathlib import Path

import codegen
from codegen.emit.c import definition
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.routine import Parameter
from codegen.errors import InternalError
from codegen.ir.program import Program
from codegen.measure.compile import compiler

_FLAGS = ("-std=c99", "-O2", "-fPIC", "-shared")


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
    with tempfile.TemporaryDirectory() as folder:
        source, library = Path(folder) / "ida.c", Path(folder) / "ida.so"
        source.write_text(ida_source(name, residual, jacobian))
        header = render("c/jg_real.h.j2", banner=banner(codegen.__version__), real="double", fma=False, batch=None)
        (Path(folder) / "jg_real.h").write_text(header)
        command = [compiler(), *_FLAGS, str(source), "-o", str(library), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise InternalError(f"the equations of motion do not compile: {done.stderr}")
        loaded = ctypes.CDLL(str(library))
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
        functions=[definition(*_declared(program), program)[0] for program in (residual, jacobian)],
        residual=_call(residual),
        jacobian=_call(jacobian),
        size=pattern.ncol,
        nonzeros=pattern.nonzeros,
        pointers=_numbers(pattern.colind),
        indices=_numbers(pattern.row),
    )


def _declared(program: Program) -> tuple[str, tuple[Parameter, ...]]:
    words = ("column-major", "", "")
    inputs = [Parameter(a.name, "in", a.shape, a.length, *words) for a in program.used_arguments()]
    outputs = [Parameter(o.name, "out", (len(o.values), 1), len(o.values), *words) for o in program.outputs]
    return f"evaluate_{program.outputs[0].name}", (*inputs, *outputs)


def _call(program: Program) -> str:
    symbol, parameters = _declared(program)
    return f"{symbol}({', '.join(parameter.name for parameter in parameters)});"


def _numbers(values: tuple[int, ...]) -> list[str]:
    return textwrap.wrap(", ".join(map(str, values)), 108)
