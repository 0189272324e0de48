"""The algebra of vectors free of frames is that of their components; equal expressions are equal objects."""

from __future__ import annotations

import random
from collections.abc import Callable
from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.ir.lower.frames import FrameTree, Matrix
from codegen.ir.lower.polynomial import ONE, ZERO, Polynomial, number
from codegen.ir.lower.quantities import Axis, Dyadic, Given, Named, Vector, combined
from codegen.ir.lower.space import Space

from .meaning import Meaning
from .numbers import Numbers, rotation, skew, vector

FRAMES = ("world", "i", "j")


class Scene:
    """A space of three frames, five given vectors, one named sum and two scalars, with exact values."""

    def __init__(self) -> None:
        source = random.Random(3)
        given = {("world", "r"): "r", ("i", "s_i"): "s_i", ("j", "s_j"): "s_j", ("i", "u"): "u", ("j", "w"): "w"}
        inputs = {name: list(vector(source)) for name in given.values()}
        rotations: dict[tuple[str, str], Matrix] = {}
        for pair, name in ((("world", "i"), "A_i"), (("world", "j"), "A_j")):
            inputs[name] = list(rotation(source).T.ravel())
            rotations[pair] = tuple(tuple((name, 3 * k + n) for n in range(3)) for k in range(3))
        components = {key: tuple((name, k) for k in range(3)) for key, name in given.items()}
        tree = FrameTree(rotations, components, {frame: frame for frame in FRAMES})
        self.space = Space(lambda *_: None)
        self.scalars = [self.space.scalar("symbol", name) for name in ("lambda_0", "lambda_1")]
        vectors = [self.space.vector(Given(*key)) for key in given]
        vectors += [self.space.vector(Axis(frame, k)) for frame in ("i", "j") for k in range(3)]
        self.space.named["n"] = vectors[0] - vectors[1] + self.space.cross(vectors[2], vectors[5])
        self.other_axes = [self.space.vector(Axis(frame, k)) for frame in ("i", "j") for k in (0, 1)]
        self.vectors = [*vectors, self.space.vector(Named("n"))]
        values = {"lambda_0": Fraction(2, 3), "lambda_1": Fraction(-5, 2)}
        self.meaning = Meaning(self.space, tree, {}, inputs, values)


SCENE = Scene()
SPACE, MEANING = SCENE.space, SCENE.meaning

coefficients = st.builds(
    lambda c, factors: c if not factors else c * SCENE.scalars[factors[0]],
    st.integers(-3, 3).map(number),
    st.lists(st.integers(0, 1), max_size=1),
)
sums = st.lists(st.tuples(coefficients, st.sampled_from(SCENE.vectors)), min_size=1, max_size=3).map(combined)
vectors = st.one_of(sums, st.builds(SPACE.cross, sums, sums))
general = st.sampled_from([v for v in SCENE.vectors if v not in SCENE.other_axes])
"""Primitives no two of which are axes of one frame; such have normal forms of their own, ``f x g = h``."""
maps = st.one_of(
    st.builds(SPACE.outer, vectors, vectors),
    st.builds(SPACE.tilde, vectors),
    coefficients.map(lambda kappa: Dyadic({}, kappa)),
)
dyadics = st.lists(maps, min_size=1, max_size=3).map(lambda parts: added(*parts))

few = settings(max_examples=40, deadline=None)


def added(first: Dyadic, *rest: Dyadic) -> Dyadic:
    """Sum of maps."""
    for part in rest:
        first += part
    return first


def same(left: Numbers, right: Numbers) -> bool:
    """Whether two arrays of fractions agree exactly."""
    return bool(np.all(left == right))


@few
@given(vectors, vectors, coefficients)
def test_sums_dot_and_cross_products_are_those_of_the_components(a: Vector, b: Vector, c: Polynomial) -> None:
    x, y = MEANING.vector(a), MEANING.vector(b)
    assert same(MEANING.vector(a + b), x + y)
    assert same(MEANING.vector(a - b), x - y)
    assert same(MEANING.vector(a.times(c)), x * MEANING.scalar(c))
    assert MEANING.scalar(SPACE.dot(a, b)) == x @ y
    assert MEANING.scalar(SPACE.raw_dot(a, b)) == x @ y
    assert same(MEANING.vector(SPACE.cross(a, b)), skew(x) @ y)


@few
@given(dyadics, dyadics, vectors, vectors, coefficients)
def test_maps_are_added_applied_composed_and_transposed_as_matrices(
    D: Dyadic, E: Dyadic, a: Vector, b: Vector, c: Polynomial
) -> None:
    M, N = MEANING.map(D), MEANING.map(E)
    assert same(MEANING.map(SPACE.outer(a, b)), np.outer(MEANING.vector(a), MEANING.vector(b)))
    assert same(MEANING.map(SPACE.tilde(a)), skew(MEANING.vector(a)))
    assert same(MEANING.map(D + E), M + N)
    assert same(MEANING.map(D - E), M - N)
    assert same(MEANING.map(D.times(c)), M * MEANING.scalar(c))
    assert same(MEANING.map(D.transposed), M.T)
    assert same(MEANING.map(SPACE.compose(D, E)), M @ N)
    assert same(MEANING.vector(SPACE.apply(D, a)), M @ MEANING.vector(a))


@few
@given(vectors, vectors, vectors)
def test_normal_forms_follow_the_laws_of_products(a: Vector, b: Vector, c: Vector) -> None:
    dot, cross = SPACE.dot, SPACE.cross
    assert dot(a, b) == dot(b, a)
    assert dot(a, b + c) == dot(a, b) + dot(a, c)
    assert cross(a, b) == -cross(b, a)
    assert cross(a, b + c) == cross(a, b) + cross(a, c)
    assert not cross(a, a)


@few
@given(general, general, general, general)
def test_normal_forms_follow_the_identities_of_cross_products(a: Vector, b: Vector, c: Vector, d: Vector) -> None:
    """Cyclic triple products, Grassmann, Jacobi, Lagrange."""
    dot, cross = SPACE.dot, SPACE.cross
    assert dot(cross(a, b), c) == dot(cross(b, c), a) == dot(cross(c, a), b) == -dot(cross(b, a), c)
    assert dot(cross(a, b), a) == ZERO
    assert cross(a, cross(b, c)) == b.times(dot(a, c)) - c.times(dot(a, b))
    assert not cross(a, cross(b, c)) + cross(b, cross(c, a)) + cross(c, cross(a, b))
    assert dot(cross(a, b), cross(c, d)) == dot(a, c) * dot(b, d) - dot(a, d) * dot(b, c)


@few
@given(vectors, vectors)
def test_a_product_of_skew_maps_is_an_outer_product_beside_the_identity(a: Vector, b: Vector) -> None:
    product = SPACE.compose(SPACE.tilde(a), SPACE.tilde(b))
    assert same(MEANING.map(product), skew(MEANING.vector(a)) @ skew(MEANING.vector(b)))


@few
@given(*2 * [st.lists(st.tuples(coefficients, general), min_size=1, max_size=3).map(combined)])
def test_skew_maps_of_sums_multiply_to_one_normal_form(a: Vector, b: Vector) -> None:
    product = SPACE.compose(SPACE.tilde(a), SPACE.tilde(b))
    assert product == SPACE.outer(b, a) - Dyadic({}, SPACE.dot(a, b))
    assert SPACE.tilde(SPACE.cross(a, b)) == SPACE.outer(b, a) - SPACE.outer(a, b)


@few
@given(dyadics, dyadics, dyadics)
def test_composition_keeps_the_identity_and_turns_round_under_transposition(D: Dyadic, E: Dyadic, F: Dyadic) -> None:
    identity = Dyadic({}, ONE)
    assert SPACE.compose(D, identity) == D == SPACE.compose(identity, D)
    assert D.transposed.transposed == D
    assert SPACE.compose(D, E + F) == SPACE.compose(D, E) + SPACE.compose(D, F)
    left, right = SPACE.compose(D, E).transposed, SPACE.compose(E.transposed, D.transposed)
    assert same(MEANING.map(left), MEANING.map(right))


@few
@given(st.sampled_from(FRAMES), st.integers(0, 2), st.integers(0, 2))
def test_axes_of_one_frame_are_orthonormal_and_right_handed(frame: str, k: int, n: int) -> None:
    first, second = (SPACE.vector(Axis(frame, m)) for m in (k, n))
    assert SPACE.dot(first, second) == (ONE if k == n else ZERO)
    third = SPACE.vector(Axis(frame, (k + 2) % 3))
    assert SPACE.cross(first, SPACE.vector(Axis(frame, (k + 1) % 3))) == third


@few
@given(vectors)
def test_a_named_vector_multiplies_as_its_definition(a: Vector) -> None:
    named, definition = SPACE.vector(Named("n")), SPACE.named["n"]
    assert SPACE.dot(named, a) == SPACE.dot(definition, a)
    assert same(MEANING.vector(SPACE.cross(named, a)), MEANING.vector(SPACE.cross(definition, a)))
    assert named.single is not None
    assert len(definition.terms) > 1


@few
@given(vectors, vectors)
def test_what_is_remembered_of_a_product_has_its_value(a: Vector, b: Vector) -> None:
    """Hints are ways to compute what they are kept for."""
    product, value = SPACE.cross(a, b), SPACE.dot(a, b)
    for left, right in SPACE.cross_hints.get(product, ()):
        assert same(skew(MEANING.vector(left)) @ MEANING.vector(right), MEANING.vector(product))
    for left, right in SPACE.dot_hints.get(value, ()):
        assert MEANING.vector(left) @ MEANING.vector(right) == MEANING.scalar(value)


def test_scalar_products_that_frames_know_take_the_place_of_atoms() -> None:
    known: Callable[[Axis, Axis], Polynomial | None] = lambda a, b: number(7) if {a.k, b.k} == {0, 1} else None  # noqa: E731
    space = Space(known)
    left, right, other = (space.vector(Axis(*place)) for place in (("i", 0), ("j", 1), ("j", 2)))
    assert space.dot(left, right) == number(7) == space.dot(right, left)
    assert space.dot(left, other).constant is None
