"""The numbers in the header are those that the derivation gives, and the polynomials are as good as it says."""

from __future__ import annotations

from fractions import Fraction

import pytest

pytest.importorskip("mpmath")

import mpmath as mp

from codegen.emit.trigonometry import CONSTANTS

from .coefficients import PIECE, POLYNOMIALS, SIGNIFICAND, Polynomial, definitions, minimax, pieces

FUNCTIONS = {
    "SINE": (mp.sin, lambda x, z, p: x + x * z * p),
    "COSINE": (mp.cos, lambda x, z, p: 1 - z / 2 + z * z * p),
    "ARC": (mp.atan, lambda x, z, p: x + x * z * p),
}


@pytest.mark.parametrize("real", CONSTANTS)
def test_the_constants_are_those_of_the_derivation(real: str) -> None:
    assert definitions(real) == CONSTANTS[real]


@pytest.mark.parametrize("real", CONSTANTS)
@pytest.mark.parametrize("polynomial", POLYNOMIALS, ids=lambda polynomial: polynomial.name)
def test_the_rounded_polynomial_is_off_by_no_more_than_its_rounding_explains(polynomial: Polynomial, real: str) -> None:
    """Against mpmath's own functions: the least greatest error, and half a place of each coefficient."""
    function, assembled = FUNCTIONS[polynomial.name]
    coefficients = [CONSTANTS[real][f"JG_{polynomial.name}_{k}"] for k in range(polynomial.terms[real])]
    with mp.workdps(40):
        least = minimax(polynomial, polynomial.terms[real])[1]
        assert least < mp.mpf(2) ** -SIGNIFICAND[real] / 8
        for k in range(1, 500):
            x = mp.sqrt(polynomial.end) * k / 499
            value = assembled(x, x * x, mp.polyval([mp.mpf(c) for c in coefficients[::-1]], x * x))
            sizes = mp.polyval([abs(mp.mpf(c)) for c in coefficients[::-1]], x * x)
            rounding = sizes * polynomial.weight(x * x) * mp.mpf(2) ** -SIGNIFICAND[real]
            assert abs(value / function(x) - 1) < least * mp.mpf("1.001") + rounding


@pytest.mark.parametrize("polynomial", POLYNOMIALS, ids=lambda polynomial: polynomial.name)
def test_no_polynomial_of_its_degree_is_better(polynomial: Polynomial) -> None:
    """De la Vallee Poussin: an error of alternating sign at one more place than there are terms bounds them all."""
    terms = polynomial.terms["float"]
    with mp.workdps(40):
        coefficients, worst = minimax(polynomial, terms)
        errors = []
        for k in range(1, 4001):
            z = mp.mpf(polynomial.end) * (1 - mp.cos(mp.pi * k / 4000)) / 2
            errors.append(polynomial.weight(z) * (mp.polyval(coefficients[::-1], z) - polynomial.function(z)))
        heights: list[mp.mpf] = []
        for error in errors:
            if heights and (heights[-1] > 0) == (error > 0):
                heights[-1] = max(heights[-1], error, key=abs)
            else:
                heights.append(error)
        assert len(heights) == terms + 1
        assert min(abs(height) for height in heights) > 0.999 * worst
        assert max(abs(height) for height in heights) < 1.001 * worst


def test_the_pieces_of_a_quarter_turn_are_short_and_add_up() -> None:
    *short, rest = pieces()
    for piece in short:
        assert Fraction(piece).numerator.bit_length() <= PIECE
    with mp.workdps(60):
        total = sum((mp.mpf(piece) for piece in short), mp.mpf(rest))
        assert abs(total - mp.pi / 2) < mp.mpf(2) ** -155
