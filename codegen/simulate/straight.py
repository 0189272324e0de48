"""Blocks of a Newton matrix in straight-line code: one routine for all blocks that have their nonzeros alike."""

from __future__ import annotations

import ctypes
from collections.abc import Iterator
from ctypes import c_double, c_int, c_void_p
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.ir.program import Sparsity
from codegen.simulate.elimination import Elimination, local_columns
from codegen.simulate.factors import Blocks, blocks, lu_headers
from codegen.simulate.library import library

Array = NDArray[np.float64]

WEIGHT = 1e4
"""1/s, of the rates in the Jacobian whose pivots are taken: a tenth of a thousandth of a second is a step between the first and the usual ones."""

MOST_PRODUCTS = 20_000
"""Of an elimination; the text of longer ones is too long for a compiler and for a processor's memory of instructions."""


@dataclass(frozen=True, slots=True)
class Straight:
    """Routines of blocks.

    Attributes:
        kinds: address of the routines; None where there are none.
        kind: [blocks] number of the routines of each, or -1.
        library: keeps them loaded.
    """

    kinds: int | None
    kind: NDArray[np.intc]
    library: ctypes.CDLL | None


def straight_blocks(equations: ctypes.CDLL, pattern: Sparsity, y: Array, ydot: Array) -> Straight:
    """Write and compile the eliminations of a Jacobian.

    Args:
        equations: of `codegen.simulate.compiled.ida_source`.
        pattern: of the Jacobian.
        y: [n] a state.
        ydot: [n] its rate.
    """
    found = blocks(pattern)
    values = _values(equations, pattern, y, ydot)
    numbers: dict[tuple[tuple[int, ...], ...], int] = {}
    kinds: list[Elimination] = []
    kind = []
    for block, (rows, columns) in enumerate(_parts(found)):
        key = local_columns(pattern.colind, pattern.row, rows, columns)
        if key not in numbers:
            elimination = _elimination(equations, block, key, values)
            numbers[key] = -1 if elimination is None else len(kinds)
            kinds += [] if elimination is None else [elimination]
        kind.append(numbers[key])
    if not kinds:
        return Straight(None, np.array(kind, dtype=np.intc), None)
    loaded = library(render("simulate/straight.c.j2", banner=banner(codegen.__version__), kinds=kinds), lu_headers())
    loaded.jg_straight_kinds.restype = c_void_p
    return Straight(loaded.jg_straight_kinds(), np.array(kind, dtype=np.intc), loaded)


def _parts(found: Blocks) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    for start, stop in zip(found.starts, found.starts[1:], strict=False):
        yield found.rows[start:stop], found.columns[start:stop]


def _values(equations: ctypes.CDLL, pattern: Sparsity, y: Array, ydot: Array) -> Array:
    values, turns = np.zeros(max(1, pattern.nonzeros)), np.zeros(max(1, pattern.ncol))
    addresses = [c_void_p(array.ctypes.data) for array in (y, ydot, turns, values)]
    equations.jg_ida_values(c_double(0.0), c_double(WEIGHT), *addresses)
    return values


def _elimination(
    equations: ctypes.CDLL, block: int, columns: tuple[tuple[int, ...], ...], values: Array
) -> Elimination | None:
    """The elimination of a block with pivots that are good at the state; None where it is singular there, or too long."""
    size = len(columns)
    pivot_rows, pivot_columns = (c_int * size)(), (c_int * size)()
    if equations.jg_ida_pivots(c_int(block), c_void_p(values.ctypes.data), pivot_rows, pivot_columns):
        return None
    found = Elimination(columns, tuple(pivot_rows), tuple(pivot_columns))
    return found if found.products <= MOST_PRODUCTS else None
