"""Blocks of several origins put together to one output."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import sympy

from codegen.ir.lower import Block, SymbolicOutput
from codegen.mechanics.derivation import is_matrix


def gathered(name: str, shape: tuple[int, int], blocks: Iterable[Block]) -> SymbolicOutput:
    """Put blocks together to one output; those of one place are added up.

    Args:
        name: of the output.
        shape: rows and columns.
        blocks: of equal shape where they are of one place, else without overlap.
    """
    found: dict[tuple[int, int], list[Any]] = {}
    for block in blocks:
        found.setdefault((block.row, block.column), []).append(block.expression)
    return SymbolicOutput(name, shape, tuple(Block(*place, _sum(parts)) for place, parts in found.items()))


def _sum(parts: list[Any]) -> Any:
    if len(parts) == 1:
        return parts[0]
    return sympy.MatAdd(*parts) if is_matrix(parts[0]) else sympy.Add(*parts)
