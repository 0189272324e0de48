"""Derivatives in C against differences of what C itself computes one level lower, along motions on SO(3).

Central differences on nine points, of eighth order; their own doubt (distance from the sixth-order formula, and
rounding) must lie below the tolerance, or the comparison would say nothing. Both are relative to the largest entry of
the derivative (at least 1).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from codegen.spec.request import Variant

from .cases import SPOTS, Spot, Values, every_variant, inputs_at, largest
from .motion import Difference, coasted, difference, moved
from .notes import Notes
from .workshop import Bench

TOLERANCE = 1e-8
VARIATION_STEP = 0.02  # m, rad
TIME_STEP = 0.008  # s, at velocities of order 1 m/s and 1 to 4 rad/s


class Comparison:
    """Compares C with differences, and notes the error and the doubt of the differences it was measured by."""

    def __init__(self, note: Notes) -> None:
        self._note = note

    def __call__(self, place: Any, emitted: Values, measured: Difference) -> None:
        scale = max(1.0, largest(measured.value))
        doubt, error = measured.doubt / scale, largest(emitted - measured.value) / scale
        assert doubt < TOLERANCE, (place, "differences are too coarse", doubt)
        assert error < TOLERANCE, (place, error, doubt)
        self._note("error", error)
        self._note("doubt of the differences", doubt)


@pytest.fixture
def compare(note: Notes) -> Comparison:
    """The comparison of a test."""
    return Comparison(note)


def spots_of_phi(variant: Variant) -> tuple[Spot, ...]:
    """Where phi_q and gamma are derivatives of phi: for the substituted derivative, on the manifold only."""
    return tuple(spot for spot in SPOTS if spot[1] or variant.derivative == "exact")


def columns(
    variant: Variant, inputs: dict[str, Any], quantity: Callable[[dict[str, Any]], Values]
) -> list[tuple[int, Difference]]:
    """Derivatives of a quantity along each of the n virtual variations."""
    n = len(inputs["velocity"])

    def along(direction: Values) -> Difference:
        return difference(lambda t: quantity(moved(variant, inputs, t * direction)), VARIATION_STEP)

    return [(k, along(direction)) for k, direction in enumerate(np.eye(n))]


@every_variant
def test_phi_q_is_the_derivative_of_phi(bench: Bench, variant: Variant, compare: Comparison) -> None:
    for spot in spots_of_phi(variant):
        inputs = inputs_at(variant, spot)
        phi_q = bench.value("phi_q", inputs)
        for k, measured in columns(variant, inputs, lambda there: bench.value("phi", there)):
            compare((spot, k), phi_q[:, k], measured)


@every_variant
def test_second_derivative_is_the_derivative_of_the_force(bench: Bench, variant: Variant, compare: Comparison) -> None:
    """phi_q_t_lambda_q = d(phi_q^T lambda)/dq, in both conventions, on the manifold and off it."""
    for spot in SPOTS:
        inputs = inputs_at(variant, spot)
        second = bench.value("phi_q_t_lambda_q", inputs)
        for k, measured in columns(variant, inputs, lambda there: bench.value("phi_q_t_lambda", there)):
            compare((spot, k), second[:, k], measured)


@every_variant
def test_gamma_is_minus_the_rate_of_phi_q_v_without_acceleration(
    bench: Bench, variant: Variant, compare: Comparison
) -> None:
    """At rddot = 0 in world axes, omegadot = 0, alphaddot = 0; in both conventions, on the manifold and off it."""
    for spot in SPOTS:
        inputs = inputs_at(variant, spot)
        rate = difference(lambda t, start=inputs: bench.value("phi_q_v", coasted(variant, start, t)), TIME_STEP)
        compare(spot, -bench.value("gamma", inputs), rate)


@every_variant
def test_gamma_is_minus_the_second_rate_of_phi_without_acceleration(
    bench: Bench, variant: Variant, compare: Comparison
) -> None:
    """Substituted: along tangent motions on the manifold."""
    for spot in spots_of_phi(variant):
        inputs = inputs_at(variant, spot)
        rate = difference(lambda t, start=inputs: bench.value("phi", coasted(variant, start, t)), TIME_STEP, order=2)
        compare(spot, -bench.value("gamma", inputs), rate)


@every_variant
def test_phi_q_a_less_gamma_is_the_second_rate_of_phi(bench: Bench, variant: Variant, compare: Comparison) -> None:
    """The convention of a: (rddot in the axes of delta r, omegadot, ..., alphaddot), rddot = d(rdot)/dt in the world.

    r(t) = r + rdot t + rddot t^2/2 and A(t) = A exp((omega t + omegadot t^2/2)~), in world variation with exp on the
    left, have these velocities and accelerations at t = 0.
    """
    for spot in spots_of_phi(variant):
        inputs = inputs_at(variant, spot)
        v = inputs["velocity"]
        a = np.random.default_rng(spot[0] + 2).normal(size=v.shape)

        def phi(t: float, start: dict[str, Any] = inputs, v: Values = v, a: Values = a) -> Values:
            return bench.value("phi", moved(variant, start, v * t + a * (t * t / 2)))

        emitted = bench.value("phi_q", inputs) @ a - bench.value("gamma", inputs)
        compare(spot, emitted, difference(phi, TIME_STEP, order=2))
