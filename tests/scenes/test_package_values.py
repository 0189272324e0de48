"""Routines of a scene, called as the manifest says, against derivatives of the constraints on SO(3); and each other."""

from __future__ import annotations

import ctypes
from pathlib import Path

import casadi
import numpy as np
import pytest

from tests.c.packages import compile_silently, have
from tests.harness.library import Array, Library, expand

from .packages import Package, inputs_of, package, truth

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
EXACT = 2e-14
"""Beside the largest entry of a quantity, at least 1."""
FLOAT = 2e-6
CONSTRAINTS = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma", "phi_q_v", "phi_q_t_lambda")


def agree(ours: Array, theirs: Array, tolerance: float) -> bool:
    scale = max(1.0, np.abs(theirs).max(initial=0.0))
    return (
        ours.size == theirs.size and np.abs(ours.reshape(theirs.shape) - theirs).max(initial=0.0) <= tolerance * scale
    )


@pytest.mark.parametrize("seed", range(2))
def test_routines_called_by_the_manifest_alone_give_the_derivatives_of_the_constraints(
    made: Package, seed: int
) -> None:
    """At t = 0 and at poses on no manifold; every word of every output is written, and nothing else."""
    library, inputs = made.library(), inputs_of(made, seed)
    expected = truth(made, inputs)
    tolerance = FLOAT if made.case.real == "float" else EXACT
    called = 0
    for symbol, entry in library.entries.items():
        if set(entry["outputs"]) <= set(CONSTRAINTS):
            found = library.call(symbol, inputs, canary=True, dense=True)
            called += 1
            for name, value in found.items():
                assert agree(value, expected[name], tolerance), (symbol, name)
    assert called


def test_compressed_columns_hold_what_dense_storage_holds(made: Package) -> None:
    library, inputs = made.library(), inputs_of(made, 3)
    for symbol, entry in library.entries.items():
        if entry["storage"] == "dense":
            other = symbol.removesuffix("_dense") + ("" if entry["output"] == "all" else "_nz")
            stored, dense = library.call(other, inputs, dense=True), library.call(symbol, inputs)
            for name, value in dense.items():
                np.testing.assert_array_equal(stored[name], value)


def functions(made: Package) -> dict[str, casadi.Function]:
    return {
        record["output"]: casadi.Function.load(str(made.root / record["file"])) for record in made.manifest["casadi"]
    }


def test_casadi_functions_equal_c(made: Package) -> None:
    library, inputs = made.library(), inputs_of(made, 4)
    by_output = {e["output"]: e for e in made.entries if e["storage"] != "dense"}
    assert functions(made).keys() == by_output.keys()
    for output, function in functions(made).items():
        entry = by_output[output]
        names = [a["name"] for a in entry["arguments"] if a["direction"] == "in"]
        assert [function.name_in(k) for k in range(function.n_in())] == names
        results = function.call([casadi.DM(inputs[name]) for name in names])
        called = library.call(entry["symbol"], inputs, dense=True)
        tolerance = FLOAT if made.case.real == "float" else 1e-15
        for k, name in enumerate(entry["outputs"]):
            assert function.name_out(k) == name
            assert agree(np.asarray(results[k].full()), called[name], tolerance), (output, name)
            pattern = entry["sparsity"].get(name)
            if pattern:
                stored = results[k].sparsity()
                assert (stored.colind(), stored.row()) == (pattern["colind"], pattern["row"])


def test_externals_differentiate_exactly(made: Package, tmp_path: Path) -> None:
    records = [record for record in made.manifest["casadi"] if "external" in record]
    if made.case.real == "float":
        assert records == []
        return
    path = tmp_path / "external.so"
    sources = [str(made.source), str(made.root / "casadi/external.c")]
    compile_silently(["gcc", "-std=c99", "-O1", "-fPIC", "-shared", f"-I{made.root}", *sources, "-lm", "-o", str(path)])
    inputs = inputs_of(made, 5)
    for record in records:
        function = casadi.Function.load(str(made.root / record["file"]))
        external = casadi.external(record["external"]["name"], str(path))
        arguments = [casadi.DM(inputs[function.name_in(k)]) for k in range(function.n_in())]
        assert agree(external(*arguments).full(), function(*arguments).full(), 1e-14)
        for ours, theirs in zip(
            *(f.jacobian().call([*arguments, casadi.DM.zeros(*f.size_out(0))]) for f in (external, function)),
            strict=True,
        ):
            assert agree(ours.full(), theirs.full(), 1e-13)


def test_the_pattern_functions_give_the_patterns_of_the_manifest(made: Package) -> None:
    loaded = ctypes.CDLL(str(made.library().path))
    for entry in made.entries:
        for pattern in entry["sparsity"].values():
            words = [pattern["nrow"], pattern["ncol"], *pattern["colind"], *pattern["row"]]
            function = getattr(loaded, pattern["function"])
            function.restype = ctypes.POINTER(ctypes.c_int)
            assert function()[: len(words)] == words


@pytest.mark.parametrize("name", ["engine with table4 rows", "spatial slider-crank"])
def test_a_float_routine_is_within_the_rounding_of_a_double_one(name: str, scene_packages: Path) -> None:
    made = package(name, scene_packages)
    inputs, double = inputs_of(made, 6), made.library()
    single = Library([{**e, "real": "float"} for e in made.entries], made.library("-O1", "-DJG_REAL_IS_FLOAT").path)
    for symbol in double.entries:
        for output, value in double.call(symbol, inputs).items():
            assert agree(single.call(symbol, inputs)[output].astype(float), value, FLOAT), symbol


def test_a_pattern_misses_no_entry_that_is_not_zero(made: Package) -> None:
    """The independent derivative is zero, to rounding, wherever nothing is stored."""
    inputs = inputs_of(made, 1)
    expected = truth(made, inputs)
    for entry in made.entries:
        for name, pattern in entry["sparsity"].items():
            if name in CONSTRAINTS and entry["storage"] == "nz":
                stored = expand(np.ones(len(pattern["row"])), pattern).astype(bool)
                assert np.abs(expected[name][~stored]).max(initial=0.0) < EXACT * max(1.0, np.abs(expected[name]).max())
