"""Blocks of a Newton matrix in straight-line code: one routine for all blocks that have their nonzeros alike."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from ctypes import c_void_p
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.ir.program import Sparsity
from codegen.simulate.elimination import Elimination, local_columns
from codegen.simulate.factors import Blocks, blocks, lu_headers
from codegen.simulate.library import library

Pivots = tuple[tuple[int, ...], tuple[int, ...]]
"""Rows and columns of a block in the order of elimination, numbered in it."""

MOST_PRODUCTS = 8_000
"""Of an elimination; compilers take seconds for longer ones, which hundreds of runs would have to earn."""


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


def straight_blocks(pattern: Sparsity, pivots: Callable[[int, int], Pivots | None]) -> Straight:
    """Write and compile the eliminations of a matrix.

    Args:
        pattern: of the matrix.
        pivots: those of a block, by its number and size; None where it is singular.
    """
    numbers: dict[tuple[tuple[int, ...], ...], int] = {}
    kinds: list[Elimination] = []
    kind = []
    for block, (rows, columns) in enumerate(_parts(blocks(pattern))):
        key = local_columns(pattern.colind, pattern.row, rows, columns)
        if key not in numbers:
            found = pivots(block, len(rows))
            elimination = Elimination(key, *found) if found else None
            is_short = elimination is not None and elimination.products <= MOST_PRODUCTS
            numbers[key] = len(kinds) if is_short else -1
            kinds += [elimination] if elimination is not None and is_short else []
        kind.append(numbers[key])
    return _compiled(kinds, np.array(kind, dtype=np.intc))


def _parts(found: Blocks) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    for start, stop in pairwise(found.starts):
        yield found.rows[start:stop], found.columns[start:stop]


def _compiled(kinds: list[Elimination], kind: NDArray[np.intc]) -> Straight:
    if not kinds:
        return Straight(None, kind, None)
    source = render("simulate/straight.c.j2", banner=banner(codegen.__version__), kinds=kinds)
    loaded = library(source, lu_headers())
    loaded.jg_straight_kinds.restype = c_void_p
    return Straight(loaded.jg_straight_kinds(), kind, loaded)
