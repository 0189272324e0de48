"""Mechanisms side by side are derived once and run in loops; each of them moves as one alone."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from codegen.scenes.motion_record import Record
from codegen.scenes.run import Prepared, Settings, prepare, run
from codegen.spec.scene_file import read_scene

from .preparations import EXAMPLES, told

COPIES = 3


@cache
def ready(count: int, form: str, index: int = 2) -> Prepared:
    text = (EXAMPLES / "in_line_engine.toml").read_text()
    return prepare(read_scene(text, "engine", count), Settings(form=form, index=index))


@cache
def engines(count: int, form: str, index: int = 2) -> Record:
    return told(ready(count, form, index), 0.4, outputs=40)


@pytest.mark.parametrize(("form", "index"), [("conventional", 2), ("parametric", 2), ("conventional", 1)])
def test_each_of_several_engines_moves_as_one_alone(form: str, index: int) -> None:
    alone, together = engines(1, form, index).trajectory, engines(COPIES, form, index).trajectory
    assert together.r.shape[1] == COPIES * alone.r.shape[1]
    for k in range(COPIES):
        own = slice(3 * k, 3 * k + 3)
        offset = np.array([0.0, 0.0, 0.1 * k])
        assert np.max(np.abs(together.r[:, own] - offset - alone.r)) < 1e-6
        assert np.max(np.abs(together.v[:, own] - alone.v)) < 1e-5


def test_constraints_of_all_engines_hold() -> None:
    assert np.max(engines(COPIES, "conventional").drift) < 1e-9


def test_steps_depend_neither_on_the_form_nor_on_the_number_of_engines() -> None:
    settings = Settings(duration=0.4, outputs=1, tolerance=1e-6)
    found = [ready(count, form) for count in (1, COPIES) for form in ("conventional", "parametric")]
    statistics = {run(each, settings).statistics for each in found}
    assert len(statistics) == 1


@pytest.mark.parametrize("form", ["conventional", "parametric"])
def test_equal_engines_share_one_elimination(form: str) -> None:
    assert ready(COPIES, form).equations.straight.kind.tolist() == [0] * COPIES
