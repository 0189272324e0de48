"""What is said where: results on stdout, progress on a terminal's stderr only, JSON that parses."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import codegen
from codegen.mechanics.joints import JOINTS
from tests.spec.texts import PENDULUM

from .runs import COMMAND, REPOSITORY, SMALL, contents, finish, invoke, refused, spawn
from .terminal import Terminal


def test_generate_is_silent_on_stderr_in_a_pipe(tmp_path: Path) -> None:
    code, out, err = finish(spawn("generate", "rigid", "-o", tmp_path / "package"))
    assert (code, err) == (0, "")
    assert re.fullmatch(rf"{tmp_path / 'package'}: \d+ functions in \d+ files\n", out)


def test_a_progress_bar_appears_on_a_terminal(tmp_path: Path) -> None:
    terminal = Terminal("generate", "ball", "--outputs", "phi", "-o", tmp_path / "package")
    assert terminal.finish() == 0
    assert re.search(r"generating ball_\w+", terminal.shown), "the variant that is done is named"
    assert re.search(r"[━╸]", terminal.shown), "a bar"
    assert re.search(r"\b6/6\b", terminal.shown)
    assert re.search(r"package: 6 functions in \d+ files\s*$", terminal.shown)


def test_joints_as_json_is_the_catalogue() -> None:
    result = invoke("joints", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    rows: list[dict[str, Any]] = json.loads(result.stdout)
    assert [row["joint"] for row in rows] == list(JOINTS)
    assert {row["joint"]: row["dof"] for row in rows} == {joint.name: joint.dof for joint in JOINTS.values()}
    for row in rows:
        assert row["operations_conventional"] > 0 < row["operations_parametric"]


def test_flops_as_json_compares_every_joint() -> None:
    result = invoke("flops", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    text = result.stdout
    assert json.loads(text)
    for joint in JOINTS:
        assert f'"{joint}"' in text


def test_flops_prints_the_tables_in_a_pipe() -> None:
    result = invoke("flops", "--rules", "paper", "--table", "2")
    assert (result.exit_code, result.stderr) == (0, "")
    assert "\x1b" not in result.stdout, "no colours in a pipe"
    for words in ("dot-1", "dot-2", "spherical", "screw"):
        assert words in result.stdout


def test_flops_of_a_scene_lays_its_forms_side_by_side(tmp_path: Path) -> None:
    """Of a pendulum on one joint M is constant, and gravity is a cosine by the mass moment by g."""
    (tmp_path / "pendulum.toml").write_text(PENDULUM)
    result = invoke("flops", tmp_path / "pendulum.toml", "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    forms = {entry["form"]: entry for entry in json.loads(result.stdout)["forms"]}
    sizes = {form: (entry["unknowns"], entry["rows"]) for form, entry in forms.items()}
    assert sizes == {"conventional": (6, 5), "parametric": (7, 6), "relative": (1, 0)}
    assert forms["relative"]["with_gamma"] == {"operations": 3} and "with_second" not in forms["relative"]
    lines = refused(invoke("flops", tmp_path / "pendulum.toml", "--table", "2", "--model", "fma"))
    assert [line.partition(":")[0] for line in lines] == ["--table", "--model"]
    assert refused(invoke("flops", "--measure"))[0].startswith("--measure")


@pytest.mark.parametrize("stage", ["model", "program"])
def test_a_stage_is_printed_and_nothing_written(stage: str, tmp_path: Path) -> None:
    result = invoke(*SMALL, "--dump", stage, "-o", tmp_path / "package")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("# jg_ball_conventional_phi\n")
    assert result.stdout == invoke(*SMALL, "--dump", stage).stdout
    assert not list(tmp_path.iterdir())


def test_the_module_is_the_command() -> None:
    script = Path(sys.executable).with_name("jointgen")
    if not script.exists():
        pytest.skip("jointgen is not installed beside this python")
    for arguments in (["--version"], ["generate", "--help"], ["generate", "nojoint"]):
        runs = [
            subprocess.run([*command, *arguments], capture_output=True, text=True, check=False, cwd=REPOSITORY)
            for command in (COMMAND, [str(script)])
        ]
        assert [run.returncode for run in runs] == [2 if "nojoint" in arguments else 0] * 2
        assert runs[0].stdout == runs[1].stdout
        assert runs[0].stderr == runs[1].stderr
    assert codegen.__version__ in invoke("--version").stdout


def test_two_processes_with_other_hash_seeds_and_folders_give_the_same_bytes(tmp_path: Path) -> None:
    request = ("generate", "revolute", "ball", "--outputs", "phi,phi_q")
    targets = [tmp_path / "one", tmp_path / "another/deeper"]
    runs = [spawn(*request, "-o", target, PYTHONHASHSEED=str(seed)) for seed, target in enumerate(targets, 1)]
    assert [finish(run)[0] for run in runs] == [0, 0]
    first, second = (contents(target) for target in targets)
    assert first == second
    assert len(first) > 40
    for name, data in first.items():
        assert str(tmp_path).encode() not in data, name
