"""S1, Eqs. (5) to (9): each misprint is off visibly, each correction is right as a whole."""

import numpy as np

from tests.reference.derivatives import PI_J

from . import printed
from .claims import EXACT, VISIBLE, error, error_as_printed, error_corrected, error_elsewhere
from .confirmed import EQ_5
from .misprints import EQ_6, EQ_7, EQ_8, EQ_9, EQ_9_BLOCK_2_4, EQ_9_BLOCK_4_2, EQ_9_BLOCK_4_4, variation_of_d
from .situations import on_manifold


def test_eq_5_as_printed_is_right() -> None:
    assert error(EQ_5) < EXACT


def test_eq_6_sign_of_s_j_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_6) > VISIBLE


def test_eq_6_corrected_is_right() -> None:
    assert error_corrected(EQ_6) < EXACT


def test_eq_6_as_printed_is_right_elsewhere() -> None:
    assert error_elsewhere((EQ_6,)) < EXACT


def test_eq_7_attitude_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_7) > VISIBLE


def test_eq_7_corrected_is_right() -> None:
    assert error_corrected(EQ_7) < EXACT


def test_eq_8_fourth_block_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_8) > VISIBLE


def test_eq_8_corrected_is_right() -> None:
    assert error_corrected(EQ_8) < EXACT


def test_eq_8_as_printed_is_right_in_the_other_blocks() -> None:
    assert error_elsewhere((EQ_8,)) < EXACT


def test_eq_8_has_the_sign_of_eq_6_as_printed() -> None:
    """With A_ij for A_j the printed block is f_i^T times that of (6): right but for the sign."""
    for s in on_manifold():
        f_i = s.A_i @ s.f_i
        np.testing.assert_allclose(f_i @ printed.eq_6(s)[:, PI_J], -(f_i @ variation_of_d(s)[:, PI_J]), atol=EXACT)


def test_eq_9_block_2_4_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_9_BLOCK_2_4) > VISIBLE


def test_eq_9_block_4_2_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_9_BLOCK_4_2) > VISIBLE


def test_eq_9_block_4_4_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_9_BLOCK_4_4) > VISIBLE


def test_eq_9_corrected_is_right() -> None:
    assert error_corrected(EQ_9[0]) < EXACT


def test_eq_9_as_printed_is_right_in_the_other_blocks() -> None:
    assert error_elsewhere(EQ_9) < EXACT
