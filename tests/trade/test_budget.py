"""The budget's verdicts: what is called proven is bounded, what is called impossible is beyond the best."""

from __future__ import annotations

import json
import shutil
import signal
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from codegen.measure.errors import number_type
from codegen.measure.judge import by_program
from codegen.measure.pose_domain import PoseDomain
from codegen.spec.request import Variant
from codegen.trade.budget import Answer, answered, worst_inputs
from codegen.trade.builds import BASE
from codegen.trade.domain_checks import joint_check
from codegen.trade.domain_text import read_domain
from codegen.trade.programs import routines
from codegen.trade.requests import AccuracyRequest
from codegen.trade.specimens import sample
from tests.cli.runs import REPOSITORY, invoke

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
REQUEST = AccuracyRequest(("ball",), form="conventional", output="phi")
FAR = replace(REQUEST, domain=PoseDomain(distance=1e6))


@pytest.fixture(autouse=True)
def _few_builds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Double and float: two libraries to compile; a short search."""
    monkeypatch.setattr("codegen.trade.judgement.SAMPLES", 64)
    monkeypatch.setattr("codegen.trade.judgement.SEARCH_ROUNDS", 1)
    monkeypatch.setattr("codegen.trade.requests.builds", lambda is_full: BASE)


def chosen(answer: Answer) -> tuple[str, str]:
    return answer.verdict, answer.chosen.build


def test_a_generous_budget_is_proven() -> None:
    answer = answered(REQUEST, 1e-3)
    assert answer.verdict == "PROVEN"
    assert not answer.losers
    best = answer.chosen
    assert 0 < best.sampled <= best.searched <= best.guaranteed <= 1e-3


def test_between_the_number_types_double_is_proven_and_float_loses() -> None:
    answer = answered(REQUEST, 1e-10)
    assert chosen(answer) == ("PROVEN", "double")
    assert all(loser.build == "float" and loser.searched > 1e-10 for loser in answer.losers)


def test_between_search_and_bound_it_is_measured() -> None:
    known = answered(REQUEST, 1e-10).chosen
    answer = answered(REQUEST, 3 * known.searched)
    assert chosen(answer) == ("MEASURED", "double")
    assert answer.chosen.guaranteed > 3 * known.searched


def test_far_from_the_origin_it_is_impossible_and_the_relative_position_is_the_cure() -> None:
    answer = answered(FAR, 1e-13)
    assert answer.verdict == "IMPOSSIBLE"
    assert answer.chosen.floor > 1e-11
    (cure,) = answer.cures
    assert "relative position" in cure.name
    assert cure.searched < 1e-15


def test_drifted_attitudes_are_cured_by_orthonormalising() -> None:
    answer = answered(replace(REQUEST, domain=PoseDomain(drift=1e-6)), 1e-9)
    assert answer.verdict == "IMPOSSIBLE"
    assert [cure.name for cure in answer.cures] == ["orthonormalise the attitudes"]


def test_the_worst_pose_is_told_to_the_bit() -> None:
    answer = answered(FAR, 1e-13)
    inputs = worst_inputs(FAR, answer.chosen)
    assert inputs == worst_inputs(FAR, answered(FAR, 1e-13).chosen)
    assert float.fromhex(inputs["r_i"][0]) == pytest.approx(0.36e6, rel=1e-5)
    A = np.array([float.fromhex(entry) for entry in inputs["A_i"]]).reshape(3, 3)
    np.testing.assert_allclose(A @ A.T, np.eye(3), atol=1e-15)


def test_a_domain_is_read_and_its_mistakes_are_told_at_once() -> None:
    assert read_domain("r=2, s=0.5 distance=1e6") == PoseDomain(r=2.0, s=0.5, distance=1e6)
    result = invoke("budget", "ball", "--max-error", "1e-8", "--domain", "q=1 r=-1 s=nan d")
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 4


def command(*words: str) -> tuple[Any, Any]:
    result = invoke("budget", *words, "--form", "conventional", "--output", "phi", "--json")
    return result.exit_code, json.loads(result.stdout)


def test_the_exit_code_says_whether_the_budget_can_be_met() -> None:
    code, data = command("ball", "--max-error", "1e-8")
    assert (code, data["verdict"]) == (0, "PROVEN")
    code, data = command("ball", "--max-error", "1e-30")
    assert (code, data["verdict"]) == (1, "IMPOSSIBLE")


def test_the_chosen_routine_is_written(tmp_path: Path) -> None:
    words = ("ball", "--max-error", "1e-3", "--form", "conventional", "--output", "phi", "--json")
    result = invoke("budget", *words, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    data = json.loads(result.stdout)
    manifest = json.loads((tmp_path / "out/manifest.json").read_text())
    (function,) = manifest["functions"]
    assert function["symbol"] == data["chosen"]["routine"]
    assert function["real"] == data["chosen"]["build"]
    assert exit_code_at_zero(function, tmp_path) == 0
    assert exit_code_at_zero(function, tmp_path, "-DJG_ASSERT_DOMAIN") == -signal.SIGABRT
    assert exit_code_at_zero(function, tmp_path, "-DJG_ASSERT_DOMAIN", "-DNDEBUG") == 0


def exit_code_at_zero(function: Any, folder: Path, *flags: str) -> int:
    """Call the routine with attitudes that are zero, and so no rotations."""
    main = folder / "main.c"
    call = f"{function['symbol']}(zeros, zeros, zeros, zeros, zeros, phi)"
    main.write_text(
        '#include "jointgen/jointgen.h"\n'
        f"int main(void) {{ static const jg_real zeros[24]; jg_real phi[3]; {call}; return 0; }}\n"
    )
    warnings = ("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror")
    sources = [str(main), str(folder / "out" / function["source"])]
    program = folder / "main"
    command = ["gcc", *warnings, *flags, f"-I{folder / 'out/c/include'}", *sources, "-o", str(program), "-lm"]
    subprocess.run(command, check=True)
    return subprocess.run([str(program)], capture_output=True, check=False).returncode


@pytest.mark.parametrize("real", ["double", "float"])
def test_the_assertions_hold_just_in_the_domain(real: str) -> None:
    domain = PoseDomain(s=0.2, drift=1e-6 if real == "double" else 0.0)
    routine = next(r for r in routines(Variant("translational", "conventional", None)) if r.output == "phi")
    check = joint_check(domain, real, routine)
    for is_converged in (True, False):
        given = sample(routine, domain, 64, is_converged).given(number_type(real))
        assert outside(check, given) == 0
    for name, entry, value in (("r_i", 0, 1.1), ("A_j", 4, 0.9), ("geometry", 12, 0.2), ("r_j", 2, np.nan)):
        spoilt = given[name].copy()
        spoilt[entry] = value
        assert outside(check, given | {name: spoilt}) >= 1
    apart = given | {"r_j": given["r_i"] + np.array([[0.0], [0.0], [2.0]], dtype=given["r_i"].dtype)}
    assert outside(check, apart) >= 1


def outside(check: Any, given: Any) -> float:
    """Most conditions that are broken at a pose."""
    return float(np.max(by_program(check)(given)["outside"][0]))


def test_the_routine_of_a_scene_is_judged_and_written(tmp_path: Path) -> None:
    words = ("--max-error", "1e-8", "--form", "conventional", "--output", "phi", "--json")
    result = invoke("budget", REPOSITORY / "examples/four_bar.toml", *words, "-o", tmp_path / "out")
    assert result.exit_code == 0, result.stderr
    data = json.loads(result.stdout)
    assert (data["verdict"], data["chosen"]["build"]) == ("PROVEN", "double")
    assert data["request"] == {"scene": "four_bar", "form": "conventional", "output": "phi"}
    assert data["domain"]["s"] < 1.0
    (function,) = json.loads((tmp_path / "out/manifest.json").read_text())["functions"]
    assert f"{function['symbol']} --form conventional" == data["chosen"]["routine"]


def test_what_a_scene_has_no_choice_of_is_refused() -> None:
    scene = str(REPOSITORY / "examples/four_bar.toml")
    result = invoke("budget", scene, "--max-error", "1e-8", "--rows", "regular", "--derivative", "exact")
    assert result.exit_code == 2
    assert [line.partition(":")[0] for line in result.stderr.splitlines()] == ["--rows", "--derivative"]
    result = invoke("budget", scene, "--max-error", "0", "--form", "free", "--output", "phy", "--domain", "distance=1")
    assert result.exit_code == 2
    assert len(result.stderr.splitlines()) == 4


def test_no_error_is_no_budget() -> None:
    result = invoke("budget", "bal", "--max-error", "0")
    assert result.exit_code == 2
    assert [line.partition(":")[0] for line in result.stderr.splitlines()] == ["--max-error", "joint bal"]
