"""Evaluate a routine at many poses: compiled batch code, piece by piece, on all cores.

Calls through ctypes release the lock of the interpreter. A few pieces are under way at a time, whatever their number.
"""

from __future__ import annotations

import ctypes
import os
from collections import deque
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import islice
from typing import Any

import numpy as np

import codegen
from codegen.emit.batch_files import vector_headers
from codegen.emit.package import banner
from codegen.emit.parameters import parameters
from codegen.emit.routine import Parameter, Routine
from codegen.emit.scene_package import real_header
from codegen.platforms.attitudes import Array
from codegen.platforms.generate import LANES, batch_header, batch_routines, batch_source
from codegen.platforms.grid import Poses
from codegen.platforms.programs import routine
from codegen.platforms.spool import Spool, pieces
from codegen.simulate.library import library
from codegen.spec.platform import Platform

FLAGS = ("-std=c99", "-O2", "-march=native", "-ffp-contract=off", "-fno-math-errno")

Progress = Callable[[str], None]
"""Told each piece that is finished."""


@dataclass(frozen=True)
class Kernel:
    """Compiled batch code of all wanted quantities.

    Attributes:
        platform: whose.
        inputs: names and lengths of the arguments, in the order of the signature.
        outputs: the parameters of the results.
        function: evaluates arrays of poses.
        library: keeps it loaded.
    """

    platform: Platform
    inputs: tuple[tuple[str, int], ...]
    outputs: tuple[Parameter, ...]
    function: Any
    library: ctypes.CDLL

    def names(self) -> tuple[str, ...]:
        """Names of the results' columns."""
        return tuple(name for parameter in self.outputs for name in _names(parameter))

    def evaluate(self, poses: Poses, first: int, last: int) -> Array:
        """Results [columns, poses] of some poses."""
        count = last - first
        given = poses.arguments(self.platform, first, last)
        arrays = [np.ascontiguousarray(given[name]) for name, _ in self.inputs]
        found = np.empty((sum(p.length for p in self.outputs), count))
        starts = np.cumsum([0, *(p.length for p in self.outputs)])
        pointers = [array.ctypes.data for array in arrays]
        pointers += [found[start:].ctypes.data for start in starts[:-1]]
        self.function(ctypes.c_long(count), ctypes.c_long(count), *map(ctypes.c_void_p, pointers))
        return found


def kernel(platform: Platform) -> Kernel:
    """Generate and compile the batch code of a platform.

    Raises:
        SpecificationError: there is no C compiler.
    """
    names = platform.wanted.offered
    made: Routine = routine(platform, "all", names)
    lanes = LANES["double"]
    symbol = f"{made.symbol}_batch{lanes}_soa"
    groups = batch_routines(made, lanes)[:1]
    declared_in = {f"{platform.name}_batch{lanes}.h": batch_header(platform.name, groups, lanes, "")}
    headers = declared_in | _shared_headers(platform.wanted.fma)
    loaded = library(batch_source(platform.name, groups, lanes, "", "sweep"), headers, FLAGS)
    function = loaded[symbol]
    function.restype = None
    declared = parameters(made, False)
    inputs = tuple((p.name, p.length) for p in declared if p.direction == "in")
    return Kernel(platform, inputs, tuple(p for p in declared if p.direction == "out"), function, loaded)


def sweep(
    compiled: Kernel, poses: Poses, found: Spool, progress: Progress = lambda _: None, threads: int | None = None
) -> None:
    """Evaluate all poses.

    Args:
        compiled: the code.
        poses: where.
        found: gets [columns, poses]: what tells a pose, then the results.
        progress: told each piece.
        threads: how many; all cores if left out.

    Raises:
        OutputError: there is no room for what is found.
    """

    def piece(bounds: tuple[int, int]) -> int:
        first, last = bounds
        found.put(first, np.vstack([poses.columns(first, last), compiled.evaluate(poses, first, last)]))
        return last

    count = threads or len(os.sched_getaffinity(0))
    waiting = pieces(poses.count)
    with ThreadPoolExecutor(count) as pool:
        running = deque(pool.submit(piece, bounds) for bounds in islice(waiting, 2 * count))
        while running:
            progress(f"{running.popleft().result()} poses")
            running.extend(pool.submit(piece, bounds) for bounds in islice(waiting, 1))


def _names(parameter: Parameter) -> list[str]:
    """``D_sigma`` for a part of one number, ``values_sigma1`` of several, ``lengths1`` without parts."""
    parts = [(name, shape[0]) for name, _, shape, _ in parameter.members] or [(parameter.name, parameter.length)]
    return [name if size == 1 else f"{name}{k + 1}" for name, size in parts for k in range(size)]


def _shared_headers(fma: bool) -> dict[str, str]:
    shared = vector_headers(LANES["double"], banner(codegen.__version__), choices=True)
    real = real_header(codegen.__version__, "double", choices=True, has_batch=True, fma=fma)
    return {"jg_real.h": real} | {f"{header}.h": text for header, text in shared.items()}
