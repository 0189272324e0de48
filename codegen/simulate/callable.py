"""A program compiled and called with arrays of numpy: for loops that are run from Python."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import codegen
from codegen.emit.c import definition
from codegen.emit.package import banner
from codegen.ir.program import Output, Program
from codegen.simulate.compiled import declared
from codegen.simulate.library import library

Array = NDArray[np.float64]

Evaluate = Callable[..., dict[str, Array]]
"""Takes the program's arguments by their names, matrices by columns; gives every output as a dense array: vectors [n],
matrices [m, n]. Arguments that the program does not use may be given too."""


def callables(programs: Sequence[Program]) -> list[Evaluate]:
    """Compile programs into functions.

    Raises:
        SpecificationError: there is no C compiler.
    """
    symbols = [f"evaluate_{k}" for k in range(len(programs))]
    texts = [definition(s, declared(program)[1], program)[0] for s, program in zip(symbols, programs, strict=True)]
    source = "\n".join([f"/* {banner(codegen.__version__)} */", '#include "jg_real.h"', *texts])
    loaded = library(source)
    return [_evaluate(loaded[symbol], program) for symbol, program in zip(symbols, programs, strict=True)]


def _evaluate(function: Any, program: Program) -> Evaluate:
    function.restype = None
    used = [(argument.name, np.zeros(argument.length)) for argument in program.used_arguments()]
    found = [(output, _places(output), np.zeros(max(1, len(output.values)))) for output in program.outputs]
    buffers = [buffer for _, buffer in used] + [buffer for _, _, buffer in found]
    addresses = [ctypes.c_void_p(buffer.ctypes.data) for buffer in buffers]

    def evaluate(**arguments: Array) -> dict[str, Array]:
        for name, buffer in used:
            buffer[:] = arguments[name]
        function(*addresses)
        return {output.name: _dense(output, places, values) for output, places, values in found}

    return evaluate


def _places(output: Output) -> NDArray[np.intp]:
    """Where each nonzero stands in a matrix by rows."""
    columns = output.sparsity.ncol
    return np.array([row * columns + column for row, column in output.sparsity.entries()], dtype=np.intp)


def _dense(output: Output, places: NDArray[np.intp], values: Array) -> Array:
    pattern = output.sparsity
    dense = np.zeros(pattern.nrow * pattern.ncol)
    dense[places] = values[: len(places)]
    return dense if pattern.ncol == 1 else dense.reshape(pattern.nrow, pattern.ncol)
