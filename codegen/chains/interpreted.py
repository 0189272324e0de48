"""Programs evaluated in Python, step by step: for a few poses, where there need be no compiler."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.simulate.callable import Evaluate

Array = NDArray[np.float64]


def interpreted(programs: Sequence[Program]) -> list[Evaluate]:
    """Make functions of programs, as `codegen.simulate.callable.callables` does."""
    return [_evaluate(program) for program in programs]


def _evaluate(program: Program) -> Evaluate:
    def evaluated(**arguments: Array) -> dict[str, Array]:
        stored = evaluate(program, {name: list(values) for name, values in arguments.items()})
        found: dict[str, Array] = {}
        for output in program.outputs:
            dense = np.zeros((output.sparsity.nrow, output.sparsity.ncol))
            for place, value in zip(output.sparsity.entries(), stored[output.name], strict=True):
                dense[place] = value
            found[output.name] = dense[:, 0] if dense.shape[1] == 1 else dense
        return found

    return evaluated
