"""Double-double numbers agree with Arb to some 31 digits, alone and in whole programs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import flint
import numpy as np
import pytest

from codegen import models
from codegen.ir.evaluate import arb_domain, evaluate
from codegen.measure.double_double import DoubleDouble, arc_tangent, double_double_domain
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import sample_poses
from codegen.spec.request import Variant

COUNT = 200
DIGITS_31 = 1e-31


@pytest.fixture(autouse=True)
def precise() -> Iterator[None]:
    before, flint.ctx.prec = flint.ctx.prec, 400
    yield
    flint.ctx.prec = before


def numbers(seed: int, size: float = 1.0) -> DoubleDouble:
    rng = np.random.default_rng(seed)
    high = size * rng.normal(size=COUNT) * 10 ** rng.uniform(-3, 3, COUNT)
    return DoubleDouble(high, high * rng.uniform(-1, 1, COUNT) * 2.0**-54)


def balls(value: DoubleDouble) -> list[Any]:
    pairs = zip(np.atleast_1d(value.high), np.atleast_1d(value.low), strict=True)
    return [flint.arb(float(high)) + flint.arb(float(low)) for high, low in pairs]


def largest_error(value: DoubleDouble, truth: list[Any], is_relative: bool = True) -> float:
    pairs = zip(balls(value), truth, strict=True)
    return max(float(abs(x - t) / (abs(t) if is_relative else 1)) for x, t in pairs)


@pytest.mark.parametrize(
    "operation",
    [lambda a, b: a + b, lambda a, b: a - b, lambda a, b: a * b, lambda a, b: a / b],
    ids=["sum", "difference", "product", "quotient"],
)
def test_the_four_operations_have_31_digits(operation: Callable[[Any, Any], Any]) -> None:
    a, b = numbers(1), numbers(2)
    truth = [operation(x, y) for x, y in zip(balls(a), balls(b), strict=True)]
    assert largest_error(operation(a, b), truth) < DIGITS_31


def test_square_roots_have_31_digits_and_that_of_zero_is_zero() -> None:
    square = numbers(3) * numbers(3)
    assert largest_error(square.sqrt(), [x.sqrt() for x in balls(square)]) < DIGITS_31
    assert DoubleDouble.of([0.0]).sqrt().high == 0.0


@pytest.mark.parametrize("size", [1e-3, 1.0, 1e6])
def test_sine_and_cosine_have_31_digits_after_the_point(size: float) -> None:
    angles = numbers(4, size)
    sine, cosine = angles.sine_and_cosine()
    assert largest_error(sine, [x.sin() for x in balls(angles)], is_relative=False) < DIGITS_31
    assert largest_error(cosine, [x.cos() for x in balls(angles)], is_relative=False) < DIGITS_31


def test_the_arc_tangent_has_31_digits() -> None:
    y, x = numbers(5), numbers(6)
    truth = [flint.arb.atan2(a, b) for a, b in zip(balls(y), balls(x), strict=True)]
    assert largest_error(arc_tangent(y, x), truth) < DIGITS_31


@pytest.mark.parametrize(
    "variant", [Variant("screw", "conventional", None), Variant("revolute", "parametric", "table4", "substituted")]
)
def test_programs_have_30_digits_of_their_scale(variant: Variant) -> None:
    joint = models.joint_type(variant.joint)
    program = models.model(variant).program(["phi", "phi_q"])
    poses = sample_poses(joint, variant, program.arguments, PoseDomain(), 4, is_converged=True)
    found = evaluate(program, poses.ideal, double_double_domain())
    exact = {name: [balls(entry) for entry in entries] for name, entries in poses.ideal.items()}
    for pose in range(4):
        inputs = {name: [entry[pose % len(entry)] for entry in entries] for name, entries in exact.items()}
        for name, values in evaluate(program, inputs, arb_domain()).items():
            for value, truth in zip(found[name], values, strict=True):
                entries = balls(value)
                assert abs(float(entries[pose % len(entries)] - truth)) < 1e-30, name
