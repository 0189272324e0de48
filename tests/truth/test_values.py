"""Every C routine against the reference, which was written from the specification alone (`tests.reference`).

Errors are relative to the largest entry of the true output, or to 1 where that is larger.
"""

from __future__ import annotations

import ctypes
from typing import Any

import numpy as np

from codegen import build
from codegen.spec.request import OUTPUTS, QUANTITIES, Options, Variant

from .cases import (
    COMMITTED,
    REQUESTED,
    SPOTS,
    VARIANTS,
    Values,
    committed_manifest,
    each,
    every_output,
    every_variant,
    inputs_at,
    largest,
    stated_directions,
    truth_at,
    variant_of,
)
from .notes import Notes
from .workshop import Bench, request

TOLERANCE = 1e-13


def test_every_committed_function_is_judged() -> None:
    """The tests run over variants and outputs; no function of the manifest is outside them."""
    judged = {(variant, output) for variant in VARIANTS for output in OUTPUTS}
    assert {(variant_of(entry), entry["output"]) for entry in committed_manifest()["functions"]} <= judged
    assert build.variants(Options()) == COMMITTED
    assert len(set(VARIANTS)) == len(VARIANTS)


@each(*REQUESTED)
def test_options_ask_for_the_variant_meant(variant: Variant) -> None:
    assert build.variants(request(variant)) == (variant,)


@every_output
@every_variant
def test_c_agrees_with_the_reference(bench: Bench, variant: Variant, output: str, note: Notes) -> None:
    for spot in SPOTS:
        inputs, truth = inputs_at(variant, spot), truth_at(variant, spot)
        for entry in bench.entries(output):
            values = bench.double.call(entry["symbol"], inputs, dense=True, canary=True)
            assert list(values) == (list(QUANTITIES) if output == "all" else [output])
            for quantity, value in values.items():
                wrong = value - truth[quantity].reshape(value.shape)
                if quantity == "phi_q_t_lambda_q":
                    wrong = wrong @ stated_directions(variant, inputs)
                error = largest(wrong) / max(1.0, largest(truth[quantity]))
                assert error < TOLERANCE, (entry["symbol"], quantity, spot, error)
                note("error", error)


def stored_entries(bench: Bench, output: str) -> dict[str, tuple[Any, Any]]:
    """Quantity -> (rows, columns) of the stored entries of a matrix routine."""
    entry = bench.entry(output)
    places = {}
    for quantity, pattern in entry["sparsity"].items():
        columns = np.repeat(np.arange(pattern["ncol"]), np.diff(pattern["colind"]))
        places[quantity] = (np.array(pattern["row"], dtype=int), columns)
    return places


def largest_entries(variant: Variant, quantity: str) -> Values:
    """Largest magnitude of each entry of the true matrix over all poses, on the stated directions."""
    matrices = [truth_at(variant, spot)[quantity] for spot in SPOTS]
    return np.asarray(np.max(np.abs(matrices), axis=0))


@every_variant
def test_no_true_nonzero_lies_outside_the_pattern(bench: Bench, variant: Variant) -> None:
    for output in ("phi_q", "phi_q_t_lambda_q", "all"):
        for quantity, places in stored_entries(bench, output).items():
            outside = largest_entries(variant, quantity)
            outside[places] = 0.0
            assert largest(outside) < TOLERANCE, (output, quantity, np.argwhere(outside > TOLERANCE))


@every_variant
def test_no_stored_entry_is_zero_at_every_pose(bench: Bench, variant: Variant) -> None:
    for output in ("phi_q", "phi_q_t_lambda_q", "all"):
        for quantity, places in stored_entries(bench, output).items():
            symbol = bench.entry(output)["symbol"]
            seen = [bench.double.call(symbol, inputs_at(variant, spot))[quantity] for spot in SPOTS]
            sizes = np.max(np.abs(seen), axis=0)
            idle = [(int(places[0][k]), int(places[1][k])) for k in np.flatnonzero(sizes < TOLERANCE)]
            assert not idle, (symbol, quantity, idle)


@every_variant
def test_exported_pattern_is_the_manifest_s(bench: Bench, variant: Variant) -> None:
    library = ctypes.CDLL(str(bench.double.path))
    for output in ("phi_q", "phi_q_t_lambda_q", "all"):
        for pattern in bench.entry(output)["sparsity"].values():
            function = getattr(library, pattern["function"])
            function.restype = ctypes.POINTER(ctypes.c_int)
            expected = [pattern["nrow"], pattern["ncol"], *pattern["colind"], *pattern["row"]]
            assert function()[: len(expected)] == expected


@every_variant
def test_dense_is_the_pattern_filled_with_zeros(bench: Bench, variant: Variant) -> None:
    for output in ("phi_q", "phi_q_t_lambda_q", "all"):
        inputs = inputs_at(variant, SPOTS[-1])
        stored = bench.double.call(bench.entry(output)["symbol"], inputs, dense=True)
        dense = bench.double.call(bench.entry(output, dense=True)["symbol"], inputs)
        for quantity, value in dense.items():
            np.testing.assert_array_equal(value, stored[quantity])


@every_variant
def test_products_are_products_with_the_jacobian(bench: Bench, variant: Variant) -> None:
    for spot in SPOTS:
        inputs = inputs_at(variant, spot)
        phi_q = bench.value("phi_q", inputs)
        for product, expected in (
            ("phi_q_v", phi_q @ inputs["velocity"]),
            ("phi_q_t_lambda", phi_q.T @ inputs["lambda"]),
        ):
            error = largest(bench.value(product, inputs) - expected)
            assert error < TOLERANCE * max(1.0, largest(expected)), (product, spot, error)
