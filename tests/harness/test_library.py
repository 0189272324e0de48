"""The harness judged on hand-written routines: one that is right and some that break the contract."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from .library import HarnessError, Library

HEADER = """
#ifndef TOY_H
#define TOY_H
typedef {real} jg_real;
void toy_nz(const jg_real *A_i, const jg_real *lambda, jg_real *out);
void toy_dense(const jg_real *A_i, const jg_real *lambda, jg_real *out);
void toy_overrun(const jg_real *A_i, const jg_real *lambda, jg_real *out);
void toy_input(jg_real *A_i, const jg_real *lambda, jg_real *out);
void toy_lazy(const jg_real *A_i, const jg_real *lambda, jg_real *out);
#endif
"""
SOURCE = """
#include <jointgen/toy.h>
#include <math.h>
/* out = [[A00, 0, A12 l0], [0, A21 l1, 0]] */
void toy_nz(const jg_real *A, const jg_real *l, jg_real *o)
{ o[0] = A[0]; o[1] = A[5] * l[1]; o[2] = A[7] * l[0]; }
void toy_dense(const jg_real *A, const jg_real *l, jg_real *o)
{ o[0] = A[0]; o[1] = o[2] = 0; o[3] = A[5] * l[1]; o[4] = A[7] * l[0]; o[5] = 0; }
void toy_overrun(const jg_real *A, const jg_real *l, jg_real *o) { toy_nz(A, l, o); o[3] = 1; }
void toy_input(jg_real *A, const jg_real *l, jg_real *o) { toy_nz(A, l, o); A[4] = -A[4]; }
void toy_lazy(const jg_real *A, const jg_real *l, jg_real *o) { o[0] = A[0]; o[2] = (jg_real)sqrt(l[0]); }
"""


def toy_entry(symbol: str, real: str) -> dict[str, Any]:
    """Manifest entry of one toy routine."""
    dense = symbol.endswith("dense")
    layout = "column-major" if dense else "compressed-columns"
    return {
        "symbol": symbol,
        "header": "c/include/jointgen/toy.h",
        "source": "c/src/toy.c",
        "real": real,
        "storage": "dense" if dense else "nz",
        "arguments": [
            {"name": "A_i", "direction": "in", "shape": [3, 3], "length": 9, "layout": "column-major"},
            {"name": "lambda", "direction": "in", "shape": [2], "length": 2, "layout": "vector"},
            {
                "name": "out",
                "direction": "out",
                "shape": [2, 3],
                "length": 6 if dense else 3,
                "layout": layout,
            },
        ],
        "sparsity": {"out": {"nrow": 2, "ncol": 3, "colind": [0, 1, 2, 3], "row": [0, 1, 0]}},
    }


@pytest.fixture(params=["double", "float"])
def library(request: pytest.FixtureRequest, tmp_path: Path) -> Library:
    """Toy library in one real type."""
    root = tmp_path / "generated"
    (root / "c/include/jointgen").mkdir(parents=True)
    (root / "c/src").mkdir()
    (root / "c/include/jointgen/toy.h").write_text(HEADER.replace("{real}", request.param))
    (root / "c/src/toy.c").write_text(SOURCE)
    symbols = ("toy_nz", "toy_dense", "toy_overrun", "toy_input", "toy_lazy")
    functions = [toy_entry(symbol, request.param) for symbol in symbols]
    (root / "manifest.json").write_text(json.dumps({"schema_version": 1, "functions": functions}))
    first = Library.build(root / "manifest.json", tmp_path / "cache", flags=["-Wall", "-Werror"])
    again = Library.build(root / "manifest.json", tmp_path / "cache", flags=["-Wall", "-Werror"])
    assert first.path == again.path
    assert len(list((tmp_path / "cache").iterdir())) == 2
    return first


INPUTS = {"A_i": np.arange(9.0).reshape(3, 3), "lambda": np.array([4.0, 10.0]), "unused": np.zeros(2)}
EXPECTED = np.array([[0.0, 0.0, 20.0], [0.0, 70.0, 0.0]])


def test_values_in_both_storages(library: Library) -> None:
    for symbol in ("toy_nz", "toy_dense"):
        for canary in (False, True):
            out = library.call(symbol, INPUTS, canary=canary, dense=True)["out"]
            np.testing.assert_array_equal(out, EXPECTED)
            assert out.dtype == {"double": np.float64, "float": np.float32}[library.entries[symbol]["real"]]
    np.testing.assert_array_equal(library.call("toy_nz", INPUTS)["out"], [0.0, 70.0, 20.0])
    flat = INPUTS | {"A_i": INPUTS["A_i"].ravel(order="F")}
    np.testing.assert_array_equal(library.call("toy_dense", flat)["out"], EXPECTED)
    assert [entry["symbol"] for entry in library.find(storage="dense")] == ["toy_dense"]


@pytest.mark.parametrize(
    ("symbol", "message"),
    [
        ("toy_overrun", "wrote behind"),
        ("toy_input", "A_i: input changed"),
        ("toy_lazy", r"entries \[1\] not written"),
    ],
)
def test_canary_finds_broken_contracts(library: Library, symbol: str, message: str) -> None:
    library.call(symbol, INPUTS)
    with pytest.raises(HarnessError, match=message):
        library.call(symbol, INPUTS, canary=True)


def test_wrong_calls_are_named(library: Library) -> None:
    with pytest.raises(HarnessError, match="no input 'lambda'"):
        library.call("toy_nz", {"A_i": np.eye(3)})
    with pytest.raises(HarnessError, match="A_i: shape"):
        library.call("toy_nz", INPUTS | {"A_i": np.zeros((9, 1))})
    with pytest.raises(HarnessError, match="lambda: 3 words"):
        library.call("toy_nz", INPUTS | {"lambda": np.zeros(3)})
