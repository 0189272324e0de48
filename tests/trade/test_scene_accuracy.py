"""Scenes are judged at poses that are closed, and by the code that is emitted."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from codegen.measure.draw import sobol_points
from codegen.measure.judge import true_values
from codegen.measure.routine_builds import Build
from codegen.scenes.generate import generate_scene
from codegen.scenes.read import read
from codegen.trade.accuracy import measured
from codegen.trade.requests import SceneRequest
from codegen.trade.scene_domain import scene_domain
from codegen.trade.specimens import blocks_of, box_over, columns_of, poses_over, sample
from tests.cli.runs import REPOSITORY

FORMS = ("conventional", "parametric")


@pytest.fixture(scope="module", params=FORMS)
def request_(request: pytest.FixtureRequest) -> SceneRequest:
    scene, _ = read(REPOSITORY / "examples/four_bar.toml")
    return SceneRequest(scene, request.param, "phi", 16, False, scene_domain(scene))


@pytest.fixture(scope="module")
def routine(request_: SceneRequest) -> Any:
    (case,) = request_.cases()
    return case.routine()


def test_converged_poses_are_closed_to_twice_the_precision_and_go_far(request_: SceneRequest, routine: Any) -> None:
    poses = sample(routine, request_.domain, 32, True)
    phi = true_values(routine.straight, poses.ideal)["phi"]
    assert max(float(np.max(np.abs(entry.high))) for entry in phi) < 1e-30
    crank = np.arctan2(poses.ideal["A"][1].high, poses.ideal["A"][0].high)
    assert np.ptp(crank) > 2.0
    assert len(np.unique(np.round(crank, 9))) == 32


def test_poses_in_mid_iteration_are_off_by_the_misfit_and_in_the_box(request_: SceneRequest, routine: Any) -> None:
    points = sobol_points(32, columns_of(routine))
    poses = poses_over(routine, request_.domain, points, False)
    off = np.abs([entry.high for entry in true_values(routine.straight, poses.ideal)["phi"]])
    assert 1e-3 < np.median(off) < 0.2
    box = box_over(routine, request_.domain, "double")
    for name, entries in box.inputs.items():
        for (low, high), row in zip(entries, poses.given(np.float64)[name], strict=True):
            assert np.all((row >= low) & (row <= high)), name


def test_what_is_judged_is_what_is_emitted(request_: SceneRequest, routine: Any) -> None:
    wanted = replace(request_.scene.wanted, quantities=("phi",))
    files = generate_scene(replace(request_.scene, wanted=wanted), request_.form)
    assert str(routine.counts) in files["four_bar.h"].decode()


def test_eta_is_at_most_2_in_double_and_float(request_: SceneRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    few = (Build("double"), Build("float", "float"))
    monkeypatch.setattr("codegen.trade.requests.builds", lambda is_full: few)
    found = measured(request_)
    assert [candidate.build for candidate in found] == ["double", "float"]
    assert all(0 < candidate.eta <= 2.0 for candidate in found)
    assert found[0].error < 1e-15 < found[1].error < 1e-6


def test_rows_are_judged_by_their_units(request_: SceneRequest, routine: Any) -> None:
    names = [block.name for block in blocks_of(routine)]
    rotations = ["phi rotation"] if request_.form == "parametric" else []
    assert names == ["phi translation", *rotations]
