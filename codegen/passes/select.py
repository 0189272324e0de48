"""Keep some rows and columns of the outputs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from codegen.ir.program import Output, Program, Sparsity

Chosen = tuple[Sequence[int], Sequence[int]]
"""Rows and columns, in the order they come to have."""


def select(program: Program, chosen: Mapping[str, Chosen]) -> Program:
    """Give the program with only the chosen rows and columns of its outputs.

    Args:
        program: with outputs of any pattern.
        chosen: output name -> rows and columns; other outputs stay as they are.
    """
    outputs = (
        _selected(output, *chosen[output.name]) if output.name in chosen else output for output in program.outputs
    )
    return replace(program, outputs=tuple(outputs))


def _selected(output: Output, rows: Sequence[int], columns: Sequence[int]) -> Output:
    row_of = {old: new for new, old in enumerate(rows)}
    column_of = {old: new for new, old in enumerate(columns)}
    kept = {
        (row_of[row], column_of[column]): value
        for (row, column), value in zip(output.sparsity.entries(), output.values, strict=True)
        if row in row_of and column in column_of
    }
    sparsity = Sparsity.of_entries(len(rows), len(columns), kept)
    return Output(output.name, sparsity, tuple(kept[entry] for entry in sparsity.entries()))
