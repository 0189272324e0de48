"""What the peers are fed and how they are judged: formulas, written-out powers, the oracle's error, the counter."""

import math
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from benchmarks.install import entries
from benchmarks.peers import formulas
from benchmarks.peers.candidates import Candidate
from benchmarks.peers.constraint import JOINTS, Pose, argument_lengths, geometry_of, matrix, phi
from benchmarks.peers.oracle import OUTPUTS, TOLERANCE, truth
from benchmarks.peers.source import integer_powers
from benchmarks.peers.work import Pattern, Work


def dense(rows, columns):
    starts = tuple(rows * k for k in range(columns + 1))
    return Pattern(rows, columns, starts, tuple(range(rows)) * columns)


def dense_work(joint):
    rows = argument_lengths(joint)["lambda"]
    shapes = {"phi": (rows, 1), "phi_q": (rows, 12), "phi_q_t_lambda_q": (12, 12)}
    return Work(joint, {name: dense(*shape) for name, shape in shapes.items()})


def closed_outputs(joint, inputs, lambda_first):
    """All entries of all outputs by the formulas, in floats, at every pose."""
    stored = {name: [] for name in OUTPUTS}
    for k in range(len(inputs["r_i"])):
        flat = {name: [float(x) for x in values[k]] for name, values in inputs.items()}
        pose = Pose(flat["r_i"], matrix(flat["A_i"]), flat["r_j"], matrix(flat["A_j"]))
        geometry = geometry_of(flat["geometry"])
        closed = formulas.Closed(pose, geometry)
        values = {
            "phi": [[x] for x in phi(joint, pose, geometry, math.atan2)],
            "phi_q": formulas.phi_q(joint, closed),
            "phi_q_t_lambda_q": formulas.second(joint, closed, flat["lambda"], lambda_first),
        }
        for name in OUTPUTS:
            stored[name].append(np.array(values[name], dtype=float).ravel(order="F"))
    return {name: np.array(rows) for name, rows in stored.items()}


@pytest.mark.parametrize("joint", JOINTS)
@pytest.mark.parametrize("lambda_first", [False, True])
def test_the_closed_formulas_agree_with_the_reference(joint, lambda_first):
    exact = truth(joint)
    assert exact.error(dense_work(joint), closed_outputs(joint, exact.inputs, lambda_first)) < 1e-14


def test_one_wrong_entry_of_one_pose_is_an_error():
    exact = truth("ball")
    for name in OUTPUTS:
        stored = closed_outputs("ball", exact.inputs, False)
        stored[name][7, -1] += 1e-9
        assert exact.error(dense_work("ball"), stored) > TOLERANCE


def test_an_entry_that_is_left_out_of_the_pattern_is_an_error():
    exact = truth("ball")
    work = dense_work("ball")
    without_last_column = Pattern(3, 11, tuple(3 * k for k in range(12)), (0, 1, 2) * 11)
    stored = closed_outputs("ball", exact.inputs, False)
    stored["phi_q"] = stored["phi_q"][:, :33]
    short = Work("ball", work.patterns | {"phi_q": without_last_column})
    assert exact.error(short, stored) > TOLERANCE


def test_an_entry_that_is_not_written_is_an_error():
    exact = truth("ball")
    stored = closed_outputs("ball", exact.inputs, False)
    stored["phi"][0, 0] = math.nan
    assert exact.error(dense_work("ball"), stored) == math.inf


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("pow(x, 2)", 9.0),
        ("1 + pow(x + 1, 3)*2", 129.0),
        ("std::pow(Scalar(std::pow(x, Scalar(2)) + 1), Scalar(-2))", 0.01),
        ("pow(x, -1.0)", 1 / 3),
    ],
)
@pytest.mark.skipif(not shutil.which("g++"), reason="needs g++")
def test_powers_are_written_out_with_their_value(tmp_path, text, value):
    written = integer_powers(text)
    assert "pow" not in written
    source = tmp_path / "power.cpp"
    statements = f'using Scalar = double; const double x = 3; std::printf("%.17g", {written});'
    source.write_text(f"#include <cstdio>\nint main() {{ {statements} }}\n")
    subprocess.run(["g++", str(source), "-o", str(tmp_path / "power")], check=True)
    done = subprocess.run([str(tmp_path / "power")], capture_output=True, text=True, check=True)
    assert float(done.stdout) == pytest.approx(value, rel=1e-15)


@pytest.mark.skipif(not (shutil.which("gcc") and shutil.which("objdump")), reason="needs gcc and objdump")
def test_the_object_code_has_the_operations_of_the_text(tmp_path, monkeypatch):
    from benchmarks.peers import compile as compiling

    monkeypatch.setattr(compiling, "BUILD", Path(tmp_path))
    source = tmp_path / "work.c"
    source.write_text(
        "#include <math.h>\n"
        "static double square(double x) { return x*x; }\n"
        "void work(const double *restrict x, double *restrict y)\n"
        "{ y[0] = -(x[0]*x[1] + x[2]) - x[3]/x[4]; y[1] = atan2(square(x[0]), square(x[1])); }\n"
    )
    counts = compiling.operations(Candidate("sympy", "phi", "work", source))
    if counts is None:
        pytest.skip("counts x86-64 only")
    assert counts == {"add": 2, "atan2": 1, "div": 1, "mul": 3, "total": 7}


def test_a_lock_is_taken_apart_into_packages_with_their_hashes():
    lock = (
        "# comment\na==1 \\\n    --hash=sha256:0 \\\n    --hash=sha256:1\n    # via b\nb==2 \\\n    --hash=sha256:2\n"
    )
    assert entries(lock) == {
        "a": "a==1 \\\n    --hash=sha256:0 \\\n    --hash=sha256:1\n",
        "b": "b==2 \\\n    --hash=sha256:2\n",
    }
