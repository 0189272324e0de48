"""What is measured of a scene in its three forms: operations, times, and how exact runs are."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.chains import simulate as chain_simulate
from codegen.chains import simulate_scene
from codegen.chains.beside import ABSOLUTE, forms_beside
from codegen.chains.record import record
from codegen.chains.scene_motion import scene_motion
from codegen.measure.threads import one_thread
from codegen.report.form_sheets import form_result
from codegen.scenes import motion_record
from codegen.scenes import run as scene_run
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

EXAMPLES = Path(__file__).parents[2] / "examples"
DURATION = 1.0
"""s, of a run."""

TOLERANCE = 1e-6

EXACT = 1e-12
"""Tolerance of the run from which errors count."""

Array = NDArray[np.float64]


def measured(name: str, rounds: int) -> dict[str, Any]:
    """Operations, times of one evaluation and processor times of a run, form by form.

    Args:
        name: of an example.
        rounds: interleaved rounds of the runs.
    """
    scene = read_scene((EXAMPLES / f"{name}.toml").read_text(), name)
    found = form_result(scene.name, forms_beside(scene), True).data
    runs = {**{form: _absolute(scene, form) for form in ABSOLUTE}, "relative": _relative(scene)}
    true = runs[ABSOLUTE[0]].end(EXACT)
    for entry, seconds in zip(found["forms"], _interleaved(runs, rounds), strict=True):
        entry["run"] = seconds
        entry["error"] = float(np.max(np.abs(runs[entry["form"]].end(TOLERANCE) - true)))
    return dict(found)


@dataclass(frozen=True, slots=True)
class _Form:
    """A scene in a form, ready to run.

    Attributes:
        run: at a tolerance.
        positions: [n, nb, 3] m of the bodies at the outputs of what a run gives.
    """

    run: Callable[[float], Any]
    positions: Callable[[Any], Array]

    def end(self, tolerance: float) -> Array:
        """Positions at the end of a run."""
        return np.asarray(self.positions(self.run(tolerance))[-1])


def _absolute(scene: Scene, form: str) -> _Form:
    settings = scene_run.Settings(form=form, duration=DURATION, outputs=1)
    prepared = scene_run.prepare(scene, settings)
    return _Form(
        lambda tolerance: scene_run.run(prepared, replace(settings, tolerance=tolerance)),
        lambda done: motion_record.record(prepared, done).trajectory.r,
    )


def _relative(scene: Scene) -> _Form:
    ready = simulate_scene.prepare(scene, chain_simulate.Settings("forward", DURATION, 1))
    return _Form(
        lambda tolerance: chain_simulate.run(
            ready.mechanism, {}, replace(ready.settings, tolerance=tolerance), lambda _: None
        ),
        lambda done: scene_motion(scene, ready.relative, record(ready.mechanism, ready.equations, done)).r,
    )


def _interleaved(runs: dict[str, _Form], rounds: int) -> list[float]:
    """Processor time of each run, s: median of rounds."""
    taken: dict[str, list[float]] = {form: [] for form in runs}
    with one_thread():
        for _ in range(rounds):
            for form, run in runs.items():
                start = time.process_time()
                run.run(TOLERANCE)
                taken[form].append(time.process_time() - start)
    return [statistics.median(taken[form]) for form in runs]
