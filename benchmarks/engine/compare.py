"""The engine in our runs and in other programs: processor time of 1 s at an error of 1e-6 m."""

from __future__ import annotations

import importlib
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import numpy as np

from benchmarks.engine.mechanism import FILE
from benchmarks.engine.others import ours
from codegen.measure.constraints import Array
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene
from tests.simulate.engine import truth

ERROR = 1e-6
"""m, the largest of all positions at `OUTPUTS` times."""

OUTPUTS = 20
LONGEST = 4.0
"""s, of a run; larger mechanisms are left out."""

OTHERS = MappingProxyType({"CasADi idas": "idas", "MuJoCo": "mujoco", "Exudyn": "exudyn"})

Ready = Callable[..., Callable[[float], Array]]


@dataclass(frozen=True, slots=True)
class Program:
    """A program that runs the engine.

    Attributes:
        name: of it.
        ready: scene, sets, outputs -> a run at a setting.
        settings: tolerances or steps, from loose to tight.
    """

    name: str
    ready: Ready
    settings: tuple[float, ...]


def programs() -> tuple[list[Program], list[str]]:
    """Those that are there, and the names of those that are not installed."""
    found = [
        Program("conventional", ours.conventional, ours.SETTINGS),
        Program("parametric", ours.parametric, ours.SETTINGS),
        Program("conventional, in the plane", ours.planar, ours.SETTINGS),
    ]
    missing = []
    for name, module in OTHERS.items():
        try:
            other: Any = importlib.import_module(f"benchmarks.engine.others.{module}")
        except ImportError:
            missing.append(name)
            continue
        found.append(Program(name, other.ready, other.SETTINGS))
    return found, missing


def compared(sizes: Sequence[int], rounds: int) -> dict[str, Any]:
    """Settings, errors and times of all programs."""
    found, missing = programs()
    scene = read_scene(FILE.read_text(), FILE.name)
    true = truth(np.linspace(0.0, 1.0, OUTPUTS + 1)).r
    rows = [{"program": program.name, **_errors(program, scene, true), "seconds": {}} for program in found]
    for sets in sizes:
        reached = [k for k, row in enumerate(rows) if sets == sizes[0] or _is_short(row, sets)]
        runs = [(found[k].ready(scene, sets, 1), rows[k]["setting"]) for k in reached]
        for k, seconds in zip(reached, _interleaved(runs, rounds), strict=True):
            rows[k]["seconds"][str(sets)] = seconds
    return {"rows": rows, "missing": missing}


def _errors(program: Program, scene: Scene, true: Array) -> dict[str, Any]:
    """The loosest setting from which on errors are small enough, with its error, and the finest setting."""
    run = program.ready(scene, 1, OUTPUTS)
    errors = [float(np.max(np.abs(run(setting) - true))) for setting in program.settings]
    first = next(k for k in range(len(errors)) if max(errors[k:]) <= ERROR)
    best = int(np.argmin(errors))
    return {
        "setting": program.settings[first],
        "error": errors[first],
        "finest": {"setting": program.settings[best], "error": errors[best]},
    }


def _is_short(row: dict[str, Any], sets: int) -> bool:
    last = max(map(int, row["seconds"]))
    return bool(row["seconds"][str(last)] * sets / last <= LONGEST)


def _interleaved(runs: Sequence[tuple[Callable[[float], Array], float]], rounds: int) -> list[float]:
    """Processor time of each run: median of interleaved rounds, of fewer where a run is long."""
    taken: list[list[float]] = [[] for _ in runs]
    for number in range(rounds + 1):  # the first one warms up
        for kept, (run, setting) in zip(taken, runs, strict=True):
            if kept and sum(kept) > LONGEST:
                continue
            start = time.process_time()
            run(setting)
            kept.append(time.process_time() - start)
            if not number and kept[0] < 1.0:
                kept.clear()
    return [statistics.median(kept) for kept in taken]
