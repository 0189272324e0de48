"""Our runs, as the other programs are run."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

from benchmarks.engine.mechanism import FILE, HOW, engine
from codegen.measure.constraints import Array
from codegen.scenes.motion_record import record
from codegen.scenes.run import Prepared, Settings, prepare, run
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

SETTINGS = tuple(10.0 ** -(k / 4) for k in range(16, 41))
"""Tolerances, from loose to tight."""


@cache
def _prepared(form: str, motion: str, sets: int) -> Prepared:
    if motion == "spatial":
        return engine(form, sets)
    return prepare(replace(read_scene(FILE.read_text(), FILE.name, sets), motion=motion), HOW[form])


def _ready(form: str, motion: str, scene: Scene, sets: int, outputs: int) -> Callable[[float], Array]:
    prepared = _prepared(form, motion, sets)

    def once(tolerance: float) -> Array:
        done = run(prepared, Settings(duration=1.0, outputs=max(1, outputs), tolerance=tolerance))
        return record(prepared, done).trajectory.r[:, :3, :2] if outputs > 1 else done.y

    return once


conventional = partial(_ready, "conventional", "spatial")
parametric = partial(_ready, "parametric", "spatial")
planar = partial(_ready, "conventional", "planar")
