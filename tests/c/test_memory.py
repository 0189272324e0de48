"""A routine touches what its manifest entry declares and nothing else; both storages hold the same matrix."""

from __future__ import annotations

import ctypes
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from tests.harness.library import Library

from .packages import Package, have

pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")
EXTREMES = (0.0, 1e300, -1e300, 5e-324, np.inf, -np.inf)


@pytest.fixture
def library(generated: Package) -> Library:
    return generated.library()


def inputs_of(entry: Mapping[str, Any], draw: Any) -> dict[str, Any]:
    return {a["name"]: draw(a["length"]) for a in entry["arguments"] if a["direction"] == "in"}


def test_guards_hold_inputs_stay_and_every_output_is_written(library: Library) -> None:
    rng = np.random.default_rng(1)
    for symbol, entry in library.entries.items():
        library.call(symbol, inputs_of(entry, lambda n: rng.normal(size=n)), canary=True)
        with np.errstate(over="ignore", under="ignore"):
            library.call(symbol, inputs_of(entry, lambda n: rng.choice(EXTREMES, size=n)), canary=True)


def test_both_storages_hold_the_same_matrix(library: Library) -> None:
    rng = np.random.default_rng(2)
    pairs = 0
    for symbol, entry in library.entries.items():
        if entry["storage"] != "nz":
            continue
        stem = symbol.removesuffix("_nz")
        inputs = inputs_of(entry, lambda n: rng.normal(size=n))
        stored = library.call(symbol, inputs, dense=True)
        dense = library.call(f"{stem}_dense", inputs)
        assert stored.keys() == dense.keys() == set(entry["outputs"])
        for name in stored:
            np.testing.assert_array_equal(stored[name], dense[name])
        pairs += 1
    assert pairs == sum(entry["storage"] == "dense" for entry in library.entries.values()) > 0


def test_the_pattern_functions_give_the_patterns_of_the_manifest(library: Library) -> None:
    loaded = ctypes.CDLL(str(library.path))
    patterns = {p["function"]: p for entry in library.entries.values() for p in entry["sparsity"].values()}
    for symbol, pattern in patterns.items():
        expected = [pattern["nrow"], pattern["ncol"], *pattern["colind"], *pattern["row"]]
        function = getattr(loaded, symbol)
        function.restype = ctypes.POINTER(ctypes.c_int)
        assert function()[: len(expected)] == expected, symbol


def test_lengths_and_shapes_of_the_manifest_fit_each_other(generated: Package) -> None:
    for entry in generated.entries:
        for argument in entry["arguments"]:
            nrow, ncol = argument["shape"]
            if argument["layout"] == "compressed-columns":
                pattern = entry["sparsity"][argument["name"]]
                assert argument["length"] == len(pattern["row"]) == pattern["colind"][-1]
                assert (nrow, ncol) == (pattern["nrow"], pattern["ncol"])
            else:
                assert argument["length"] == nrow * ncol
        directions = [argument["direction"] for argument in entry["arguments"]]
        assert directions == sorted(directions), "inputs come before outputs"
        order = ["r_i", "A_i", "r_j", "A_j", "alpha", "geometry", "velocity", "lambda"]
        names = [argument["name"] for argument in entry["arguments"] if argument["direction"] == "in"]
        assert names == [name for name in order if name in names], "DESIGN 3.2: order of arguments"
