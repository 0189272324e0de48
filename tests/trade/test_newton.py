"""Newton's method converges as fast as its second derivative allows, and to a closed engine."""

from __future__ import annotations

import numpy as np
import pytest

from codegen.trade.engine import CRANK, ROD
from codegen.trade.newton import PAIRINGS, SLOW, Pairing, newton_table, order, residuals, solution

LIMITS = {"exact": (1.8, 2.3), "substituted": (1.8, 2.3), "mixed": (1.2, 1.7), "no second derivative": (0.9, 1.1)}


@pytest.mark.parametrize("pairing", PAIRINGS, ids=lambda pairing: pairing.name.partition(":")[0])
def test_the_order_is_the_expected_one(pairing: Pairing) -> None:
    low, high = LIMITS[pairing.name.partition(":")[0]]
    assert low <= order(residuals(pairing)) <= high
    assert low <= pairing.expected <= high


def test_the_better_the_derivative_the_fewer_iterations() -> None:
    counts = [len(residuals(pairing)) for pairing in PAIRINGS]
    assert counts == sorted(counts)
    assert counts[-1] > 2 * counts[0]


def test_all_end_at_one_closed_engine() -> None:
    ends = [solution(pairing) for pairing in (PAIRINGS[0], PAIRINGS[2], PAIRINGS[3])]
    for end in ends:
        np.testing.assert_allclose(end.r, ends[0].r, atol=1e-11)
        crank, rod, piston = end.r
        assert np.linalg.norm(crank) == pytest.approx(CRANK / 2, abs=1e-11)
        assert np.linalg.norm(2 * crank - piston) == pytest.approx(ROD, abs=1e-11)
        np.testing.assert_allclose(rod, crank + piston / 2, atol=1e-11)
        np.testing.assert_allclose(piston[1:], 0, atol=1e-11)


def test_slow_pairings_are_warned_of() -> None:
    for row in newton_table().rows:
        assert (float(row[2]) < SLOW) == ("warning" in str(row[4]))


@pytest.mark.parametrize("power", [1.0, 2**0.5, 2.0])
def test_the_order_of_a_known_sequence_is_found(power: float) -> None:
    sizes = [0.1 ** (power**k) if power > 1 else 0.1 * 0.3**k for k in range(30)]
    assert order([size for size in sizes if size > 1e-16]) == pytest.approx(power, rel=1e-6)
