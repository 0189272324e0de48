"""Open chains agree with Pinocchio, where it is installed (``pip install pin``): M, bias forces, Jacobians."""

from __future__ import annotations

import pytest

from benchmarks.chain_speed.open_chains import TOLERANCE, agreement


def test_inertia_bias_and_jacobians_of_open_chains_are_those_of_pinocchio_to_1e_11() -> None:
    pytest.importorskip("pinocchio", exc_type=ImportError)
    found = agreement(count=4, states=3)
    assert max(found.M, found.bias, found.D_E) < TOLERANCE <= 1e-11
