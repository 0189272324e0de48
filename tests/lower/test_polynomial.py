"""Polynomials are what their values at any point say."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from codegen.ir.lower.polynomial import ONE, ZERO, Monomial, Polynomial, atom, number, total
from codegen.ir.lower.scalar_forms import Product, Sum, plan_of

ATOMS = 4

coefficients = st.one_of(st.integers(-6, 6), st.fractions(-3, 3, max_denominator=4))
monomials = st.lists(st.integers(0, ATOMS - 1), max_size=4).map(lambda atoms: tuple(sorted(atoms)))
polynomials = st.dictionaries(monomials, coefficients, max_size=5).map(Polynomial)
points = st.lists(st.fractions(-5, 5, max_denominator=7), min_size=ATOMS, max_size=ATOMS)
Point = list[Fraction]


def at(value: Polynomial, point: Point) -> Fraction:
    """Value at a point, from the terms."""
    return sum((coefficient * product(monomial, point) for monomial, coefficient in value.terms), Fraction(0))


def product(monomial: Monomial, point: Point) -> Fraction:
    """Value of a monomial."""
    result = Fraction(1)
    for index in monomial:
        result *= point[index]
    return result


@given(polynomials, polynomials, points)
def test_sums_differences_and_products_are_those_of_the_values(a: Polynomial, b: Polynomial, x: Point) -> None:
    assert at(a + b, x) == at(a, x) + at(b, x)
    assert at(a - b, x) == at(a, x) - at(b, x)
    assert at(a * b, x) == at(a, x) * at(b, x)
    assert at(-a, x) == -at(a, x)


@given(polynomials, polynomials, polynomials)
def test_equal_polynomials_are_equal_objects_with_one_hash(a: Polynomial, b: Polynomial, c: Polynomial) -> None:
    """The laws of a commutative ring."""
    for left, right in (
        (a + b, b + a),
        (a * b, b * a),
        ((a + b) + c, a + (b + c)),
        ((a * b) * c, a * (b * c)),
        (a * (b + c), a * b + a * c),
        (a + ZERO, a),
        (a * ONE, a),
        (a * ZERO, ZERO),
        (a - a, ZERO),
        (ZERO - (ZERO - a), a),
        (total([a, b, c]), a + b + c),
    ):
        assert left == right
        assert hash(left) == hash(right)


@given(polynomials, points)
def test_a_polynomial_is_false_exactly_where_it_has_no_terms(a: Polynomial, x: Point) -> None:
    assert bool(a) == bool(a.terms)
    assert all(coefficient for _, coefficient in a.terms)
    assert a or at(a, x) == 0


@given(polynomials, monomials, points)
def test_the_content_divides_and_is_put_back_by_a_product(a: Polynomial, factor: Monomial, x: Point) -> None:
    whole = a * Polynomial({factor: 1})
    content = whole.content
    assert at(whole.without(content), x) * product(content, x) == at(whole, x)
    assert whole.without(content) * Polynomial({content: 1}) == whole
    assert whole.without(content).content == ()
    if whole:
        assert all(content.count(index) >= factor.count(index) for index in factor)


@given(polynomials)
def test_the_sign_tells_a_polynomial_from_its_negative(a: Polynomial) -> None:
    assert (-a).sign == -a.sign
    assert bool(a.sign) == bool(a)


@given(coefficients, points, st.integers(0, ATOMS - 1))
def test_constants_and_atoms_have_their_values(value: int | Fraction, x: Point, index: int) -> None:
    assert at(number(value), x) == value
    assert number(value).constant == value
    assert at(atom(index), x) == x[index]
    assert atom(index).constant is None


def planned(plan: Sum, point: Point) -> Fraction:
    """Value of a plan."""
    return sum((planned_product(term, point) for term in plan.terms), Fraction(0))


def planned_product(term: Product, point: Point) -> Fraction:
    """Value of a product of a plan."""
    result = Fraction(term.coefficient)
    for factor in term.factors:
        result *= planned(factor, point) if isinstance(factor, Sum) else point[factor]
    return result


@given(polynomials, points)
def test_a_factored_polynomial_has_the_value_of_its_terms(a: Polynomial, x: Point) -> None:
    assert planned(plan_of(a), x) == at(a, x)
