"""``jointgen simulate``: what it refuses, what it writes, and what an interruption leaves."""

from __future__ import annotations

import importlib.util
import json
import os
import signal
import time
from pathlib import Path

import pytest

from codegen.simulate.sundials import sundials

from .runs import contents, finish, invoke, refused, snapshot, spawn
from .terminal import CTRL_C, Terminal

STONE = """
name = "stone"
[[body]]
name = "stone"
mass = 1.0
inertia = [1.0, 2.0, 3.0]
angular_velocity = [0.01, 5.0, 0.0]
velocity = [0.0, 1.0, 0.0]
"""
LONG = ("--duration", "2000", "--outputs", "20000", "--tol", "1e-9")


@pytest.fixture
def stone(tmp_path: Path) -> Path:
    file = tmp_path / "stone.toml"
    file.write_text(STONE)
    return file


def test_a_run_is_a_few_files_and_a_line(stone: Path, tmp_path: Path) -> None:
    done = invoke("simulate", stone, "-o", tmp_path / "run")
    assert done.exit_code == 0
    assert done.stdout.startswith(f"{tmp_path / 'run'}: 1 s in ")
    assert len(done.stdout.splitlines()) == 1
    assert done.stderr == ""
    assert sorted(contents(tmp_path / "run")) == ["manifest.json", "plot.svg", "summary.json", "trajectory.csv"]


def test_all_bad_options_are_told_at_once(stone: Path, tmp_path: Path) -> None:
    wrong = ("--tol", "0", "--duration", "-1", "--outputs", "0", "--index", "3", "--form", "x")
    before = snapshot(tmp_path)
    lines = refused(invoke("simulate", stone, *wrong, "-o", tmp_path / "run"))
    assert [line.split(":")[0] for line in lines] == ["--tol", "--duration", "--outputs", "--index", "--form"]
    assert snapshot(tmp_path) == before


def test_drives_that_leave_each_other_nothing_to_move_are_refused_with_their_file(tmp_path: Path) -> None:
    rails = "".join(
        f"""
[[joint]]
name = "rail {k}"
type = "translational"
bodies = ["ground", "stone"]
point = [0.0, {k}.0, 0.0]
axis = [1.0, 0.0, 0.0]
drive = {{ position = 0.0, speed = {k}.0 }}
"""
        for k in (1, 2)
    )
    file = tmp_path / "sledge.toml"
    file.write_text(STONE + rails)
    before = snapshot(tmp_path)
    (line,) = refused(invoke("simulate", file, "-o", tmp_path / "run"))
    assert line.startswith(f'{file}: joint "rail 2": drive: nothing is left to move at t = 0: ')
    assert 'the joints and the drive of "rail 1" determine its coordinate; remove a drive' in line
    assert snapshot(tmp_path) == before


def test_relative_coordinates_refuse_what_only_equations_of_bodies_have(stone: Path, tmp_path: Path) -> None:
    wrong = ("--form", "relative", "--index", "1", "--through-singular", "--derivative", "exact")
    lines = refused(invoke("simulate", stone, *wrong, "-o", tmp_path / "run"))
    assert sorted(line.split(":")[0] for line in lines) == ["--derivative", "--index", "--through-singular"]


def test_a_run_by_relative_coordinates_has_the_columns_of_the_others(stone: Path, tmp_path: Path) -> None:
    heads = []
    for name, form in (("one", "conventional"), ("other", "relative")):
        short = ("--duration", "0.2", "--outputs", "4")
        assert invoke("simulate", stone, "--form", form, *short, "-o", tmp_path / name).exit_code == 0
        heads.append((tmp_path / name / "trajectory.csv").read_text().splitlines()[0])
    assert heads[0] == heads[1]


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    (line,) = refused(invoke("simulate", tmp_path / "none.toml", "-o", tmp_path / "run"))
    assert "none.toml: cannot be read (No such file or directory)" in line


def test_a_scene_with_mistakes_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(STONE.replace("mass = 1.0", "mass = -1.0").replace("inertia", "inertai"))
    assert len(refused(invoke("simulate", file, "-o", tmp_path / "run"))) > 1
    assert not (tmp_path / "run").exists()


def test_missing_tools_are_told_at_once_with_their_remedies(
    stone: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    sundials.cache_clear()
    lines = refused(invoke("simulate", stone, "-o", tmp_path / "run"))
    sundials.cache_clear()
    assert lines == [
        "compiler: there is no C compiler (cc, gcc or clang); install gcc",
        "simulate: scikit-sundae is not installed; pip install 'jointgen[simulate]'",
    ]


def test_two_runs_with_different_hash_seeds_write_the_same_trajectory(stone: Path, tmp_path: Path) -> None:
    found = []
    for seed in ("1", "2"):
        target = tmp_path / f"run{seed}"
        code, _, err = finish(spawn("simulate", stone, "-o", target, PYTHONHASHSEED=seed))
        assert (code, err) == (0, "")
        found.append(contents(target))
    summaries = [json.loads(files.pop("summary.json")) for files in found]
    for told in summaries:
        assert told.pop("wall_time") > 0
    assert found[0] == found[1]
    assert summaries[0] == summaries[1]


def test_progress_shows_on_a_terminal(stone: Path, tmp_path: Path) -> None:
    terminal = Terminal("simulate", stone, *LONG, "-o", tmp_path / "run")
    assert terminal.wait_for(r"simulating .*\b[1-9]\d*/20000\b")
    terminal.press(CTRL_C)
    assert terminal.finish() == 1
    assert "jointgen: interrupted; nothing was written" in terminal.shown
    assert "Traceback" not in terminal.shown
    assert [path.name for path in tmp_path.iterdir()] == ["stone.toml"]


def test_a_killed_run_leaves_the_results_before(stone: Path, tmp_path: Path) -> None:
    assert invoke("simulate", stone, "-o", tmp_path / "run").exit_code == 0
    before = snapshot(tmp_path / "run")
    process = spawn("simulate", stone, *LONG, "-o", tmp_path / "run")
    time.sleep(2.0)
    assert process.poll() is None
    os.killpg(process.pid, signal.SIGKILL)
    finish(process)
    assert snapshot(tmp_path / "run") == before


OPEN = """
[[joint]]
name = "hook"
type = "ball"
bodies = ["ground", "stone"]
points = [[0.0, 0.0, 0.001], [0.0, 0.0, 0.0]]
axes = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
"""


def test_a_joint_that_is_open_by_a_millimetre_is_refused_with_its_gap_or_closed_when_asked(tmp_path: Path) -> None:
    file = tmp_path / "open.toml"
    file.write_text(STONE + OPEN)
    (line,) = refused(invoke("simulate", file, "-o", tmp_path / "run"))
    assert 'joint "hook"' in line
    assert "it is 1 mm apart" in line
    assert "assemble = true" in line
    file.write_text("assemble = true\n" + STONE + OPEN)
    done = invoke("simulate", file, "--duration", "0.1", "-o", tmp_path / "run")
    assert done.exit_code == 0
    assert f"{file}: bodies were moved by up to 0.001 m to close the joints at the start" in done.stderr
