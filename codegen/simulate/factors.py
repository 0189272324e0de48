"""The sparse LU factorisation that is compiled with the equations of motion, and the blocks that it works on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

import codegen
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.ir.program import Sparsity

CHOSEN = 0.1
"""A pivot is at least this part of the largest entry of its column when it is chosen: the usual bound of threshold
pivoting, a factor of 11 a step at the worst for what an entry may grow."""

KEPT = 1e-4
"""Later matrices keep it down to this part: of 16 digits Newton's iteration needs the first few."""


@dataclass(frozen=True, slots=True)
class Blocks:
    """Parts of a matrix without entries in common rows or columns: they are factorised one after the other.

    Attributes:
        starts: [blocks + 1] of each in ``columns`` and ``rows``, which it has equally many of.
        columns: [n] block by block.
        rows: [n] block by block.
    """

    starts: tuple[int, ...]
    columns: tuple[int, ...]
    rows: tuple[int, ...]


def blocks(pattern: Sparsity) -> Blocks:
    """Find the blocks of a square pattern; one block if a part has more rows than columns, as singular matrices do."""
    size, nonzeros = pattern.ncol, pattern.nonzeros
    columns = np.repeat(np.arange(size), np.diff(pattern.colind))
    graph = coo_matrix((np.ones(nonzeros), (np.array(pattern.row, dtype=int), size + columns)), (2 * size, 2 * size))
    count, labels = connected_components(graph, directed=False)
    of_rows, of_columns = labels[:size], labels[size:]
    sizes = np.bincount(of_columns, minlength=count)
    if not np.array_equal(sizes, np.bincount(of_rows, minlength=count)):
        return Blocks((0, size), tuple(range(size)), tuple(range(size)))
    starts = np.concatenate([[0], np.cumsum(sizes)])
    in_order = (np.argsort(of, kind="stable") for of in (of_columns, of_rows))
    return Blocks(tuple(starts.tolist()), *(tuple(places.tolist()) for places in in_order))


def lu_headers() -> dict[str, str]:
    """Write the headers of the factorisation: name -> text; sources include ``jg_lu.h``."""
    values = {"banner": banner(codegen.__version__), "chosen": repr(CHOSEN), "kept": repr(KEPT)}
    return {name: render(f"simulate/{name}.j2", **values) for name in ("jg_pivots.h", "jg_straight.h", "jg_lu.h")}
