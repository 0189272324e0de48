"""Evaluate a routine at many poses: compiled batch code, piece by piece, on all cores.

Calls through ctypes release the lock of the interpreter, so that threads share the arrays and nothing is copied.
"""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
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
from codegen.simulate.library import library
from codegen.spec.platform import Platform

CHUNK = 10_000
"""Poses of one call: the arrays of a call stay in the caches of a core; no power of two, which would be slow."""

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
    headers = _headers(batch_header(platform.name, groups, lanes, ""), f"{platform.name}_batch{lanes}.h")
    loaded = library(batch_source(platform.name, groups, lanes, "", "sweep"), headers, FLAGS)
    function = loaded[symbol]
    function.restype = None
    declared = parameters(made, False)
    inputs = tuple((p.name, p.length) for p in declared if p.direction == "in")
    return Kernel(platform, inputs, tuple(p for p in declared if p.direction == "out"), function, loaded)


def sweep(compiled: Kernel, poses: Poses, progress: Progress = lambda _: None, threads: int | None = None) -> Array:
    """Evaluate all poses.

    Args:
        compiled: the code.
        poses: where.
        progress: told each piece.
        threads: how many; all cores if left out.

    Returns:
        [columns, poses] what tells a pose, then the results.
    """
    found = np.empty((len(poses.names) + len(compiled.names()), poses.count))

    def piece(bounds: tuple[int, int]) -> None:
        first, last = bounds
        found[: len(poses.names), first:last] = poses.columns(first, last)
        found[len(poses.names) :, first:last] = compiled.evaluate(poses, first, last)

    with ThreadPoolExecutor(threads or len(os.sched_getaffinity(0))) as pool:
        for bounds, _ in zip(pieces(poses.count), pool.map(piece, pieces(poses.count)), strict=True):
            progress(f"{bounds[1]} poses")
    return found


def pieces(count: int) -> Iterator[tuple[int, int]]:
    """First pose and end of each piece."""
    return ((first, min(first + CHUNK, count)) for first in range(0, count, CHUNK))


def _names(parameter: Parameter) -> list[str]:
    """``D_sigma`` for a part of one number, ``values_sigma1`` of several, ``lengths1`` without parts."""
    parts = [(name, shape[0]) for name, _, shape, _ in parameter.members] or [(parameter.name, parameter.length)]
    return [name if size == 1 else f"{name}{k + 1}" for name, size in parts for k in range(size)]


def _headers(own: str, name: str) -> dict[str, str]:
    shared = vector_headers(LANES["double"], banner(codegen.__version__), choices=True)
    real = real_header(codegen.__version__, "double", choices=True, has_batch=True)
    return {name: own, "jg_real.h": real} | {f"{header}.h": text for header, text in shared.items()}
