"""Many poses from the command line: grids, files, results and pictures."""

from __future__ import annotations

import os
import tracemalloc
import warnings
import xml.etree.ElementTree as ET
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.errors import SpecificationError
from codegen.platforms.attitudes import attitude_array, rotations_of
from codegen.platforms.csv_table import table_of_csv
from codegen.platforms.generate import home_arguments
from codegen.platforms.grid import Poses, for_grid, grid, poses_of_file
from codegen.platforms.headings import heading_mistakes
from codegen.platforms.hexagons import conditions, hexagons
from codegen.platforms.results import results_file
from codegen.platforms.run import chosen_poses, evaluated
from codegen.platforms.spool import CHUNK, spool
from codegen.platforms.sweep import Kernel, Progress, kernel, sweep
from codegen.report.index_maps import index_maps
from codegen.report.platform_pictures import home_factors
from codegen.report.platform_report import platform_report
from codegen.spec.platform import ATTITUDES
from codegen.spec.platform_file import read_platform
from tests.cli.runs import invoke
from tests.spec.test_platform import HEXAPOD

from .found import found

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples" / "platforms").glob("*.toml"))
WANTED = '\n[output]\nquantities = ["D", "C", "status"]\n'
PLATFORM = for_grid(read_platform(HEXAPOD + WANTED, "p.toml"))
MATRICES = read_platform(HEXAPOD + WANTED, "p.toml")


@cache
def compiled() -> Kernel:
    return kernel(PLATFORM)


def swept(poses: Poses, progress: Progress = lambda _: None, threads: int | None = None) -> Any:
    """All that a sweep finds, [columns, poses]."""
    found = spool(len(poses.names) + len(compiled().names()), poses.count)
    sweep(compiled(), poses, found, progress, threads)
    return found.rows(0, poses.count)


def test_a_grid_has_every_combination_and_home_where_nothing_is_said() -> None:
    poses = grid("x=-0.2:0.2:3,yaw=-90deg:90deg:5")
    assert poses.count == 15 and poses.names == ("x", "yaw")
    given = poses.arguments(PLATFORM, 0, 15)
    assert sorted(set(given["o"][0])) == pytest.approx([-0.2, 0, 0.2])
    assert set(given["o"][2]) == {1.0}
    assert given["angles"][0][:5] == pytest.approx(np.radians([-90, -45, 0, 45, 90]))


def test_a_grid_around_a_turned_home_turns_about_axes_of_the_base() -> None:
    turned = read_platform(HEXAPOD.replace("1.0]\n", '1.0]\neuler = "XYZ"\nangles = [0.3, 0, 0]\n'), "p.toml")
    given = grid("yaw=0.5,pitch=-0.1").arguments(for_grid(turned), 0, 1)
    expected = Rotation.from_euler("xyz", [0, -0.1, 0.5]) * Rotation.from_euler("x", 0.3)
    assert rotations_of("matrix", given["R"])[0] == pytest.approx(expected.as_matrix(), abs=1e-15)


def test_the_compiled_sweep_gives_the_numbers_of_the_program_at_every_pose() -> None:
    poses = grid("x=-0.3:0.3:5,z=0.6:1.2:3,roll=-0.2:0.2:3,yaw=-0.5:0.5:3")
    values = swept(poses)
    columns = poses.columns(0, poses.count)
    where = [
        (np.array([x, 0, z]), Rotation.from_euler("xyz", [roll, 0, yaw]).as_matrix()) for x, z, roll, yaw in columns.T
    ]
    expected = found(MATRICES, ("D", "C", "status"), where)
    assert values[:4] == pytest.approx(columns)
    assert values[4:8] == pytest.approx(expected["D"], rel=1e-12)
    assert values[8:12] == pytest.approx(expected["C"], rel=1e-12)


def test_pieces_and_threads_change_no_bit() -> None:
    poses = grid(f"x=-0.3:0.3:{CHUNK // 4 + 3},yaw=-0.5:0.5:9")
    told: list[str] = []
    many, one = swept(poses, told.append, threads=3), swept(poses, threads=1)
    assert (many == one).all()
    assert len(told) == -(-poses.count // CHUNK)


def test_memory_does_not_grow_with_the_number_of_poses(tmp_path: Path) -> None:
    poses = grid(f"x=-0.3:0.3:{4 * CHUNK},yaw=-0.5:0.5:9")
    found = spool(2 + len(compiled().names()), poses.count, tmp_path)
    tracemalloc.start()
    sweep(compiled(), poses, found, threads=2)
    with (tmp_path / "poses.npz").open("wb") as file:
        results_file(("x", "yaw", *compiled().names()), found, "npz")["poses.npz"](file)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < found.columns * found.count * 8 / 3
    with np.load(tmp_path / "poses.npz") as table:
        assert (table["status"] == found.rows(0, found.count)[-1]).all()


@pytest.mark.parametrize("attitude", ATTITUDES)
def test_attitudes_come_back_from_their_arguments(attitude: str) -> None:
    rotations = Rotation.random(20, random_state=3).as_matrix()
    assert rotations_of(attitude, attitude_array(attitude, rotations)) == pytest.approx(rotations, abs=1e-12)


def test_poses_of_a_file_are_evaluated_where_they_stand(tmp_path: Path) -> None:
    rotations = Rotation.random(7, random_state=1)
    rows = np.hstack([np.full((7, 3), [0.1, 0, 2]), rotations.as_matrix().transpose(0, 2, 1).reshape(7, 9)])
    for name in ("poses.csv", "poses.npy"):
        file = tmp_path / name
        if name.endswith("npy"):
            np.save(file, rows)
        else:
            np.savetxt(file, rows, delimiter=",", header="x,y,z", comments="", fmt="%.17g")
        poses = poses_of_file(file, MATRICES)
        given = poses.arguments(MATRICES, 0, 7)
        assert (given["o"] == rows[:, :3].T).all()
        assert rotations_of("matrix", given["R"]) == pytest.approx(rotations.as_matrix(), abs=1e-16)


@pytest.mark.parametrize(
    "attitude, names, words",
    [
        ("quaternion", "x,y,z,qx,qy,qz,qw", "quaternion as x y z w"),
        ("quaternion", "z,y,x,qw,qx,qy,qz", "positions as z y x"),
        ("ZYX", "x,y,z,roll,pitch,yaw", "order roll pitch yaw, and the routines take ZYX"),
        ("xyz", "x,y,z,a_deg,b_deg,c_deg", "degrees"),
        ("matrix", "x,y,z,r11,r12,r13,r21,r22,r23,r31,r32,r33", "column by column"),
        ("matrix", "x,y,z,r11,r21,r31,r12,r22,r32,r13,r23,r33", ""),
        ("quaternion", "x,y,z,qw,qx,qy,qz", ""),
        ("quaternion", "x,y,z,q0,q1,q2,q3", ""),
        ("ZYX", "x,y,z,yaw,pitch,roll", ""),
        ("xyz", "X,Y,Z,roll,pitch,yaw", ""),
        ("xyz", "some,names,of,one's,own,here", ""),
    ],
)
def test_names_of_columns_that_contradict_their_order_are_told(
    attitude: str, names: str, words: str, tmp_path: Path
) -> None:
    file = tmp_path / "poses.csv"
    file.write_text(f"{names}\n")
    told = heading_mistakes(file, attitude)
    assert [words in mistake.what for mistake in told] == ([True] if words else [])


def test_a_csv_without_names_loses_no_pose_and_one_that_contradicts_is_refused(tmp_path: Path) -> None:
    file, line = tmp_path / "poses.csv", "0,0,1,1,0,0,0,1,0,0,0,1"
    file.write_text(f"{line}\n{line}\n")
    assert poses_of_file(file, MATRICES).count == 2
    file.write_text(f"y,x,z,a,b,c,d,e,f,g,h,i\n{line}\n")
    with pytest.raises(SpecificationError, match="line 1: gives positions as y x z"):
        poses_of_file(file, MATRICES)


def test_a_csv_is_read_piece_by_piece(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.platforms.csv_table.CHUNK", 3)
    rows = np.random.default_rng(2).normal(size=(8, 12)) * 10.0 ** np.arange(-6, 6)
    file = tmp_path / "poses.csv"
    np.savetxt(file, rows, delimiter=",", header="names", comments="", fmt="%.17g")
    file.write_text(file.read_text() + "\n\n\n\n")
    found = table_of_csv(file)
    assert isinstance(found, np.memmap)
    assert (found == rows).all()
    file.write_text(file.read_text().replace("\n\n", "\n1,2\n"))
    with pytest.raises(ValueError, match=r"number of columns|columns, the first"):
        table_of_csv(file)


@pytest.mark.parametrize("content", ["", "names\n", "names\n\n\n"])
def test_a_csv_without_numbers_is_an_empty_table(content: str, tmp_path: Path) -> None:
    file = tmp_path / "poses.csv"
    file.write_text(content)
    assert table_of_csv(file).size == 0


def test_memory_does_not_grow_with_the_lines_of_a_csv(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("codegen.platforms.csv_table.CHUNK", 1000)
    line = ",".join(["0.123456789012345678"] * 12) + "\n"
    most = []
    for count in (2_000, 8_000):
        file = tmp_path / "poses.csv"
        file.write_text("names\n" + line * count)
        tracemalloc.start()
        table_of_csv(file)
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert most[1] < 1.1 * most[0]


def test_every_attitude_of_a_file_that_is_no_rotation_is_told(tmp_path: Path) -> None:
    rows = np.zeros((4, 12))
    rows[0, [3, 7, 11]] = 1
    rows[2, [3, 7, 11]] = 1, 1, -1
    np.save(tmp_path / "p.npy", rows)
    with pytest.raises(SpecificationError) as caught:
        poses_of_file(tmp_path / "p.npy", MATRICES)
    assert [mistake.place[-6:] for mistake in caught.value.mistakes] == ["pose 2", "pose 3", "pose 4"]


@pytest.mark.parametrize(
    "text, words",
    [
        ("u=0:1:2", 'there is no axis "u"'),
        ("x=0:1", "is no range"),
        ("x=0:1:0", "is no range"),
        ("x=0:nan:3", "is no range"),
        ("x=0deg:1deg:3", "is no range"),
        ("x=0:1:2,x=1", "stands twice"),
        ("x=0:1:1000000,y=0:1:1000000", "poses"),
    ],
)
def test_grids_that_are_none_are_refused_in_words(text: str, words: str) -> None:
    with pytest.raises(SpecificationError, match=words):
        grid(text)


def test_the_command_writes_results_and_pictures_beside_the_package(tmp_path: Path) -> None:
    target = tmp_path / "out"
    file = ROOT / "examples" / "platforms" / "octahedral.toml"
    done = invoke("platform", file, "-o", target, "--grid", "x=-0.1:0.1:3,yaw=80deg:100deg:3", "--format", "npz")
    assert done.exit_code == 0, done.stderr
    assert "9 poses in poses.npz: 3 singular, 0 without a number" in done.stdout
    with np.load(target / "poses.npz") as table:
        assert table["status"].tolist().count(4) == 3
        assert np.isinf(table["C_sigma"]).sum() == 3
    for name in ("maps.svg", "ellipsoids.svg", "pareto.svg"):
        ET.parse(target / name)
    assert (target / "report.html").read_text().count("data:image/svg+xml") == 3


def test_bad_input_leaves_with_2_and_writes_nothing(tmp_path: Path) -> None:
    file, target = tmp_path / "p.toml", tmp_path / "out"
    file.write_text(HEXAPOD)
    for options in (
        ["--grid", "u=1"],
        ["--variant", "roboust"],
        ["--format", "xls"],
        ["--grid", "x=1", "--poses", "q"],
    ):
        done = invoke("platform", file, "-o", target, *options)
        assert done.exit_code == 2 and "Traceback" not in done.stderr and done.stderr.startswith("--"), done.stderr
        assert not target.exists()
    file.write_text(HEXAPOD.replace("[0.5, 0.4,", "[0.5,"))
    assert invoke("platform", file, "-o", target).exit_code == 2
    assert os.listdir(tmp_path) == ["p.toml"]


def test_no_semi_regular_hexagon_is_below_the_front_and_some_reach_it() -> None:
    generator = np.random.default_rng(4)
    top, delta = generator.uniform(0.1, 1, 3000), generator.uniform(0.05, 3, 3000)
    C = conditions(*hexagons(top, delta), generator.uniform(0.1, 3, 3000))
    products = C[0] * C[3]
    assert products.min() == pytest.approx(2, rel=1e-12)
    front = C[:, products < 2 * (1 + 1e-12)]
    assert front[0].min() < 1.1 and front[0].max() > 1.9


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_is_read_and_is_not_singular_at_home(path: Path) -> None:
    platform = read_platform(path.read_text(), path.name)
    assert set(home_arguments(platform)) >= {"o"}
    home = platform.home
    where = (np.array(home.position, dtype=float), np.array(home.rotation, dtype=float))
    matrices = for_grid(platform).wanted.attitude
    assert matrices in ("ZYX", "matrix")
    plain = read_platform(path.read_text().replace('attitude = "quaternion"', ""), path.name)
    assert found(plain, ("status",), [where])["status"][0, 0] == 0


def test_maps_of_more_than_two_axes_say_where_the_others_are_cut() -> None:
    table = evaluated(chosen_poses(MATRICES, None, "x=-0.1:0.1:3,y=0:0.1:2,z=0.9,yaw=0:0.2:3", "csv"))  # type: ignore[arg-type]
    drawn = index_maps(table)
    assert drawn is not None and "At z 0.9 m, yaw 0.1 rad" in drawn


def test_a_report_without_two_axes_has_no_maps() -> None:
    table = evaluated(chosen_poses(MATRICES, None, "x=-0.1:0.1:3", "csv"))  # type: ignore[arg-type]
    assert "maps.svg" not in platform_report(MATRICES, table)


def test_a_singular_home_is_drawn_without_a_warning() -> None:
    """The platform lies in its base: out of the plane its ellipsoids have no end, and nothing is drawn there."""
    octahedral = Path(__file__).parents[2] / "examples" / "platforms" / "octahedral.toml"
    text = octahedral.read_text().replace("position = [0.0, 0.0, 1.0]", "position = [0.0, 0.0, 0.0]")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sigma, beta, _, _ = home_factors(read_platform(text, "flat.toml"))
    assert [sigma[2, 2], beta[2, 2]] == [0.0, 0.0]
