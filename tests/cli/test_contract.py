"""Promises of the command line to other programs: where a mistake stands, what a summary holds, forms in a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from .runs import invoke, refused
from .test_chain_run import CRANK, PENDULUM, table

SLIDE = """
name = "slide"
gravity = [0.0, -9.81, 0.0]
[[body]]
name = "block"
mass = 2.0
inertia = [0.1, 0.2, 0.3]
[[joint]]
name = "rail"
type = "translational"
bodies = ["ground", "block"]
point = [0.0, 0.0, 0.0]
axis = [1.0, 0.0, 0.0]
"""
QUICK_RETURN = CRANK.with_name("quick_return.toml")
SHORT = ("--duration", "0.1", "--outputs", "4")
COUNTS = (
    "rows",
    "rank",
    "dropped_rows",
    "dof",
    "steps",
    "evaluations",
    "constraint_drift",
    "energy_drift",
    "wall_time",
)


def scene(folder: Path, text: str) -> Path:
    file = folder / "scene.toml"
    file.write_text(text)
    return file


def summary(folder: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((folder / "summary.json").read_text())
    return found


@pytest.mark.parametrize("command", [("chain",), ("simulate",)])
def test_cuts_that_are_open_are_told_with_their_file(command: tuple[str, ...], tmp_path: Path) -> None:
    file = tmp_path / "open.toml"
    file.write_text(CRANK.read_text().replace("theta = ", "theta = 0.1 #"))
    (line,) = refused(invoke(*command, file, "-o", tmp_path / "out"))
    assert line.startswith(f'{file}: cut "slide axis": is open by ')


def test_a_body_without_mass_is_told_with_its_file(tmp_path: Path) -> None:
    file = scene(
        tmp_path, SLIDE.replace("mass = 2.0\ninertia = [0.1, 0.2, 0.3]", "") + "[output]\nquantities = ['phi']"
    )
    (line,) = refused(invoke("simulate", file, "-o", tmp_path / "out"))
    assert line.startswith(f'{file}: body "block": has no mass; ')


def test_a_name_with_a_line_break_keeps_a_mistake_on_its_line(tmp_path: Path) -> None:
    (line,) = refused(invoke("scene", tmp_path / "a\nb.toml", "-o", tmp_path / "out"))
    assert line.startswith(f"{tmp_path}/a\\nb.toml: cannot be read ")


@pytest.mark.parametrize("text", ["a = " + "[" * 5000, "a = " + "1" * 5000])
def test_a_hostile_file_is_told_by_simulate_as_by_scene(text: str, tmp_path: Path) -> None:
    file = scene(tmp_path, text)
    (line,) = refused(invoke("simulate", file, "-o", tmp_path / "out"))
    assert line.startswith(f"{file}: is n")


def test_a_form_relative_in_the_file_is_that_of_the_command_line(tmp_path: Path) -> None:
    asked, plain = tmp_path / "asked", tmp_path / "plain"
    for command, options in (("simulate", SHORT), ("scene", ())):
        assert invoke(command, scene(tmp_path, SLIDE), "--form", "relative", *options, "-o", plain).exit_code == 0
        assert invoke(command, scene(tmp_path, SLIDE + 'form = "relative"\n'), *options, "-o", asked).exit_code == 0
        (name,) = {"trajectory.csv", "slide.c"} & {path.name for path in plain.iterdir()}
        assert (asked / name).read_bytes() == (plain / name).read_bytes()


def test_relative_coordinates_beside_another_form_are_told_joint_by_joint(tmp_path: Path) -> None:
    second = SLIDE[SLIDE.index("[[joint]]") :].replace("rail", "guide") + 'form = "parametric"\n'
    file = scene(tmp_path, SLIDE + 'form = "relative"\n' + second)
    (line,) = refused(invoke("simulate", file, "-o", tmp_path / "out"))
    assert line.startswith(f'{file}: joint "guide": form: is "parametric", and joint "rail" asks for relative ')


@pytest.mark.parametrize(("form", "rows"), [("auto", 7), ("relative", 0)])
def test_a_summary_has_the_counts_and_drifts_and_the_rank_is_of_its_rows(form: str, rows: int, tmp_path: Path) -> None:
    """A block that a drive pushes: a joint of six rows with a coordinate, and the row of the drive."""
    driven = scene(tmp_path, SLIDE + "drive = { position = 0.0, speed = 1.0 }\n")
    assert invoke("simulate", driven, "--form", form, *SHORT, "-o", tmp_path / "run").exit_code == 0
    found = summary(tmp_path / "run")
    assert set(COUNTS) <= set(found)
    assert (found["rows"], found["rank"], found["dropped_rows"], found["dof"]) == (rows, rows, [], 0)


def test_a_chain_tells_its_rank_and_the_rows_that_bind_nothing(tmp_path: Path) -> None:
    assert invoke("chain", QUICK_RETURN, "--kinematics", *SHORT, "-o", tmp_path / "run").exit_code == 0
    found = summary(tmp_path / "run")
    assert found["rows"] - len(found["dropped_rows"]) == found["rank"] == found["coordinates"] - found["dof"] == 6
    assert {"joint": "slide axis", "row": "p_y"} in found["dropped_rows"]
    assert 0 < found["constraint_drift"] < 1e-12


def test_a_chain_under_forces_tells_how_far_its_energy_drifts(tmp_path: Path) -> None:
    """Of a pendulum the energy is known: m g l sin(q), and half of the inertia about its pin."""
    file = tmp_path / "pendulum.toml"
    file.write_text(PENDULUM)
    assert invoke("simulate", file, "--tol", "1e-4", "-o", tmp_path / "run").exit_code == 0
    found, columns = summary(tmp_path / "run"), table(tmp_path / "run")
    q, qd = np.array(columns["rod.q"]), np.array(columns["rod.qd"])
    energy = 0.5 * (0.1 + 2.0) * qd**2 + 2.0 * 9.81 * np.sin(q)
    drift = float(np.max(np.abs(energy - energy[0])))
    assert 0.1 * drift < found["energy_drift"] < 10 * drift
    assert set(COUNTS) <= set(found)
    assert 11 * found["steps"] <= found["evaluations"] < 15 * found["steps"] + 15


def test_rows_are_named_as_they_are_asked_for_where_nothing_rotates_too(tmp_path: Path) -> None:
    asked = ("--rows", "table4", "--derivative", "exact", "--outputs", "phi")
    assert invoke("generate", "translational", *asked, "-o", tmp_path / "rows").exit_code == 0
    (function,) = json.loads((tmp_path / "rows" / "manifest.json").read_text())["functions"]
    assert (function["symbol"], function["rows"]) == ("jg_translational_parametric_table4_phi", "table4")
