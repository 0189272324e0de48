"""Runs at the limits: dead centres, poses where the rank drops, rows left out, wide ranges of mass, many turns."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from codegen.errors import SpecificationError
from codegen.scenes import read
from codegen.scenes.motion_record import Record, record
from codegen.scenes.run import Prepared, Settings, prepare
from codegen.scenes.simulate import simulated
from codegen.scenes.watch import DROPPED, Watch
from codegen.scenes.watched_run import Watched, watched_run
from codegen.spec.scene import Scene

from . import mechanisms
from .preparations import EXAMPLES

Array = NDArray[np.float64]

SCENES = {
    "engine": mechanisms.engine,
    "fold": lambda: mechanisms.engine(rod="0.1"),
    "light": lambda: mechanisms.engine(piston="0.000001"),
    "wrong": lambda: mechanisms.engine(wrong="0.5"),
    "sledge": mechanisms.sledge,
    "screw": mechanisms.screw,
    "bar": mechanisms.bar,
}


@cache
def prepared(name: str) -> Prepared:
    return prepare(SCENES[name](), Settings())


def ran(name: str, settings: Settings) -> tuple[Watched, Record]:
    watched = watched_run(prepared(name), settings)
    return watched, record(prepared(name), watched.run)


# --- dead centres


def test_an_engine_passes_its_dead_centres_without_losing_rank_or_constraints() -> None:
    watched, told = ran("engine", Settings(duration=4.0, outputs=100, tolerance=1e-8))
    assert not watched.run.failure
    assert watched.least is not None
    assert watched.least > 0.1
    assert np.max(told.drift) < 1e-9
    turns = watched.run.y[-1][2] / (2 * np.pi)
    assert turns > 7  # two dead centres a turn, the first of them at the start


def test_a_piston_a_million_times_lighter_than_the_crank_runs() -> None:
    watched, told = ran("light", Settings(duration=1.0, outputs=50, tolerance=1e-8))
    assert not watched.run.failure
    assert np.max(told.drift) < 1e-9
    assert np.ptp(told.energy) < 1e-5 * told.energy[0]


# --- singular configurations: a rod as long as the crank folds where the crank stands across, at 90 degrees


def fold_time() -> float:
    """When the crank of the engine with equal links is at 90 degrees, from its energy; the rod turns back as fast."""
    a, J = 0.1, 0.003

    def speed(_: float, theta: Array) -> Array:
        def inertia(s: Array) -> Array:
            crank, rod = 1.0 * (a / 2) ** 2 + J, 1.0 * ((1.5 * a * s) ** 2 + (a / 2 * np.sqrt(1 - s * s)) ** 2) + J
            return np.asarray(crank + rod + 0.5 * (2 * a * s) ** 2)

        found: Array = 15.0 * np.sqrt(inertia(np.zeros(1)) / inertia(np.sin(theta)))
        return found

    def across(_: float, theta: Array) -> float:
        return float(theta[0] - np.pi / 2)

    across.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(speed, (0, 1), [0.0], method="DOP853", rtol=1e-12, atol=1e-12, events=across)
    return float(found.t_events[0][0])


@pytest.mark.parametrize("tolerance", [1e-5, 1e-8])
def test_a_run_stops_where_crank_and_rod_fold_and_says_so(tolerance: float) -> None:
    watched, told = ran("fold", Settings(duration=0.5, outputs=100, tolerance=tolerance))
    words = watched.run.failure
    assert words.startswith("singular configuration at t = ")
    assert float(words.split()[5]) == pytest.approx(fold_time(), abs=max(1e3 * tolerance, 1e-5))
    assert "rank 6 of 7 rows" in words
    for name in ("main bearing", "crank pin", "piston pin", "cylinder"):
        assert name in words
    assert watched.run.t[-1] < fold_time() < watched.run.t[-1] + 0.005 + 1e-3
    assert np.max(told.drift) < 1e-6


def test_a_run_goes_on_through_the_fold_on_the_smooth_branch() -> None:
    settings = Settings(duration=0.3, outputs=100, tolerance=1e-8, through_singular=True)
    watched, told = ran("fold", settings)
    assert not watched.run.failure
    assert len(watched.run.t) == 101
    (passage,) = watched.passages
    assert passage.left < fold_time() < passage.entered
    assert passage.moved < 1e-4
    piston, crank = watched.run.y[:, 6], watched.run.y[:, 2]
    assert crank[-1] > np.pi / 2 + 0.5
    assert piston == pytest.approx(0.2 * np.cos(crank), abs=1e-8), "the other branch keeps the piston at 0"
    assert np.max(told.drift) < 1e-9
    assert np.ptp(told.energy) < 1e-3 * told.energy[0]


def test_a_run_that_starts_where_it_is_singular_says_so() -> None:
    found = prepared("fold")
    y = found.y.copy()
    y[:9] = [0, 0.05, np.pi / 2, 0, 0.05, -np.pi / 2, 0, 0, 0]
    watched = watched_run(replace(found, y=y), Settings())
    assert watched.run.failure.startswith("singular configuration at t = 0 s")
    assert len(watched.run.t) == 1


def test_where_rows_of_the_paper_lose_rank_at_the_start_those_that_do_not_are_told() -> None:
    scene, _ = read(EXAMPLES / "in_line_engine_parametric.toml")
    watched = watched_run(prepare(scene, Settings()), Settings())
    assert watched.run.failure.endswith('start from another pose, or take rows = "regular"')


def test_a_run_that_stops_keeps_the_states_before_and_says_that_it_is_not_complete() -> None:
    found = simulated(SCENES["fold"](), Settings(duration=0.5, outputs=100, tolerance=1e-6))
    told = json.loads(found.files["summary.json"])
    lines = found.files["trajectory.csv"].decode().splitlines()
    assert told["completed"] is False
    assert told["stopped"] == found.failure
    assert float(lines[-1].split(",")[0]) == told["time_reached"]
    assert len(lines) - 2 == round(told["time_reached"] / 0.005)


# --- rows left out


def test_rows_left_out_hold_as_long_as_the_run_stays_on_its_branch() -> None:
    watched, _ = ran("sledge", Settings(duration=0.2, outputs=40, tolerance=1e-8))
    assert not watched.run.failure
    assert watched.dropped is not None
    assert watched.dropped < 1e-8


def test_a_row_left_out_that_fails_is_named() -> None:
    found = prepared("sledge")
    watch = Watch(found.judged, found.layout)
    y = found.y.copy()
    (joint,) = {joint for joint, _ in found.judged.mobility.redundant if not joint.startswith("plane of")}
    y[1] += 1e-3
    _, dropped = watch.conditions(np.zeros(1), y[None])
    assert np.max(np.abs(dropped)) > DROPPED
    words = watch.dropped_words(0.25, dropped[0])
    assert "at t = 0.25 s" in words
    assert joint in words


# --- screws, initial values, freedom


def test_a_screw_counts_its_turns() -> None:
    watched, told = ran("screw", Settings(duration=20.0, outputs=20, tolerance=1e-8))
    assert not watched.run.failure
    alpha = told.trajectory.alpha["thread"][:, 0]
    assert alpha == pytest.approx(2 * np.pi * watched.run.t, abs=1e-3)
    assert told.trajectory.r[:, 0, 2] == pytest.approx(0.001 * alpha, abs=1e-8)


def test_a_screw_asked_for_in_conventional_form_is_refused() -> None:
    with pytest.raises(SpecificationError, match=r'joint "thread".*within one turn only; use form = "parametric"'):
        prepare(mechanisms.screw("conventional"), Settings())


def test_velocities_that_do_not_fit_are_projected_and_reported() -> None:
    found = simulated(SCENES["wrong"](), Settings(duration=0.05, outputs=5, tolerance=1e-6))
    (note,) = found.notes
    told = json.loads(found.files["summary.json"])
    assert 0.01 < told["initial_velocity_change"] < 0.5
    motion = prepared("wrong").motion
    changes = {"crank": motion.velocity[2] - 15, "rod": motion.velocity[5] + 4.5}
    most = max(changes, key=lambda name: abs(changes[name]))
    assert note == (
        f'velocities were changed by up to {abs(changes[most]):.3g} rad/s (body "{most}") '
        "to satisfy the constraints at the start"
    )
    assert motion.velocity[2] / motion.velocity[5] == pytest.approx(-3)  # crank against rod at dead centre


def test_a_mechanism_that_cannot_move_says_so_and_carries_its_load() -> None:
    found = simulated(SCENES["bar"](), Settings(duration=0.1, outputs=5))
    assert found.notes == ("the mechanism has no degree of freedom: it does not move",)
    header, *lines = (line.split(",") for line in found.files["trajectory.csv"].decode().splitlines())
    last = dict(zip(header, map(float, lines[-1]), strict=True))
    assert last["left.fy"] + last["right.fy"] == pytest.approx(9.81)
    assert last["bar.ry"] == pytest.approx(0, abs=1e-12)


# --- bodies without joints


def thrown(scene: Scene, settings: Settings) -> Record:
    found = prepare(scene, settings)
    return record(found, watched_run(found, settings).run)


def momentum(told: Record) -> Array:
    """Angular momentum about the centre of mass, world."""
    w, x, y, z = np.moveaxis(told.trajectory.q[:, 0], -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    A = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
    found: Array = np.einsum("nij,nj->ni", A, told.trajectory.w[:, 0] * [1.0, 2.0, 3.0])
    return found


def test_a_body_without_a_joint_falls_freely() -> None:
    told = thrown(mechanisms.stone("0", "0", "0"), Settings(duration=2.0, outputs=20))
    t = told.trajectory.t
    fallen = np.stack([t, 2 * t - 9.81 * t * t / 2, 3 * t], axis=1)
    assert told.trajectory.r[:, 0] == pytest.approx(fallen, abs=1e-7)
    assert np.ptp(told.energy) < 1e-6


@pytest.mark.parametrize(
    ("spin", "turns_over"), [(("5", "0.01", "0"), False), (("0.01", "5", "0"), True), (("0", "0.01", "5"), False)]
)
def test_a_spinning_body_turns_over_about_its_middle_axis_only(spin: tuple[str, str, str], turns_over: bool) -> None:
    told = thrown(mechanisms.stone(*spin), Settings(duration=10.0, outputs=200, tolerance=1e-9))
    axis = int(np.argmax([float(x) for x in spin]))
    assert (np.min(told.trajectory.w[:, 0, axis]) < -4.9) == turns_over
    assert momentum(told) == pytest.approx(np.tile(momentum(told)[0], (201, 1)), abs=1e-5)
    spinning = 0.5 * told.trajectory.w[:, 0] ** 2 @ [1.0, 2.0, 3.0]
    assert spinning == pytest.approx(np.full(201, spinning[0]), abs=1e-5)
