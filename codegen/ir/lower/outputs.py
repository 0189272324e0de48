"""`SymbolicOutput`: what the symbolic model hands to the lowering."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True, slots=True)
class Block:
    """A part of an output: a scalar or matrix expression and the place of its first entry."""

    row: int
    column: int
    expression: Any


@dataclass(frozen=True, slots=True)
class SymbolicOutput:
    """An output matrix as blocks; blocks may not overlap, what no block covers is zero."""

    name: str
    shape: tuple[int, int]
    blocks: tuple[Block, ...]
