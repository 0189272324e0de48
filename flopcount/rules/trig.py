"""Polynomials in named quantities: just enough algebra to derive H(alpha) and its derivatives.

Input: angles numbered from 1, whose cosine and sine are ``c1``, ``s1``, ... Output: polynomials as mappings
from monomials to coefficients. A monomial is a sorted tuple of names; here no name occurs twice in one, so
c^2 + s^2 never has to be simplified.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from flopcount.rules.expressions import Expr, Negate, Scalar, product, total

Monomial: TypeAlias = tuple[str, ...]
Polynomial: TypeAlias = Mapping[Monomial, int]
Vector: TypeAlias = tuple[Polynomial, Polynomial, Polynomial]
Matrix: TypeAlias = tuple[Vector, Vector, Vector]

ZERO: Polynomial = {}
ONE: Polynomial = {(): 1}


def variable(name: str, coefficient: int = 1) -> Polynomial:
    """The polynomial that is one named quantity, times a coefficient."""
    return {(name,): coefficient}


def plus(*polynomials: Polynomial) -> Polynomial:
    """Add polynomials, keeping the order of first occurrence."""
    collected: dict[Monomial, int] = {}
    for polynomial in polynomials:
        for monomial, coefficient in polynomial.items():
            collected[monomial] = collected.get(monomial, 0) + coefficient
    return {monomial: coefficient for monomial, coefficient in collected.items() if coefficient}


def minus(polynomial: Polynomial) -> Polynomial:
    """Change the sign."""
    return {monomial: -coefficient for monomial, coefficient in polynomial.items()}


def times(left: Polynomial, right: Polynomial) -> Polynomial:
    """Multiply two polynomials."""
    return plus(*({tuple(sorted(a + b)): m * n} for a, m in left.items() for b, n in right.items()))


def derivative(polynomial: Polynomial, angle: int) -> Polynomial:
    """Differentiate with respect to one angle: c becomes -s, s becomes c."""
    cosine, sine = f"c{angle}", f"s{angle}"
    slope = {cosine: (sine, -1), sine: (cosine, 1)}
    return plus(
        *(
            {tuple(sorted((*monomial[:at], slope[name][0], *monomial[at + 1 :]))): slope[name][1] * coefficient}
            for monomial, coefficient in polynomial.items()
            for at, name in enumerate(monomial)
            if name in slope
        )
    )


def elementary(axis: str, angle: int) -> Matrix:
    """The elementary rotation about ``x``, ``y`` or ``z``."""
    turned = "xyz".index(axis)
    entries = [[ONE if i == j == turned else ZERO for j in range(3)] for i in range(3)]
    first, second = (turned + 1) % 3, (turned + 2) % 3
    entries[first][first] = entries[second][second] = variable(f"c{angle}")
    entries[second][first] = variable(f"s{angle}")
    entries[first][second] = variable(f"s{angle}", -1)
    return _matrix(lambda i, j: entries[i][j])


def matrix_product(left: Matrix, right: Matrix) -> Matrix:
    """Multiply two matrices of polynomials."""
    return _matrix(lambda i, j: plus(*(times(left[i][k], right[k][j]) for k in range(3))))


def identity() -> Matrix:
    """The unit matrix."""
    return _matrix(lambda i, j: ONE if i == j else ZERO)


def unit_cross(axis: int, vector: Vector) -> Vector:
    """Cross product of a unit vector with a vector of polynomials."""
    crossed: list[Polynomial] = [ZERO, ZERO, ZERO]
    crossed[(axis + 1) % 3] = minus(vector[(axis + 2) % 3])
    crossed[(axis + 2) % 3] = vector[(axis + 1) % 3]
    return crossed[0], crossed[1], crossed[2]


def expression(polynomial: Polynomial, order: Callable[[str], tuple[int, int]]) -> Expr:
    """Write a polynomial without constant term as a sum of ordered products.

    Args:
        polynomial: with coefficients +1 and -1, not zero.
        order: sort key of the names within a product.
    """
    terms: list[Expr] = []
    for monomial, coefficient in polynomial.items():
        term = product(*(Scalar(name) for name in sorted(monomial, key=order)))
        terms.append(term if coefficient > 0 else Negate(term))
    return total(terms)


def _matrix(entry: Callable[[int, int], Polynomial]) -> Matrix:
    rows = [(entry(i, 0), entry(i, 1), entry(i, 2)) for i in range(3)]
    return rows[0], rows[1], rows[2]
