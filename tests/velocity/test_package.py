"""The package of a platform: C for one pose and for many, CasADi, manifest."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from functools import cache
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.platforms.generate import LANES, generate_platform, with_options
from codegen.platforms.programs import program
from codegen.spec.platform import QUANTITIES
from codegen.spec.platform_file import read_platform
from flopcount.count import count
from flopcount.count_c import count_c
from tests.spec.test_platform import HEXAPOD

from .compiled import call, library, record, unpacked
from .found import TYPES, found

ALL = "\n[output]\nquantities = [" + ", ".join(f'"{name}"' for name in QUANTITIES) + "]\n"
SMALL = '\n[output]\nquantities = ["D", "C", "status"]\nattitude = "ZYX"\n'


@cache
def package(text: str, real: str = "double") -> dict[str, bytes]:
    return generate_platform(read_platform(text, "p.toml"), real)


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    folder = tmp_path_factory.mktemp("platform")
    return folder, unpacked(package(HEXAPOD + ALL), folder)


def poses(number: int) -> Any:
    generator = np.random.default_rng(5)
    o = np.array([0, 0, 1]) + generator.uniform(-0.2, 0.2, (number, 3))
    return list(zip(o, Rotation.from_rotvec(generator.uniform(-0.5, 0.5, (number, 3))).as_matrix(), strict=True))


def test_one_pose_in_c_is_the_program_bit_by_bit(everything: Any) -> None:
    folder, manifest = everything
    loaded = library(folder, ["hexapod.c"])
    entry = record(manifest, "jg_hexapod_all")
    arguments = {a["name"]: np.zeros(a["length"]) for a in entry["arguments"]}
    (o, R), *_ = poses(1)
    arguments["o"][:], arguments["R"][:] = o, R.T.ravel()
    call(loaded["jg_hexapod_all"], [], list(arguments.values()))
    names = tuple(entry["outputs"])
    expected = found(read_platform(HEXAPOD + ALL, "p.toml"), names, [(o, R)])
    for name in names:
        assert (arguments[name] == expected[name][:, 0]).all(), name


@pytest.mark.parametrize("real", LANES)
def test_many_poses_have_the_bits_of_one_whatever_the_layout(real: str, tmp_path: Path) -> None:
    kind, lanes, many = TYPES[real], LANES[real], 19
    text = HEXAPOD + '\n[output]\nquantities = ["D", "status"]\n'
    manifest = unpacked(package(text, real), tmp_path)
    scalar = library(tmp_path, ["hexapod.c"])["jg_hexapod_all"]
    batch = library(tmp_path, [f"hexapod_batch{lanes}.c"], ["-march=native"])
    entry = record(manifest, "jg_hexapod_all")
    lengths = {a["name"]: a["length"] for a in entry["arguments"]}
    where = poses(many)
    single = {name: np.zeros((many, length), dtype=kind) for name, length in lengths.items()}
    single["o"][:] = [o for o, _ in where]
    single["R"][:] = [R.T.ravel() for _, R in where]
    for j in range(many):
        call(scalar, [], [array[j : j + 1] for array in single.values()])
    arrays = {n: np.ascontiguousarray(a.T) if n in ("o", "R") else np.zeros(a.T.shape, kind) for n, a in single.items()}
    call(batch[f"jg_hexapod_all_batch{lanes}_soa"], [many, many], list(arrays.values()))
    for name in ("D", "status"):
        assert (arrays[name] == single[name].T).all(), name
    by_rows = {"o": single["o"], "R": np.array([R for _, R in where], dtype=kind)}
    by_rows |= {name: np.zeros((many, lengths[name]), dtype=kind)[::-1] for name in ("D", "status")}
    strides = [[s // a.itemsize for s in (*a.strides, 0)][:3] for a in by_rows.values()]
    any_strides = batch[f"jg_hexapod_all_batch{lanes}_any"]
    call(any_strides, [many], [np.array(strides, dtype=np.int64), *by_rows.values()])
    for name in ("D", "status"):
        assert (by_rows[name] == single[name]).all(), name


def test_casadi_functions_give_the_numbers_of_the_program(everything: Any) -> None:
    folder, manifest = everything
    (o, R), *_ = poses(1)
    expected = found(read_platform(HEXAPOD + ALL, "p.toml"), ("D", "C", "values", "status"), [(o, R)])
    for record_ in manifest["casadi"]:
        if record_["output"] in expected:
            function = casadi.Function.load(str(folder / record_["file"]))
            values = np.array(function(o, R)).ravel()
            assert values == pytest.approx(expected[record_["output"]][:, 0], rel=1e-14)


def test_both_counters_agree_on_every_function(everything: Any) -> None:
    folder, manifest = everything
    counted = count_c((folder / "hexapod.c").read_text())
    for entry in manifest["functions"]:
        assert counted[entry["symbol"]].as_dict() == entry["operations"], entry["symbol"]


def test_the_example_runs_and_prints_a_pose_that_is_not_singular(everything: Any) -> None:
    folder, _ = everything
    sources = [str(folder / name) for name in ("hexapod_example.c", "hexapod.c")]
    subprocess.run(["gcc", "-std=c99", *sources, "-lm", "-o", str(folder / "example")], check=True)
    told = subprocess.run([str(folder / "example")], capture_output=True, text=True, check=True).stdout
    assert "status[0] = 0\n" in told and "nan" not in told


def test_what_is_not_asked_for_is_not_emitted() -> None:
    text = package(HEXAPOD + SMALL)["hexapod.h"].decode()
    assert "jg_hexapod_D(" in text and "jg_hexapod_lengths(" not in text and "angles" in text


def test_the_same_file_gives_the_same_bytes_in_another_process(tmp_path: Path) -> None:
    file = tmp_path / "p.toml"
    file.write_text(HEXAPOD + SMALL)
    environment = {**os.environ, "PYTHONHASHSEED": "7", "XDG_CACHE_HOME": str(tmp_path / "empty")}
    command = [sys.executable, "-m", "codegen", "platform", str(file), "-o", str(tmp_path / "out")]
    subprocess.run(command, check=True, env=environment, capture_output=True)
    files = package(HEXAPOD + SMALL)
    written = {
        path.relative_to(tmp_path / "out").as_posix() for path in (tmp_path / "out").rglob("*") if path.is_file()
    }
    assert written == set(files)
    for name in written - {name for name in files if name.endswith(".casadi")}:
        assert (tmp_path / "out" / name).read_bytes() == files[name], name


def test_the_unit_of_the_file_changes_the_constants_and_nothing_else() -> None:
    metres = read_platform(HEXAPOD, "p.toml")
    feet = read_platform(HEXAPOD.replace('name = "hexapod"', 'name = "hexapod"\nunit = "ft"'), "p.toml")
    one, other = (program(p, ("D",)) for p in (metres, feet))
    first, second = (count(p) for p in (one, other))
    assert (first.add, first.div, first.sqrt) == (second.add, second.div, second.sqrt)


def test_options_that_do_not_go_together_are_refused() -> None:
    from codegen.errors import SpecificationError

    platform = read_platform(HEXAPOD + ALL, "p.toml")
    with pytest.raises(SpecificationError, match="does not evaluate"):
        with_options(platform, "values", "double")
    with pytest.raises(SpecificationError, match=r"--variant.*did you mean"):
        with_options(platform, "robusst", "double")


def test_fused_products_and_sums_are_written_out_and_told() -> None:
    plain = read_platform(HEXAPOD + '\n[output]\nquantities = ["D"]\n', "p.toml")
    files = generate_platform(with_options(plain, None, "double", True))
    assert json.loads(files["manifest.json"])["fma"] is True
    assert "-mfma" in files["README.md"].decode()
    assert "jg_fma(" in files["hexapod.c"].decode() and "jg_fma_batch(" in files["hexapod_batch4.c"].decode()
