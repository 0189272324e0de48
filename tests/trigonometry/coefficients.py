"""Derive every number of `templates/c/jg_trigonometry.h.j2`: minimax polynomials and pi/2 in pieces.

``python -m tests.trigonometry.coefficients`` prints them as C. The polynomials are those of least greatest *relative*
error in sine, cosine and arc tangent, by the exchange algorithm of Remez in 60 digits: between two exchanges the error
is made equal, with alternating signs, at one place more than there are coefficients; then each place moves to the
extremum next to it. The coefficients are rounded to the number type at the end.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import mpmath as mp

DIGITS = 60
GRID = 1200
SIGNIFICAND = {"double": 53, "float": 24}
REDUCED = 0.8
"""Reduced angles: pi/4, and a margin for the nearest multiple of pi/2 being chosen by a rounded product."""
REDUCED_SLOPE = 0.5
"""Slopes after the reduction of the arc tangent: at most 1/2."""
PIECE = 36
"""Bits of a piece of pi/2: times a number of quarter turns below 2**17 it is exact in double."""

Real = Any


@dataclass(frozen=True, eq=False)
class Polynomial:
    """A polynomial in z on [0, end].

    Attributes:
        name: of its coefficients in C.
        function: what it approximates.
        weight: of the error: what makes it the relative error of the result.
        end: of the interval.
        terms: number of coefficients, by number type.
    """

    name: str
    function: Callable[[Real], Real]
    weight: Callable[[Real], Real]
    end: float
    terms: dict[str, int]


def _sine(z: Real) -> Real:
    """(sin x / x - 1) / z with z = x^2."""
    return _sum(z, lambda k: mp.mpf(-1) ** (k + 1) / mp.factorial(2 * k + 3))


def _cosine(z: Real) -> Real:
    """(cos x - 1 + z/2) / z^2 with z = x^2."""
    return _sum(z, lambda k: mp.mpf(-1) ** k / mp.factorial(2 * k + 4))


def _arc(z: Real) -> Real:
    """(atan u / u - 1) / z with z = u^2."""
    return _sum(z, lambda k: mp.mpf(-1) ** (k + 1) / (2 * k + 3))


def _sum(z: Real, term: Callable[[int], Real]) -> Real:
    total, power, k = mp.mpf(0), mp.mpf(1), 0
    while abs(added := term(k) * power) > mp.eps:
        total, power, k = total + added, power * z, k + 1
    return total


POLYNOMIALS = (
    Polynomial("SINE", _sine, lambda z: z / (1 + z * _sine(z)), REDUCED**2, {"double": 6, "float": 3}),
    Polynomial(
        "COSINE", _cosine, lambda z: z**2 / (1 - z / 2 + z**2 * _cosine(z)), REDUCED**2, {"double": 6, "float": 3}
    ),
    Polynomial("ARC", _arc, lambda z: z / (1 + z * _arc(z)), REDUCED_SLOPE**2, {"double": 12, "float": 5}),
)


@cache
def minimax(polynomial: Polynomial, terms: int) -> tuple[list[Real], Real]:
    """Coefficients, lowest first, and the greatest relative error that they leave before they are rounded."""
    with mp.workdps(DIGITS):
        end = mp.mpf(polynomial.end)
        grid = [end * (1 - mp.cos(mp.pi * k / GRID)) / 2 for k in range(1, GRID + 1)]
        sampled = [(z, polynomial.function(z), polynomial.weight(z)) for z in grid]
        places = [(GRID - 1) * (2 * k + 1) // (2 * (terms + 1)) for k in range(terms + 1)]
        for _ in range(40):
            *coefficients, level = _equal_errors([sampled[place] for place in places], terms)
            errors = [w * (mp.polyval(coefficients[::-1], z) - f) for z, f, w in sampled]
            places = _extrema(errors, terms + 1)
            worst = max(abs(error) for error in errors)
            if worst < abs(level) * (1 + mp.mpf(10) ** -6):
                return coefficients, worst
    raise AssertionError(f"the exchange for {polynomial.name} does not settle")


def _equal_errors(samples: Sequence[tuple[Real, Real, Real]], terms: int) -> list[Real]:
    matrix = mp.matrix(terms + 1, terms + 1)
    right = mp.matrix(terms + 1, 1)
    for row, (z, f, w) in enumerate(samples):
        for column in range(terms):
            matrix[row, column] = z**column
        matrix[row, terms] = (-1) ** row / w
        right[row] = f
    return list(mp.lu_solve(matrix, right))


def _extrema(errors: Sequence[Real], count: int) -> list[int]:
    """The greatest error of each stretch of one sign; the neighbours of the greatest of all where there are more."""
    stretches: list[int] = []
    for place, error in enumerate(errors):
        if stretches and (errors[stretches[-1]] > 0) == (error > 0):
            if abs(error) > abs(errors[stretches[-1]]):
                stretches[-1] = place
        else:
            stretches.append(place)
    while len(stretches) > count:
        weaker = 0 if abs(errors[stretches[0]]) < abs(errors[stretches[-1]]) else -1
        stretches.pop(weaker)
    return stretches


def rounded(value: Real, real: str) -> float:
    """To the nearest number of the type."""
    return float(value) if real == "double" else struct.unpack("f", struct.pack("f", float(value)))[0]


def pieces() -> list[float]:
    """Pi/2 as three pieces of few bits, whose products with the number of quarter turns are exact, and a rest."""
    with mp.workdps(DIGITS):
        rest, parts = mp.pi / 2, []
        for _ in range(3):
            unit = mp.mpf(2) ** (mp.floor(mp.log(abs(rest), 2)) + 1 - PIECE)
            parts.append(mp.nint(rest / unit) * unit)
            rest -= parts[-1]
        return [float(part) for part in (*parts, rest)]


def eighth_turn(real: str) -> tuple[float, float]:
    """Pi/4 in two pieces, of which four times the first is exact."""
    with mp.workdps(DIGITS):
        unit = mp.mpf(2) ** (3 - SIGNIFICAND[real])
        head = mp.nint(mp.pi / 4 / unit) * unit
        return rounded(head, real), rounded(mp.pi / 4 - head, real)


def definitions(real: str) -> dict[str, float]:
    """Name -> value of every constant of the header for a number type."""
    found: dict[str, float] = {}
    for polynomial in POLYNOMIALS:
        coefficients, _ = minimax(polynomial, polynomial.terms[real])
        found |= {f"JG_{polynomial.name}_{k}": rounded(c, real) for k, c in enumerate(coefficients)}
    found |= {f"JG_HALF_PI_{k}": piece for k, piece in enumerate(pieces()[: 4 if real == "double" else 2])}
    found |= dict(zip(("JG_EIGHTH_TURN", "JG_EIGHTH_TURN_REST"), eighth_turn(real), strict=True))
    return found | {"JG_QUARTERS_PER_RADIAN": rounded(2 / mp.pi, real)}


def main() -> None:
    """Print the constants, and the errors of the polynomials in units of half the last place of 1."""
    for real, bits in SIGNIFICAND.items():
        for polynomial in POLYNOMIALS:
            _, worst = minimax(polynomial, polynomial.terms[real])
            print(f"/* {real} {polynomial.name}: {mp.nstr(worst * 2**bits, 3)} */")
        for name, value in definitions(real).items():
            print(f"#define {name} {value!r}")


if __name__ == "__main__":
    main()
