"""The engine, ready to run in each formulation."""

from __future__ import annotations

import statistics
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path

from codegen.scenes.equations import equations
from codegen.scenes.run import Prepared, Settings, prepare, run
from codegen.spec.scene_file import read_scene

FORMS = ("conventional", "parametric")
HOW = {
    "conventional": Settings(form="conventional"),
    "parametric": Settings(form="parametric", derivative="substituted"),
}
"""The parametric form as S1 has it: the joint relation is inserted before differentiating again."""

FILE = Path(__file__).parents[2] / "examples" / "in_line_engine.toml"


@cache
def engine(form: str, sets: int = 1) -> Prepared:
    """Engines side by side, in space."""
    return prepare(read_scene(FILE.read_text(), FILE.name, sets), HOW[form])


@cache
def engine_with_less(form: str, left_out: tuple[str, ...]) -> Prepared:
    """One engine whose Jacobian lacks terms of `codegen.dynamics.jacobian.SECOND`."""
    ready = engine(form)
    return replace(ready, equations=equations(ready.system, "condensed", ready.y, ready.ydot, left_out))


def seconds(runs: Sequence[tuple[Prepared, Settings]], rounds: int) -> list[float]:
    """Processor time of each run: median of interleaved rounds."""
    taken: list[list[float]] = [[] for _ in runs]
    for _ in range(rounds):
        for kept, (ready, settings) in zip(taken, runs, strict=True):
            start = time.process_time()
            run(ready, settings)
            kept.append(time.process_time() - start)
    return [statistics.median(kept) for kept in taken]
