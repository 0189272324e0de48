"""C in double and in float against the same Program in Arb at 200 bits: the error of floating-point arithmetic alone.

The natural scale of an output is the magnitude of its largest entry at the pose; where it cancels (phi and phi_q v on
the manifold) its usual size, the least such magnitude over the poses off the manifold (`cases.natural_scale`).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from codegen.ir.evaluate import arb_domain, evaluate
from codegen.spec.request import Variant
from tests.harness.library import Library

from .cases import SPOTS, every_variant, inputs_at, natural_scale
from .notes import Notes
from .workshop import Bench

flint = pytest.importorskip("flint")

DOUBLE_TOLERANCE = 1e-14
FLOAT_TOLERANCE = 1e-5
LARGEST_RADIUS = 1e-40
"""Of the balls relative to the scale: what Arb says of its own error."""


@pytest.fixture(autouse=True)
def _precision() -> Iterator[None]:
    """200-bit flint numbers inside each test."""
    before, flint.ctx.prec = flint.ctx.prec, 200
    yield
    flint.ctx.prec = before


def exactly(inputs: dict[str, Any]) -> dict[str, list[Any]]:
    """The inputs as Arb numbers without error, column-major."""
    return {name: [flint.arb(float(x)) for x in np.ravel(value, order="F")] for name, value in inputs.items()}


def check(bench: Bench, library: Library, real: type[Any], tolerance: float, note: Notes) -> None:
    """Every routine at every pose: the error relative to the natural scale of the output."""
    for spot in SPOTS:
        inputs = {name: value.astype(real) for name, value in inputs_at(bench.variant, spot).items()}
        exact_inputs = exactly(inputs)
        for output, program in bench.programs.items():
            symbol = bench.entry(output)["symbol"]
            values = library.call(symbol, inputs)
            for quantity, truth in evaluate(program, exact_inputs, arb_domain()).items():
                scale = natural_scale(bench.variant, quantity, [float(x) for x in truth])
                stored = np.ravel(values[quantity], order="F")
                assert len(stored) == len(truth)
                assert all(float(x.rad()) <= LARGEST_RADIUS * scale for x in truth)
                pairs = zip(stored, truth, strict=True)
                error = max((abs(float(flint.arb(float(c)) - x)) for c, x in pairs), default=0.0) / scale
                assert error < tolerance, (symbol, quantity, spot, error)
                note("error", error)


@every_variant
def test_double_is_the_program_to_1e_14_of_scale(bench: Bench, variant: Variant, note: Notes) -> None:
    check(bench, bench.double, np.float64, DOUBLE_TOLERANCE, note)


@every_variant
def test_float_is_the_program_to_1e_5_of_scale(bench: Bench, variant: Variant, note: Notes) -> None:
    """The same sources with jg_real = float, on inputs rounded to float."""
    check(bench, bench.single, np.float32, FLOAT_TOLERANCE, note)
