"""What `jointgen accuracy` says of a routine is true of the compiled routine."""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.measure.errors import figures, truth
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import sample_poses
from codegen.measure.routine_builds import NATIVE, SAME_BITS, Build, built
from codegen.spec.request import Variant
from codegen.trade.accuracy import Candidate, document, front, measured
from codegen.trade.builds import BASE, builds
from codegen.trade.programs import routines
from codegen.trade.requests import AccuracyRequest
from codegen.trade.specimens import blocks_of
from tests.cli.runs import invoke

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
SMALL = AccuracyRequest(("ball",), form="conventional", samples=32, output="phi", is_counted=False)
VARIANT = Variant("revolute", "parametric", "regular", "substituted")
DOMAIN = PoseDomain()


@pytest.fixture(scope="module")
def small() -> tuple[Candidate, ...]:
    return measured(SMALL)


def errors(candidates: tuple[Candidate, ...]) -> list[Any]:
    return [(c.routine, c.build, c.figures) for c in candidates]


def test_errors_are_identical_in_every_run(small: tuple[Candidate, ...]) -> None:
    assert errors(measured(SMALL)) == errors(small)


def test_every_build_without_angles_is_measured_once(small: tuple[Candidate, ...]) -> None:
    names = [c.build for c in small if c.routine == "jg_ball_conventional_phi"]
    assert names == sorted(set(names), key=names.index)
    assert {"double", "float", "double, 4 lanes", "float, 8 lanes", "long double"} <= set(names)
    assert not any("sin" in name for name in names)
    assert set(names) <= {build.name for build in builds(is_full=True)}


def test_a_better_number_type_has_smaller_errors(small: tuple[Candidate, ...]) -> None:
    error = {c.build: c.error for c in small if c.routine == "jg_ball_conventional_phi"}
    assert 0 < error["long double"] < 1e-2 * error["double"] < 1e-4 * error["float"]


def test_the_front_holds_no_routine_that_another_beats(small: tuple[Candidate, ...]) -> None:
    best = front(small)
    for candidate in best:
        assert not [c for c in small if c.nanoseconds < candidate.nanoseconds and c.error <= candidate.error]
    assert min(small, key=lambda c: c.nanoseconds) in best
    assert min(c.error for c in small) == best[-1].error


@pytest.mark.parametrize(
    "build",
    [Build("double"), Build("lanes", lanes=4, flags=(*NATIVE, *SAME_BITS), trigonometry="own")],
    ids=["scalar", "lanes"],
)
def test_builds_evaluate_the_program(build: Build, tmp_path: Path) -> None:
    """A pose count that does not fill the last group of lanes; the angle's functions differ in the last place."""
    routine = next(r for r in routines(VARIANT) if r.output == "all")
    program = routine.straight
    poses = sample_poses(blocks_joint(routine), VARIANT, program.arguments, DOMAIN, 7, is_converged=True)
    given = poses.given(np.float64)
    found = built(routine, build, tmp_path).values(given)
    for name, entries in evaluate(program, given, numpy_domain()).items():
        expected = np.array([entry + np.zeros(7) for entry in entries]).reshape(found[name].shape)
        np.testing.assert_allclose(found[name], expected, rtol=0, atol=2e-15)


def test_a_spoilt_value_shows_in_the_figures() -> None:
    routine = next(r for r in routines(VARIANT) if r.output == "phi")
    program = routine.straight
    poses = sample_poses(blocks_joint(routine), VARIANT, program.arguments, DOMAIN, 8, is_converged=True)
    known = truth(program, poses, "double")
    values = {name: np.array(entries) for name, entries in evaluate(program, known.inputs, numpy_domain()).items()}
    values["phi"][4, 5] += 1e-9
    translation, rotation = figures(known, values, blocks_of(routine), DOMAIN)
    assert translation.largest < 1e-15
    assert rotation.largest == pytest.approx(1e-9, rel=1e-5)
    assert rotation.worst_pose == 5
    assert rotation.eta > 1e5


def blocks_joint(routine: Any) -> Any:
    return routine.subject.joint


def test_the_command_writes_data_tables_and_fronts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.trade.requests.builds", lambda _: BASE)
    words = ("ball", "--form", "conventional", "--output", "phi", "--samples", "16")
    for _ in range(2):
        result = invoke("accuracy", *words, "-o", tmp_path / "out")
        assert result.exit_code == 0, result.stderr
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert names == {"manifest.json", "accuracy.json", "accuracy.md", "pareto_ball.svg"}
    data = json.loads((tmp_path / "out/accuracy.json").read_text())
    assert data["candidates"] == json.loads(json.dumps(document(*measured_again())))["candidates"]


def measured_again() -> tuple[AccuracyRequest, tuple[Candidate, ...]]:
    request = AccuracyRequest(("ball",), form="conventional", samples=16, output="phi", is_counted=False)
    return request, measured(request)


def test_all_mistakes_are_told_at_once() -> None:
    result = invoke("accuracy", "bal", "--output", "phy", "--samples", "0")
    assert result.exit_code == 2
    assert [line.partition(":")[0] for line in result.stderr.splitlines()] == ["--output", "--samples", "joint bal"]
