"""Scenes ready to run, each prepared once for all tests."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

from codegen.scenes import run
from codegen.scenes.motion_record import Record, record
from codegen.scenes.run import Prepared, Settings, prepare
from codegen.spec.scene_file import read_scene

EXAMPLES = Path(__file__).parents[2] / "examples"


@cache
def example(name: str, motion: str, form: str, derivative: str = "exact", index: int = 2) -> Prepared:
    """An example of the repository."""
    return prepared((EXAMPLES / f"{name}.toml").read_text(), motion, form, derivative, index)


def prepared(text: str, motion: str, form: str, derivative: str = "exact", index: int = 2) -> Prepared:
    """A scene file in a motion, form and index."""
    scene = read_scene(text, "scene.toml")
    scene = replace(scene, motion=motion, wanted=replace(scene.wanted, derivative=derivative))
    return prepare(scene, Settings(form=form, index=index))


def told(ready: Prepared, duration: float, tolerance: float = 1e-8, outputs: int = 100) -> Record:
    """Run a scene to its end."""
    done = run.run(ready, Settings(duration=duration, outputs=outputs, tolerance=tolerance))
    assert not done.failure
    return record(ready, done)
