"""``jointgen chain --kinematics|--inverse|--forward`` and ``jointgen simulate`` of a chain."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import numpy as np
import pytest

from .runs import contents, finish, invoke, refused, snapshot, spawn

CHAINS = Path(__file__).parents[2] / "examples" / "chains"
CRANK = CHAINS / "spatial_slider_crank.toml"

PENDULUM = """
name = "pendulum"
gravity = [0.0, -9.81, 0.0]
[[link]]
name = "rod"
parent = "base"
type = "revolute"
theta = 0.5
mass = 2.0
centre = [1.0, 0.0, 0.0]
inertia = [0.1, 0.1, 0.1]
[[effector]]
name = "tip"
link = "rod"
a = 2.0
[[independent]]
joint = "rod"
"""


@pytest.fixture
def pendulum(tmp_path: Path) -> Path:
    file = tmp_path / "pendulum.toml"
    file.write_text(PENDULUM)
    return file


def table(folder: Path) -> dict[str, list[float]]:
    with (folder / "trajectory.csv").open() as lines:
        rows = list(csv.DictReader(lines))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def test_a_run_is_a_few_files_and_a_line(tmp_path: Path) -> None:
    done = invoke("chain", CRANK, "--inverse", "--outputs", "4", "--animation", "-o", tmp_path / "run")
    assert done.exit_code == 0
    assert done.stdout.startswith(f"{tmp_path / 'run'}: inverse, 1 s, 5 outputs")
    assert done.stderr == ""
    names = ["animation.html", "manifest.json", "plot.svg", "summary.json", "trajectory.csv"]
    assert sorted(contents(tmp_path / "run")) == names


def test_two_kinds_of_runs_at_once_are_refused(tmp_path: Path) -> None:
    told = refused(invoke("chain", CRANK, "--inverse", "--forward", "-o", tmp_path / "run"))
    assert told == ["--forward: is given beside --inverse; ask for one run"]


def test_inverse_dynamics_writes_efforts_reactions_and_wrenches(tmp_path: Path) -> None:
    invoke("chain", CRANK, "--inverse", "--outputs", "4", "-o", tmp_path / "run")
    columns = table(tmp_path / "run")
    for name in ("t", "crank.q", "crank.qd", "crank.qdd", "crank.tau", "crank.effort", "cut.slide axis.fx", "rod.mz"):
        assert len(columns[name]) == 5
    assert np.allclose(columns["slide.q"][0], 0.2, atol=1e-15)


def test_a_spring_between_effectors_pulls_and_one_without_direction_is_refused(tmp_path: Path, pendulum: Path) -> None:
    """The rod rests at 0.5 rad; the hook stands 3 m above its pin."""
    hook = '[[effector]]\nname = "hook"\nlink = "base"\npsi = "pi/2"\na = 3.0\n'
    spring = '[[spring]]\neffectors = ["tip", "hook"]\nstiffness = 40.0\nlength = 1.0\n'
    held = pendulum.with_name("held.toml")
    held.write_text(f"{PENDULUM}polynomial = [0.5]\n{hook}{spring}")
    done = invoke("chain", held, "--inverse", "--outputs", "1", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.stderr
    tip, top = 2 * np.exp(0.5j), 3j
    pull = 40 * (abs(top - tip) - 1) * (top - tip) / abs(top - tip)
    effort = 2 * 9.81 * np.cos(0.5) - (np.conj(tip) * pull).imag
    assert table(tmp_path / "run")["rod.effort"] == pytest.approx([effort, effort], rel=1e-14)
    on_tip = hook.replace('"pi/2"', "0.5").replace("3.0", "2.0")
    held.write_text(f"{PENDULUM}polynomial = [0.5]\n{on_tip}{spring}")
    for mode in (["--inverse"], []):
        (line,) = refused(invoke("chain", held, *mode, "-o", tmp_path / "no"))
        assert "its ends coincide at t = 0" in line


def test_a_coordinate_is_driven_by_a_table_while_another_swings(tmp_path: Path, pendulum: Path) -> None:
    """A cart moves by 0.1 (1 - cos 6t) under the rod, whose angle counts from the vertical, and pushes both."""
    cart = '[[link]]\nname = "cart"\nparent = "base"\ntype = "prismatic"\npsi = "pi/2"\nalpha = "pi/2"\nmass = 1.0\n'
    on_cart = PENDULUM.replace('parent = "base"', 'parent = "cart"\nalpha = "-pi/2"')
    text = on_cart.replace("[[link]]", f"{cart}[[link]]", 1)
    driven = pendulum.with_name("driven.toml")
    driven.write_text(f'{text}[[independent]]\njoint = "cart"\ntable = "way.csv"\ndriven = true\n')
    ways = [f"{t:.17g},{0.1 * (1 - np.cos(6 * t)):.17g}" for t in np.linspace(0.0, 1.0, 101).tolist()]
    (tmp_path / "way.csv").write_text("\n".join(ways))
    done = invoke("simulate", driven, "--outputs", "3", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.stderr
    found = {name: np.array(values) for name, values in table(tmp_path / "run").items()}
    turned, rate, turning = (found[f"rod.{name}"] for name in ("q", "qd", "qdd"))
    pushed, turned = found["cart.qdd"], turned + np.pi / 2
    assert pushed == pytest.approx(3.6 * np.cos(6 * found["t"]), abs=1e-4)
    assert (0.1 + 2.0) * turning == pytest.approx(2 * (pushed * np.sin(turned) - 9.81 * np.cos(turned)), abs=1e-10)
    swung = -turning * np.sin(turned) - rate**2 * np.cos(turned)
    assert found["cart.effort"] == pytest.approx(3 * pushed + 2 * swung, abs=1e-10)
    (tmp_path / "way.csv").write_text("0 0\n1 1\n")
    (line,) = refused(invoke("simulate", driven, "-o", tmp_path / "no"))
    assert "line 2 is not two numbers" in line


def test_kinematics_needs_no_mass(tmp_path: Path, pendulum: Path) -> None:
    light = pendulum.with_name("light.toml")
    text = (
        PENDULUM.replace("mass = 2.0\n", "")
        .replace("inertia = [0.1, 0.1, 0.1]\n", "")
        .replace("centre = [1.0, 0.0, 0.0]\n", "")
    )
    light.write_text(text + 'harmonic = { amplitude = 1.0, frequency = 2.0 }\n[output]\nquantities = ["frames"]\n')
    done = invoke("chain", light, "--kinematics", "--outputs", "2", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.stderr
    columns = table(tmp_path / "run")
    assert not [name for name in columns if name.endswith((".tau", ".fx"))]
    assert columns["effector.tip.rx"] == pytest.approx([2 * np.cos(np.sin(2 * t)) for t in (0, 0.5, 1.0)])


def test_a_pendulum_swings_with_its_energy(tmp_path: Path, pendulum: Path) -> None:
    """Energy: theta is measured from x, gravity along -y."""
    done = invoke("simulate", pendulum, "--duration", "2", "--outputs", "20", "--tol", "1e-11", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.stderr
    columns = table(tmp_path / "run")
    moment = 0.1 + 2.0
    for q, qd in zip(columns["rod.q"], columns["rod.qd"], strict=True):
        assert moment * qd**2 / 2 + 2 * 9.81 * np.sin(q) == pytest.approx(2 * 9.81 * np.sin(0.5), abs=1e-8)
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["mode"] == "forward"


def test_all_bad_options_are_told_at_once(tmp_path: Path) -> None:
    wrong = ("--tol", "0", "--duration", "-1", "--outputs", "0")
    before = snapshot(tmp_path)
    lines = refused(invoke("chain", CRANK, "--forward", *wrong, "-o", tmp_path / "run"))
    assert [line.split(":")[0] for line in lines] == ["--tol", "--duration", "--outputs"]
    assert snapshot(tmp_path) == before


def test_options_of_scenes_are_refused_for_chains(tmp_path: Path) -> None:
    lines = refused(
        invoke("simulate", CRANK, "--form", "auto", "--index", "1", "--copies", "2", "-o", tmp_path / "run")
    )
    assert [line.split(":")[0] for line in lines] == ["--form", "--copies", "--index"]


def test_a_run_that_stops_writes_what_it_has_and_leaves_with_1(tmp_path: Path) -> None:
    """The rod is too short for the crank to turn over."""
    short = tmp_path / "short.toml"
    text = (
        CRANK.read_text()
        .replace("c = 0.3", "c = 0.2361")
        .replace('name = "spatial', 'assemble = true\nname = "spatial')
    )
    short.write_text(text)
    done = invoke("chain", short, "--kinematics", "--outputs", "40", "-o", tmp_path / "run")
    assert done.exit_code == 1
    assert "no solution; the nearest pose leaves" in done.stderr
    assert json.loads((tmp_path / "run" / "summary.json").read_text())["completed"] is False
    assert table(tmp_path / "run")["t"][-1] == pytest.approx(0.1)


def test_a_table_is_read_from_the_folder_of_the_chain(tmp_path: Path, pendulum: Path) -> None:
    pendulum.write_text(PENDULUM + 'table = "swing.csv"\n')
    (line,) = refused(invoke("chain", pendulum, "--inverse", "-o", tmp_path / "run"))
    assert "swing.csv: cannot be read" in line
    (tmp_path / "swing.csv").write_text("t,q\n0,0.5\n1,0.7\n2,0.9\n3,1.1\n")
    done = invoke("chain", pendulum, "--inverse", "--outputs", "4", "-o", tmp_path / "run")
    assert done.exit_code == 0, done.stderr
    columns = table(tmp_path / "run")
    expected = [2 * 9.81 * np.cos(q) for q in columns["rod.q"]]
    assert columns["rod.effort"] == pytest.approx(expected, abs=1e-12)


def test_two_runs_with_different_hash_seeds_write_the_same_files(tmp_path: Path) -> None:
    found = []
    for seed in ("1", "2"):
        target = tmp_path / f"run{seed}"
        code, _, err = finish(
            spawn("chain", CRANK, "--inverse", "--outputs", "5", "--animation", "-o", target, PYTHONHASHSEED=seed)
        )
        assert (code, err) == (0, "")
        found.append(contents(target))
    summaries = [json.loads(files.pop("summary.json")) for files in found]
    for told in summaries:
        assert told.pop("wall_time") > 0
    assert found[0] == found[1]
    assert summaries[0] == summaries[1]
