"""The engine, ready to run in each formulation."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from codegen.dynamics import jacobian, residual
from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.scenes.motion import BETA
from codegen.scenes.programs import estimate, program
from codegen.scenes.run import Prepared, Settings, prepare, run
from codegen.simulate.compiled import compiled
from codegen.spec.scene_file import read_scene

FORMS = ("conventional", "parametric")
FILE = Path(__file__).parents[2] / "examples" / "in_line_engine.toml"


@cache
def engine(form: str, sets: int = 1) -> Prepared:
    """Engines side by side, in space."""
    return prepare(read_scene(FILE.read_text(), FILE.name, sets), Settings(form=form))


@cache
def engine_with_less(form: str, left_out: tuple[str, ...]) -> Prepared:
    """One engine whose Jacobian lacks terms of `codegen.dynamics.jacobian.SECOND`."""
    ready = engine(form)
    values, slopes = _programs(form)
    residuals = residual.residual(ready.system, ready.layout, values, ready.inertia, BETA)
    slope = jacobian.jacobian(ready.system, ready.layout, slopes, ready.inertia, left_out=left_out)
    return replace(ready, equations=compiled(ready.scene.name, simplify(residuals), simplify(slope)))


@cache
def _programs(form: str) -> tuple[Program, Program]:
    """What residual and Jacobian are made of."""
    system = engine(form).system
    return program(system, residual.INDEX2, estimate), program(system, jacobian.INDEX2, estimate)


def seconds(runs: Sequence[tuple[Prepared, Settings]], rounds: int) -> list[float]:
    """Processor time of each run: median of interleaved rounds."""
    taken: list[list[float]] = [[] for _ in runs]
    for _ in range(rounds):
        for kept, (ready, settings) in zip(taken, runs, strict=True):
            start = time.process_time()
            run(ready, settings)
            kept.append(time.process_time() - start)
    return [statistics.median(kept) for kept in taken]
