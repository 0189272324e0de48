"""The CasADi externals evaluate the C routines and differentiate them exactly."""

import shutil
import subprocess
from pathlib import Path

import casadi
import numpy as np
import pytest

import codegen
from codegen.emit.casadi_external import EXTERNALS
from tests.reference.poses import sample

GENERATED = Path(__file__).resolve().parents[2] / "generated"
FLAGS = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Werror", "-O1", "-shared", "-fPIC"]

VARIANTS = {
    "revolute_conventional": ("revolute", "conventional", {}),
    "universal_parametric": ("universal", "parametric", {}),
    "screw_parametric_table4": ("screw", "parametric", {"rows": "table4"}),
    "rigid_parametric_substituted": ("rigid", "parametric", {"derivative": "substituted"}),
}

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")


@pytest.fixture(scope="module", params=VARIANTS)
def library(request, tmp_path_factory) -> tuple[str, Path]:
    stem = request.param
    target = tmp_path_factory.mktemp("external") / f"{stem}.so"
    sources = [GENERATED / "c" / "src" / f"{stem}.c", GENERATED / "casadi" / "external" / f"{stem}.c"]
    include = GENERATED / "c" / "include"
    subprocess.run(["gcc", *FLAGS, f"-I{include}", *map(str, sources), "-lm", "-o", str(target)], check=True)
    return stem, target


def arguments_of(function: casadi.Function, joint: str, form: str, options: dict[str, str]) -> list[np.ndarray]:
    """A random pose off the manifold, in the order of the function's inputs."""
    pose = sample(
        joint, form, 5, rows=options.get("rows", "regular" if form == "parametric" else None), consistent=False
    )
    names = [function.name_in(k) for k in range(function.n_in())]
    return [np.asarray(pose[name]).reshape(function.size_in(k), order="F") for k, name in enumerate(names)]


@pytest.mark.parametrize("quantity", EXTERNALS)
def test_an_external_has_the_value_and_the_jacobian_of_the_function(library, quantity):
    stem, path = library
    joint, form, options = VARIANTS[stem]
    function = codegen.casadi_function(joint, form, quantity, **options)
    external = casadi.external(f"jg_{stem}_{quantity}_external", str(path))
    assert [external.name_in(k) for k in range(external.n_in())] == [
        function.name_in(k) for k in range(function.n_in())
    ]
    arguments = arguments_of(function, joint, form, options)
    value = np.asarray(function(*arguments))
    assert np.abs(np.asarray(external(*arguments)) - value).max() <= 1e-14 * max(1.0, np.abs(value).max())
    ours, theirs = (f.jacobian()(*arguments, np.zeros(f.size_out(0))) for f in (external, function))
    pairs = zip(*(blocks if isinstance(blocks, tuple) else (blocks,) for blocks in (ours, theirs)), strict=True)
    for mine, expected in pairs:
        assert mine.sparsity().is_subset(expected.sparsity())
        scale = max(1.0, np.abs(np.asarray(expected)).max())
        assert np.abs(np.asarray(mine) - np.asarray(expected)).max() <= 1e-13 * scale


def test_an_external_takes_part_in_a_larger_expression(library):
    stem, path = library
    external = casadi.external(f"jg_{stem}_phi_external", str(path))
    symbols = [casadi.MX.sym(external.name_in(k), *external.size_in(k)) for k in range(external.n_in())]
    energy = casadi.sumsqr(external(*symbols))
    gradient = casadi.Function("gradient", symbols, [casadi.gradient(energy, symbols[0])])
    joint, form, options = VARIANTS[stem]
    arguments = arguments_of(external, joint, form, options)
    jacobian = casadi.Function("jacobian", symbols, [casadi.jacobian(external(*symbols), symbols[0])])(*arguments)
    expected = 2 * np.asarray(jacobian).T @ np.asarray(external(*arguments))
    assert np.abs(np.asarray(gradient(*arguments)).ravel() - expected.ravel()).max() < 1e-12
