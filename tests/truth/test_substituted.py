"""The substituted derivative beside the exact one: equal along the manifold, different across it (SPEC S1.1, S1.2).

Errors are relative to the largest entry (at least 1). The differences are printed by each test (`pytest -rA`) and noted
in its report, in the unit of the matrix, for multipliers of order 1.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from codegen.spec.request import Variant
from tests.reference.constraints import pair

from .cases import SPOTS, VARIANTS, Values, each, inputs_at, largest
from .notes import Notes
from .workshop import Bench, Workshop

linalg = pytest.importorskip("scipy.linalg")

TOLERANCE = 1e-12
SMALLEST_DIFFERENCE = 0.05
"""Where SPEC says O(1) for lengths and multipliers of order 1."""

SUBSTITUTED = tuple(variant for variant in VARIANTS if variant.derivative == "substituted")
PARAMETRIC = tuple(variant for variant in SUBSTITUTED if variant.form == "parametric")
every_substituted = each(*SUBSTITUTED)
every_parametric = each(*PARAMETRIC)
ON_MANIFOLD = tuple(spot for spot in SPOTS if spot[1])
OFF_MANIFOLD = tuple(spot for spot in SPOTS if not spot[1])


def exact_of(workshop: Workshop, variant: Variant) -> Bench:
    """The same variant with the exact derivative."""
    return workshop.bench(replace(variant, derivative="exact"))


def error(value: Values, expected: Values) -> float:
    """Largest difference, relative."""
    return largest(value - expected) / max(1.0, largest(expected))


def tangents(phi_q: Values) -> Values:
    """Orthonormal basis [n, k] of the tangent directions."""
    return np.asarray(linalg.null_space(phi_q, rcond=1e-10))


@every_substituted
def test_phi_is_the_same(bench: Bench, workshop: Workshop, variant: Variant) -> None:
    exact = exact_of(workshop, variant)
    for spot in SPOTS:
        inputs = inputs_at(variant, spot)
        np.testing.assert_array_equal(bench.value("phi", inputs), exact.value("phi", inputs))


@every_substituted
def test_phi_q_is_exact_on_the_manifold(bench: Bench, workshop: Workshop, variant: Variant, note: Notes) -> None:
    exact = exact_of(workshop, variant)
    for spot in ON_MANIFOLD:
        inputs = inputs_at(variant, spot)
        for quantity in ("phi_q", "phi_q_v", "phi_q_t_lambda"):
            apart = error(bench.value(quantity, inputs), exact.value(quantity, inputs))
            note("error", apart)
            assert apart < TOLERANCE, (quantity, spot, apart)
        note("phi_q v of tangent v", largest(bench.value("phi_q_v", inputs)))
        assert largest(bench.value("phi_q_v", inputs)) < TOLERANCE


@every_substituted
def test_second_derivative_is_exact_along_the_manifold(
    bench: Bench, workshop: Workshop, variant: Variant, note: Notes
) -> None:
    exact = exact_of(workshop, variant)
    for spot in ON_MANIFOLD:
        inputs = inputs_at(variant, spot)
        along = tangents(exact.value("phi_q", inputs))
        assert along.shape[1] > 0
        second, exact_second = (which.value("phi_q_t_lambda_q", inputs) for which in (bench, exact))
        apart = error(second @ along, exact_second @ along)
        gamma_apart = error(bench.value("gamma", inputs), exact.value("gamma", inputs))
        note("error", apart)
        note("error of gamma", gamma_apart)
        assert apart < TOLERANCE and gamma_apart < TOLERANCE, (spot, apart, gamma_apart)


@every_substituted
def test_second_derivative_differs_across_the_manifold(
    bench: Bench, workshop: Workshop, variant: Variant, note: Notes
) -> None:
    """In the conventional screw by pitch times the multiplier of the screw row, elsewhere by O(1)."""
    exact = exact_of(workshop, variant)
    for spot in ON_MANIFOLD:
        inputs = inputs_at(variant, spot)
        across = linalg.orth(exact.value("phi_q", inputs).T, rcond=1e-10)
        second, exact_second = (which.value("phi_q_t_lambda_q", inputs) for which in (bench, exact))
        usual = abs(inputs["geometry"][24] * inputs["lambda"][-1]) if variant.form == "conventional" else 1.0
        apart = largest((second - exact_second) @ across)
        note(f"largest difference, {variant.form}", apart)
        note(f"smallest difference, {variant.form}", apart)
        print(f"{variant.stem}: phi_q_t_lambda_q across the manifold, substituted less exact: {apart:.3g}")
        assert apart > SMALLEST_DIFFERENCE * usual


@every_parametric
def test_phi_q_differs_off_the_manifold(bench: Bench, workshop: Workshop, variant: Variant, note: Notes) -> None:
    exact = exact_of(workshop, variant)
    for spot in OFF_MANIFOLD:
        inputs = inputs_at(variant, spot)
        apart = largest(bench.value("phi_q", inputs) - exact.value("phi_q", inputs))
        note("largest difference", apart)
        note("smallest difference", apart)
        print(f"{variant.stem}: phi_q off the manifold, substituted less exact: {apart:.3g}")
        assert apart > SMALLEST_DIFFERENCE


@every_parametric
def test_phi_q_depends_on_alpha_and_geometry_alone(bench: Bench, variant: Variant) -> None:
    arguments = [a["name"] for a in bench.entry("phi_q")["arguments"] if a["direction"] == "in"]
    assert set(arguments) <= {"alpha", "geometry"}


@every_parametric
def test_blocks_that_vanish_are_not_stored(bench: Bench, variant: Variant) -> None:
    """(Phi_Z^T l)_Z, (Phi_alpha^T l)_Z, and for trn (Phi_alpha^T l)_alpha: SPEC S1.2."""
    pattern = bench.entry("phi_q_t_lambda_q")["sparsity"]["phi_q_t_lambda_q"]
    columns = np.repeat(np.arange(pattern["ncol"]), np.diff(pattern["colind"]))
    translations = 0 if variant.joint == "screw" else pair(variant.joint)[0]
    assert not np.any(columns < 12)
    rows = np.array(pattern["row"], dtype=int)
    translational = (rows >= 12) & ((rows < 12 + translations) | (columns < 12 + translations))
    assert not np.any(translational)
