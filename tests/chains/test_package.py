"""The package of a chain: its C and its CasADi functions give what the account by 4 x 4 transforms gives."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import casadi
import numpy as np
import pytest

from codegen.chains.generate import generate_chain
from codegen.mechanics.chain.model import ROW_NAMES
from codegen.spec.chain import Chain
from tests.cli.runs import contents, finish, invoke, refused, spawn
from tests.harness.library import Library
from tests.mechanics.chain.states import State, evaluated, state
from tests.mechanics.chain.trees import EXAMPLES, tree

STRICT = ("-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wmissing-prototypes")


@pytest.fixture(scope="module")
def made() -> tuple[Chain, State, dict[str, bytes]]:
    chain, q = tree(42, 4, 1, 1, "moving")
    return chain, state(chain, q), generate_chain(chain)


@pytest.fixture(scope="module")
def folder(made, tmp_path_factory) -> Path:
    root = tmp_path_factory.mktemp("chain")
    for path, content in made[2].items():
        (root / path).parent.mkdir(exist_ok=True)
        (root / path).write_bytes(content)
    return root


def test_the_manifest_alone_is_enough_to_call_every_routine(made, folder):
    chain, found, files = made
    manifest = json.loads(files["manifest.json"])
    names = [cut["name"] for cut in manifest["chain"]["cuts"]]
    rows = [6 * names.index(row["cut"]) + ROW_NAMES.index(row["row"]) for row in manifest["chain"]["rows"]]
    library = Library.build(folder / "manifest.json", folder / "cache", flags=(*STRICT, "-Werror"))
    truth = {name: np.real(getattr(found.account, name)()) for name in chain.wanted if name != "wrenches"}
    truth |= {name: truth[name][rows] for name in ("phi", "phi_q", "J", "gamma_R")}
    truth |= evaluated(chain, ("wrenches",), found.inputs)
    for function in manifest["functions"]:
        values = library.call(function["symbol"], found.inputs, canary=True, dense=True)
        for name, value in values.items():
            expected = truth[name].reshape(value.shape, order="F")
            scale = max(1.0, np.abs(expected).max(initial=0.0))
            assert np.abs(value - expected).max(initial=0.0) < 1e-12 * scale, function["symbol"]


def test_the_casadi_functions_give_the_same(made, folder):
    chain, found, files = made
    for record in json.loads(files["manifest.json"])["casadi"]:
        function = casadi.Function.load(str(folder / record["file"]))
        inputs = [
            np.reshape(found.inputs[function.name_in(k)], function.size_in(k), order="F")
            for k in range(function.n_in())
        ]
        results = function.call(inputs)
        names = [function.name_out(k) for k in range(function.n_out())]
        for name, truth in evaluated(chain, tuple(names), found.inputs).items():
            value = np.array(results[names.index(name)].full()).reshape(truth.shape)
            assert np.abs(value - truth).max(initial=0.0) < 1e-13 * max(1.0, np.abs(truth).max(initial=0.0)), name


def test_the_example_is_compiled_as_the_readme_says_and_prints_every_output(made, folder):
    command = made[2]["README.md"].decode().split("```sh\n")[1].split("\n")[0]
    done = subprocess.run(command, shell=True, cwd=folder, capture_output=True, text=True, check=True)
    outputs = json.loads(made[2]["manifest.json"])["functions"][-1]["outputs"]
    assert {line.split("[")[0] for line in done.stdout.splitlines()} == set(outputs)


def test_the_command_writes_the_same_bytes_whatever_the_hash_seed(tmp_path):
    file = tmp_path / "arm.toml"
    text = (EXAMPLES / "quick_return.toml").read_text()
    file.write_text(f'{text}\n[output]\nquantities = ["phi", "J", "M"]\n')
    runs = [spawn("chain", file, "-o", tmp_path / seed, PYTHONHASHSEED=seed) for seed in ("1", "2")]
    for run in runs:
        code, _, err = finish(run)
        assert (code, err) == (0, "")
    assert contents(tmp_path / "1") == contents(tmp_path / "2")


def test_only_what_is_asked_for_is_generated(tmp_path):
    chain, _ = tree(3, 3, 0, 1)
    functions = json.loads(generate_chain(chain)["manifest.json"])["functions"]
    assert {f["output"] for f in functions} == {"frames", "M", "f_C", "f_G", "D_E", "effectors", "wrenches", "all"}


def test_all_mistakes_of_a_file_are_told_at_once_and_nothing_is_written(tmp_path):
    file = tmp_path / "wrong.toml"
    text = (EXAMPLES / "quick_return.toml").read_text()
    file.write_text(text.replace('parent = "crank"', 'parent = "crnk"').replace("mass = 5.0", "mass = -5.0"))
    lines = refused(invoke("chain", file, "-o", tmp_path / "out"))
    assert len(lines) == 2
    assert any('did you mean "crank"' in line for line in lines)
    assert not (tmp_path / "out").exists()


OPEN = {
    "a cut that is open": (
        "theta = 3.3933280489079812288",
        "theta = 3.4",
        ["is open by 0.0125579 m and 0.382274 degrees"],
    ),
    "a row that nothing moves": ('alpha = "pi/2" }', 'alpha = "pi/2", c = 0.001 }', ["no coordinate moves it"]),
    "a row that is turned over": ('{ link = "slide" }', '{ link = "slide", alpha = "pi" }', ["turn about x is open"]),
    "too many coordinates": ("[[force]]", '[[independent]]\njoint = "block"\n[[force]]', ["the cuts leave 1 free"]),
}


@pytest.mark.parametrize("case", OPEN)
def test_a_chain_that_cannot_stand_as_its_file_says_is_refused(case, tmp_path):
    old, new, words = OPEN[case]
    text = (EXAMPLES / "quick_return.toml").read_text()
    assert old in text
    (tmp_path / "wrong.toml").write_text(text.replace(old, new, 1))
    lines = refused(invoke("chain", tmp_path / "wrong.toml", "-o", tmp_path / "out"))
    assert all(any(word in line for line in lines) for word in words)
    assert not (tmp_path / "out").exists()


def test_coordinates_that_do_not_determine_the_others_are_refused(tmp_path):
    """In the outer dead centre of a slider-crank the slider does not move: it cannot lead."""
    (tmp_path / "dead.toml").write_text(DEAD_CENTRE)
    (line,) = refused(invoke("chain", tmp_path / "dead.toml", "-o", tmp_path / "out"))
    assert "singular" in line
    assert "crank" in line


DEAD_CENTRE = """
name = "slider_crank"
[[link]]
name = "crank"
parent = "base"
type = "revolute"
[[link]]
name = "rod"
parent = "crank"
type = "revolute"
a = 0.1
[[link]]
name = "slider"
parent = "rod"
type = "revolute"
a = 0.3
[[link]]
name = "slide"
parent = "slider"
type = "prismatic"
psi = "-pi/2"
alpha = "pi/2"
d = 0.4
[[cut]]
name = "slide"
base = { link = "base", psi = "-pi/2", alpha = "pi/2" }
far = { link = "slide" }
[[independent]]
joint = "slide"
"""
