"""S1, Eqs. (10), (11), (17) and (19) to (26): placing body j, and the translational rows."""

import numpy as np

from tests.reference.derivatives import PI_J

from . import printed, sound, tables
from .claims import EXACT, VISIBLE, error, error_as_printed, error_corrected, error_elsewhere
from .confirmed import EQ_10_11, EQ_17, EQ_20, EQ_21, EQ_22, EQ_23, EQ_24, EQ_25, EQ_26
from .misprints import EQ_19, EQ_19_H_I, EQ_19_S_I, EQ_19_S_J
from .situations import on_manifold


def test_eq_10_and_11_as_printed_place_body_j_as_the_conventional_rows_want_it() -> None:
    assert error(EQ_10_11) < EXACT


def test_eq_17_as_printed_is_right() -> None:
    assert error(EQ_17) < EXACT


def test_eq_19_first_sign_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_19_S_J) > VISIBLE


def test_eq_19_second_sign_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_19_S_I) > VISIBLE


def test_eq_19_third_sign_as_printed_is_wrong() -> None:
    assert error_as_printed(EQ_19_H_I) > VISIBLE


def test_eq_19_corrected_is_right() -> None:
    for misprint in EQ_19:
        assert error_corrected(misprint) < EXACT


def test_eq_19_as_printed_is_right_elsewhere() -> None:
    assert error_elsewhere(EQ_19) < EXACT


def test_eq_19_as_printed_contradicts_eq_20() -> None:
    for s in on_manifold():
        assert np.max(np.abs(printed.eq_19(s)[:, PI_J] - sound.eq_20(s)[:, PI_J])) > VISIBLE


def test_eq_20_as_printed_is_right_on_the_manifold() -> None:
    assert error(EQ_20) < EXACT


def test_eq_20_misses_the_rotation_of_phi_off_the_manifold() -> None:
    bare, mended = tables.eq_20_off_the_manifold()
    assert bare > VISIBLE
    assert mended < EXACT


def test_eq_21_as_printed_is_right() -> None:
    assert error(EQ_21) < EXACT


def test_eq_22_and_34_as_printed_are_right_after_substitution() -> None:
    assert error(EQ_22) < EXACT


def test_eq_22_and_34_differ_from_the_exact_derivative_across_the_manifold_only() -> None:
    anywhere, along = tables.substitution()
    assert anywhere > VISIBLE
    assert along < EXACT


def test_eq_23_and_35_as_printed_are_right() -> None:
    assert error(EQ_23) < EXACT


def test_eq_24_as_printed_is_right() -> None:
    assert error(EQ_24) < EXACT


def test_eq_25_as_printed_is_right_after_substitution() -> None:
    assert error(EQ_25) < EXACT


def test_eq_26_as_printed_is_right_on_the_manifold() -> None:
    assert error(EQ_26) < EXACT
