"""Measure what each kind of operation costs on this machine, in units of an addition.

A loop over independent chains of one operation, timed against the same loop of additions: throughput, as in the
straight-line code that the generator emits.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from codegen.emit.environment import render
from codegen.measure.compile import compile_sources

_EXPRESSIONS: dict[str, str] = {
    "add": "x[k] + c",
    "mul": "x[k] * c",
    "div": "x[k] / c",
    "fma": "fma(x[k], c, c)",
    "sqrt": "sqrt(x[k])",
    "sin": "sin(x[k])",
    "cos": "cos(x[k])",
    "sincos": "sin(x[k]) + cos(x[k])",
    "atan2": "atan2(x[k], c)",
}
_REPETITIONS = 7


def operation_costs() -> dict[str, float]:
    """Measure the costs: kind -> cost in additions.

    Raises:
        SpecificationError: there is no compiler.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        source = folder / "operation_costs.c"
        source.write_text(render("measure/operation_costs.c.j2", expressions=_EXPRESSIONS))
        compile_sources([source], folder / "operation_costs")
        runs = [_run(folder / "operation_costs") for _ in range(_REPETITIONS)]
    medians = {kind: statistics.median(run[kind] for run in runs) for kind in _EXPRESSIONS}
    return {kind: round(time / medians["add"], 2) for kind, time in medians.items()}


def _run(program: Path) -> dict[str, float]:
    done = subprocess.run([str(program)], capture_output=True, text=True, check=True)
    times: dict[str, float] = json.loads(done.stdout)
    return times
