"""The CasADi functions, as saved and as built, against C: names, shapes, patterns and values."""

from __future__ import annotations

from typing import Any

import casadi
import numpy as np

import codegen
from codegen import build
from codegen.spec.request import Variant

from .cases import COMMITTED, SPOTS, each, every_variant, inputs_at, natural_scale
from .notes import Notes
from .workshop import Bench

TOLERANCE = 1e-15


def loaded(bench: Bench, output: str) -> Any:
    """The saved function of one routine."""
    return casadi.Function.load(str(bench.saved[output]))


def pattern(sparsity: Any) -> tuple[int, int, list[int], list[int]]:
    """Rows, columns, column offsets and row numbers of a CasADi pattern."""
    return sparsity.size1(), sparsity.size2(), list(sparsity.colind()), list(sparsity.row())


def dense_pattern(shape: list[int]) -> tuple[int, int, list[int], list[int]]:
    """The same of a dense matrix."""
    nrow, ncol = shape
    return nrow, ncol, [nrow * k for k in range(ncol + 1)], list(range(nrow)) * ncol


def manifest_pattern(entry: dict[str, Any], argument: dict[str, Any]) -> tuple[int, int, list[int], list[int]]:
    """The same of an argument of a manifest entry that stores nonzeros."""
    sparsity = entry["sparsity"].get(argument["name"])
    if sparsity is None:
        return dense_pattern(argument["shape"])
    return sparsity["nrow"], sparsity["ncol"], sparsity["colind"], sparsity["row"]


def interface(function: Any) -> list[tuple[str, str, Any]]:
    """Direction, name and pattern of every argument of a CasADi function."""
    inputs = zip(function.name_in(), map(function.sparsity_in, range(function.n_in())), strict=True)
    outputs = zip(function.name_out(), map(function.sparsity_out, range(function.n_out())), strict=True)
    read = [("in", name, pattern(sparsity)) for name, sparsity in inputs]
    return read + [("out", name, pattern(sparsity)) for name, sparsity in outputs]


@every_variant
def test_saved_functions_have_the_arguments_of_c(bench: Bench, variant: Variant) -> None:
    assert list(bench.saved) == list(bench.programs)
    for output in bench.saved:
        entry = bench.entry(output)
        declared = [(a["direction"], a["name"], manifest_pattern(entry, a)) for a in entry["arguments"]]
        function = loaded(bench, output)
        assert interface(function) == declared
        assert function.name() == f"{variant.stem}_{output}"


@every_variant
def test_saved_functions_equal_c(bench: Bench, variant: Variant, note: Notes) -> None:
    for output in bench.saved:
        function, symbol = loaded(bench, output), bench.entry(output)["symbol"]
        for spot in SPOTS:
            inputs = inputs_at(variant, spot)
            values = function(**{name: inputs[name] for name in function.name_in()})
            for quantity, stored in bench.double.call(symbol, inputs).items():
                there = np.array(values[quantity].nonzeros())
                scale = natural_scale(variant, quantity, stored)
                error = float(np.max(np.abs(there - np.ravel(stored, order="F")), initial=0.0)) / scale
                assert error <= TOLERANCE, (symbol, quantity, spot, error)
                note("error", error)


@every_variant
def test_casadi_function_builds_what_is_saved(bench: Bench, variant: Variant) -> None:
    """The function a user calls; of the outputs the quickest here, all of them for the revolute joint below."""
    options = {"rows": variant.rows, "derivative": variant.derivative, "variation": variant.variation}
    built = build.casadi_function(variant.joint, variant.form, "phi", **options)
    assert built.serialize() == loaded(bench, "phi").serialize()


@each(*(variant for variant in COMMITTED if variant.joint == "revolute"))
def test_casadi_function_builds_every_output(bench: Bench, variant: Variant) -> None:
    options = {"rows": variant.rows or "regular"} if variant.form == "parametric" else {}
    options |= {"derivative": variant.derivative, "variation": variant.variation}
    for output in bench.saved:
        built = codegen.casadi_function(variant.joint, variant.form, output, **options)
        assert built.serialize() == loaded(bench, output).serialize()
