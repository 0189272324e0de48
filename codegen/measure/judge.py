"""Errors of values block by block over points of the unit cube: what the search for bad inputs climbs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.ir.program import Program
from codegen.measure.bounds import Box
from codegen.measure.double_double import DoubleDouble, double_double_domain
from codegen.measure.errors import number_type
from codegen.measure.pose_domain import Block
from codegen.measure.poses import exactly, in_pairs

Given = Mapping[str, NDArray[np.floating]]
"""Argument -> [length, poses]."""
Evaluate = Callable[[Given], Mapping[str, Sequence[NDArray[np.floating]]]]
Errors = NDArray[np.float64]


def by_program(program: Program) -> Evaluate:
    """Evaluate by numpy: the bits of the compiled routine, but for functions of its mathematical library."""
    return lambda given: evaluate(program, {name: list(rows) for name, rows in given.items()}, numpy_domain())


def true_values(program: Program, exact: Mapping[str, Sequence[DoubleDouble]]) -> dict[str, list[DoubleDouble]]:
    """Evaluate in twice the precision of doubles."""
    return evaluate(program, exact, double_double_domain())


def block_errors(
    found: Mapping[str, Sequence[NDArray[np.floating]]],
    true: Mapping[str, Sequence[DoubleDouble]],
    blocks: Sequence[Block],
    count: int,
) -> Errors:
    """Largest error of each block at each pose: [blocks, poses]."""
    lines = []
    for block in blocks:
        pairs = [(found[block.output][k], true[block.output][k]) for k in block.entries]
        entries = [np.abs((in_pairs(np.asarray(value)) - exact).high) + np.zeros(count) for value, exact in pairs]
        lines.append(np.max(entries, axis=0))
    return np.array(lines)


def points_in(box: Box, points: NDArray[np.float64], real: str) -> dict[str, NDArray[np.floating]]:
    """Inputs at points [poses, entries] of the unit cube, entry by entry through the box."""
    kind, columns = number_type(real), iter(points.T)
    return {
        name: np.array([(low + (high - low) * next(columns)).astype(kind) for low, high in entries])
        for name, entries in box.inputs.items()
    }


def box_judge(
    program: Program, box: Box, real: str, blocks: Sequence[Block]
) -> Callable[[NDArray[np.float64]], Errors]:
    """Judge points of a box of inputs, by the program."""
    run = by_program(program)

    def judge(points: NDArray[np.float64]) -> Errors:
        given = points_in(box, points, real)
        return block_errors(run(given), true_values(program, exactly(given)), blocks, len(points))

    return judge
