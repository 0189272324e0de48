"""What is measured of a scene in its three forms."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from codegen.chains import simulate as chain_simulate
from codegen.chains import simulate_scene
from codegen.chains.beside import ABSOLUTE, forms_beside
from codegen.measure.threads import one_thread
from codegen.report.form_sheets import form_result
from codegen.scenes import run as scene_run
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

EXAMPLES = Path(__file__).parents[2] / "examples"
DURATION = 1.0
"""s, of a run."""

TOLERANCE = 1e-6


def measured(name: str, rounds: int) -> dict[str, Any]:
    """Operations, times of one evaluation and processor times of a run, form by form.

    Args:
        name: of an example.
        rounds: interleaved rounds of the runs.
    """
    scene = read_scene((EXAMPLES / f"{name}.toml").read_text(), name)
    found = form_result(scene.name, forms_beside(scene), True).data
    runs = {**{form: _absolute(scene, form) for form in ABSOLUTE}, "relative": _relative(scene)}
    for entry, seconds in zip(found["forms"], _interleaved(runs, rounds), strict=True):
        entry["run"] = seconds
    return dict(found)


def _absolute(scene: Scene, form: str) -> Callable[[], object]:
    settings = scene_run.Settings(form=form, duration=DURATION, outputs=1, tolerance=TOLERANCE)
    prepared = scene_run.prepare(scene, settings)
    return lambda: scene_run.run(prepared, settings)


def _relative(scene: Scene) -> Callable[[], object]:
    ready = simulate_scene.prepare(scene, chain_simulate.Settings("forward", DURATION, 1, TOLERANCE))
    return lambda: chain_simulate.run(ready.mechanism, {}, ready.settings, lambda _: None)


def _interleaved(runs: dict[str, Callable[[], object]], rounds: int) -> list[float]:
    """Processor time of each run, s: median of rounds."""
    taken: dict[str, list[float]] = {form: [] for form in runs}
    with one_thread():
        for _ in range(rounds):
            for form, run in runs.items():
                start = time.process_time()
                run()
                taken[form].append(time.process_time() - start)
    return [statistics.median(taken[form]) for form in runs]
