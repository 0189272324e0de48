"""S1, Eqs. (18) and (27) to (38): the rotational rows, and how one misprint comes from another."""

from dataclasses import replace

import numpy as np

from tests.reference.constraints import relative_rotation
from tests.reference.derivatives import PI_I, PI_J

from . import corrected, printed, tables
from .claims import EXACT, VISIBLE, Values, error, error_as_printed, error_corrected, error_elsewhere
from .confirmed import EQ_18, EQ_29, EQ_33, EQ_37
from .misprints import (
    EQ_27,
    EQ_28,
    EQ_28_PRIMES,
    EQ_30,
    EQ_31_ROW_2,
    EQ_31_ROW_3,
    EQ_32_ROW_2,
    EQ_32_ROW_3,
    EQ_36,
    EQ_38,
)
from .situations import Situation, on_manifold
from .truth import difference


def derivative_by_alpha(eq_32: Values, s: Situation) -> np.ndarray:
    """Derivative [12] of an Eq. (32)^T lambda by alpha_2."""

    def product(h: float) -> np.ndarray:
        pose = replace(s.pose, alpha=s.pose.alpha + np.array([0, h]))
        return eq_32(replace(s, pose=pose)).T @ s.lam_rot

    return difference(product)


def test_eq_18_as_printed_is_right() -> None:
    assert error(EQ_18) < EXACT


def test_eq_27_row_2_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_27) > VISIBLE


def test_eq_27_corrected_is_right() -> None:
    assert error_corrected(EQ_27) < EXACT


def test_eq_27_as_printed_is_right_in_the_other_rows() -> None:
    assert error_elsewhere((EQ_27,)) < EXACT


def test_eq_28_H_in_the_column_of_pi_i_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_28) > VISIBLE


def test_eq_28_leading_vectors_without_primes_as_printed_are_wrong() -> None:
    assert error_as_printed(EQ_28_PRIMES) > VISIBLE


def test_eq_28_corrected_is_right() -> None:
    assert error_corrected(EQ_28) < EXACT


def test_eq_28_with_primes_is_right_but_for_row_3() -> None:
    """In rows 1 and 2 the third row of R_z stands, which is that of its transpose."""
    assert error_elsewhere((EQ_28,)) < EXACT


def test_eq_29_as_printed_is_right() -> None:
    assert error(EQ_29) < EXACT


def test_eq_30_third_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_30) > VISIBLE


def test_eq_30_corrected_is_right() -> None:
    assert error_corrected(EQ_30) < EXACT


def test_eq_30_as_printed_is_right_in_the_other_products() -> None:
    assert error_elsewhere((EQ_30,)) < EXACT


def test_eq_31_row_1_as_printed_needs_eq_30_corrected() -> None:
    for s in on_manifold():
        mirrored = replace(s, geometry=replace(s.geometry, C_i=s.C_j))
        first = relative_rotation(1, [s.angle])[0]
        row_1 = printed.eq_31(s)[0, PI_J]
        np.testing.assert_allclose(-first @ corrected.eq_30(mirrored)[2], row_1, atol=EXACT)
        assert np.max(np.abs(-first @ printed.eq_30(mirrored)[2] - row_1)) > VISIBLE


def test_eq_31_row_2_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_31_ROW_2) > VISIBLE


def test_eq_31_row_3_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_31_ROW_3) > VISIBLE


def test_eq_31_row_3_as_printed_comes_from_eq_28() -> None:
    for s in on_manifold():
        np.testing.assert_allclose(printed.eq_31(s)[2], printed.eq_28_with_primes(s)[2], atol=EXACT)


def test_eq_31_row_2_as_printed_does_not_come_from_eq_28() -> None:
    for s in on_manifold():
        assert np.max(np.abs(printed.eq_31(s)[1] - printed.eq_28_with_primes(s)[1])) > VISIBLE


def test_eq_31_corrected_is_right() -> None:
    assert error_corrected(EQ_31_ROW_2) < EXACT


def test_eq_31_as_printed_is_right_elsewhere() -> None:
    assert error_elsewhere((EQ_31_ROW_2, EQ_31_ROW_3)) < EXACT


def test_eq_32_row_2_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_32_ROW_2) > VISIBLE


def test_eq_32_row_3_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_32_ROW_3) > VISIBLE


def test_eq_32_corrected_is_right() -> None:
    assert error_corrected(EQ_32_ROW_2) < EXACT


def test_eq_32_as_printed_is_right_elsewhere() -> None:
    assert error_elsewhere((EQ_32_ROW_2, EQ_32_ROW_3)) < EXACT


def test_eq_32_corrected_is_right_on_the_manifold_only() -> None:
    assert tables.eq_32_off_the_manifold() > VISIBLE


def test_eq_33_as_printed_is_right() -> None:
    assert error(EQ_33) < EXACT


def test_eq_36_block_of_pi_i_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_36) > VISIBLE


def test_eq_36_corrected_is_right() -> None:
    assert error_corrected(EQ_36) < EXACT


def test_eq_36_as_printed_is_right_elsewhere() -> None:
    assert error_elsewhere((EQ_36,)) < EXACT


def test_eq_36_block_of_pi_i_as_printed_comes_from_eq_32_as_printed() -> None:
    for s in on_manifold():
        by_alpha = derivative_by_alpha(printed.eq_32, s)
        np.testing.assert_allclose(printed.eq_36(s)[PI_I, 1], by_alpha[PI_I], atol=EXACT)


def test_eq_36_block_of_pi_j_as_printed_does_not_come_from_eq_32_as_printed() -> None:
    for s in on_manifold():
        by_alpha = derivative_by_alpha(printed.eq_32, s)
        assert np.max(np.abs(printed.eq_36(s)[PI_J, 1] - by_alpha[PI_J])) > VISIBLE


def test_eq_37_as_printed_is_right() -> None:
    assert error(EQ_37) < EXACT


def test_eq_38_transpose_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_38) > VISIBLE


def test_eq_38_corrected_is_right() -> None:
    assert error_corrected(EQ_38) < EXACT


def test_eq_38_as_printed_is_right_in_the_column_of_pi_j() -> None:
    assert error_elsewhere((EQ_38,)) < EXACT
