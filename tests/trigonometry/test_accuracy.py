"""Our own sine, cosine and arc tangent: how far off they are, by Arb, and what they do at the edges."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.c.packages import have

from .kernels import LANES, Array, Kernels

flint = pytest.importorskip("flint")
pytestmark = pytest.mark.skipif(not have("gcc"), reason="needs gcc")

FLAGS = {"contracted": ("-O2", "-march=native", "-ffp-contract=fast"), "as written": ("-O2", "-ffp-contract=off")}
SIGNIFICAND = {np.float64: 53, np.float32: 24}
SINE_BOUND = 1.0
ARC_BOUND = 1.5
"""Units in the last place, as the header promises."""
LARGEST = 1e5


@pytest.fixture(params=[(real, flags) for real in ("double", "float") for flags in FLAGS], ids=" ".join)
def kernels(request: pytest.FixtureRequest, tmp_path: Path) -> Kernels:
    real, flags = request.param
    return Kernels(tmp_path, real, FLAGS[flags])


@contextlib.contextmanager
def precision(bits: int) -> Iterator[None]:
    """Arb's precision for a block."""
    before, flint.ctx.prec = flint.ctx.prec, bits
    try:
        yield
    finally:
        flint.ctx.prec = before


def whole(values: Iterable[Any], kind: Any) -> Array:
    """An array of full vectors."""
    array = np.concatenate([np.atleast_1d(np.asarray(part, dtype=kind)) for part in values])
    return np.ascontiguousarray(np.resize(array, -(-array.size // LANES) * LANES))


def worst(got: Array, truth: Iterable[Any], bits: int) -> float:
    """Greatest error in units of the last place of the true value."""
    errors = []
    for value, exact in zip(got, truth, strict=True):
        size = float(abs(exact))
        place = math.ldexp(1.0, math.frexp(size)[1] - bits)
        errors.append(float(abs(flint.arb(float(value)) - exact)) / place)
    return max(errors)


def angles(kind: Any) -> Array:
    """Everywhere up to the bound; next to multiples of an eighth turn; tiny ones."""
    rng = np.random.default_rng(3)
    multiples = np.arange(1, int(LARGEST / (math.pi / 4)), 5) * (math.pi / 4)
    near = multiples.astype(kind)
    return whole(
        [
            rng.uniform(-math.pi, math.pi, 8000),
            rng.uniform(-LARGEST, LARGEST, 8000),
            np.exp(rng.uniform(-60, math.log(LARGEST), 8000)),
            near,
            np.nextafter(near, kind(0)),
            -np.nextafter(near, kind(np.inf)),
            [LARGEST, -LARGEST],
        ],
        kind,
    )


def test_sine_and_cosine_are_off_by_less_than_one_place(kernels: Kernels) -> None:
    x = angles(kernels.kind)
    bits = SIGNIFICAND[kernels.kind]
    for way in ("own", "lanes"):
        sines, cosines = kernels.sincos(x, way)
        with precision(250):
            balls = [flint.arb(float(angle)) for angle in x]
            assert worst(sines, (ball.sin() for ball in balls), bits) < SINE_BOUND
            assert worst(cosines, (ball.cos() for ball in balls), bits) < SINE_BOUND


def test_the_arc_tangent_is_off_by_less_than_one_and_a_half_places(kernels: Kernels) -> None:
    rng = np.random.default_rng(4)
    turns = rng.uniform(-math.pi, math.pi, 8000)
    axes = np.arange(-8, 9) * (math.pi / 8)
    near = (axes[:, None] + rng.normal(size=(17, 200)) * 10.0 ** rng.uniform(-9, -1, (17, 200))).ravel()
    slopes = np.concatenate([turns, near])
    stretch = np.exp(rng.uniform(-20, 20, slopes.size))
    y = whole([np.sin(slopes) * stretch, rng.normal(size=4000)], kernels.kind)
    x = whole([np.cos(slopes) * stretch, rng.normal(size=4000) * np.exp(rng.uniform(-15, 15, 4000))], kernels.kind)
    for way in ("own", "lanes"):
        got = kernels.atan2(y, x, way)
        with precision(250):
            truth = [flint.arb.atan2(flint.arb(float(b)), flint.arb(float(a))) for b, a in zip(y, x, strict=True)]
            assert worst(got, truth, SIGNIFICAND[kernels.kind]) < ARC_BOUND


@pytest.mark.parametrize("way", ["own", "lanes"])
def test_edges_of_sine_and_cosine(kernels: Kernels, way: str) -> None:
    kind = kernels.kind
    tiny = np.finfo(kind).smallest_subnormal
    x = np.array([0.0, -0.0, tiny, -tiny, np.inf, -np.inf, np.nan, LARGEST], dtype=kind)
    sines, cosines = kernels.sincos(x, way)
    np.testing.assert_array_equal(sines[:4], x[:4])
    np.testing.assert_array_equal(np.signbit(sines[:4]), [False, True, False, True])
    np.testing.assert_array_equal(cosines[:4], np.ones(4))
    assert np.isnan(sines[4:7]).all() and np.isnan(cosines[4:7]).all()


@pytest.mark.parametrize("way", ["own", "lanes"])
def test_beyond_the_bound_it_is_the_mathematical_library(kernels: Kernels, way: str) -> None:
    """In the lanes concerned only: within the bound a number has the same bits in any company."""
    x = np.array([1e9, 2.0, -1e22 if kernels.kind is np.float64 else -1e20, 100001.0], dtype=kernels.kind)
    sines, cosines = kernels.sincos(x, way)
    np.testing.assert_allclose(sines, [math.sin(float(v)) for v in x], rtol=2 * np.finfo(kernels.kind).eps)
    np.testing.assert_allclose(cosines, [math.cos(float(v)) for v in x], rtol=2 * np.finfo(kernels.kind).eps)
    alone = kernels.sincos(np.full(LANES, 2.0, dtype=kernels.kind), way)
    assert sines[1] == alone[0][0] and cosines[1] == alone[1][0]


@pytest.mark.parametrize("way", ["own", "lanes"])
def test_edges_of_the_arc_tangent(kernels: Kernels, way: str) -> None:
    """Every pair of edges, alone in a vector of ordinary numbers, as C's Annex F has it."""
    kind = kernels.kind
    info = np.finfo(kind)
    edges = [0.0, -0.0, 1.0, -1.0, np.inf, -np.inf, np.nan, info.smallest_subnormal, -info.tiny, info.max, -info.max]
    for b in np.array(edges, dtype=kind):
        for a in np.array(edges, dtype=kind):
            y, x = np.array([1, b, 1, 1], dtype=kind), np.array([2, a, 1, 3], dtype=kind)
            got = kernels.atan2(y, x, way)[1]
            expected = math.atan2(float(b), float(a))
            if math.isnan(expected):
                assert np.isnan(got)
                continue
            floor = float(info.smallest_subnormal)
            assert abs(float(got) - expected) <= max(2 * info.eps * abs(expected), floor), (b, a)
            assert np.signbit(got) == np.signbit(expected), (b, a)


def test_lanes_give_the_bits_of_one_number(tmp_path: Path) -> None:
    for real in ("double", "float"):
        kernels = Kernels(tmp_path, real, FLAGS["as written"])
        x = angles(kernels.kind)
        y = np.ascontiguousarray(x[::-1])
        for one, many in zip(kernels.sincos(x, "own"), kernels.sincos(x, "lanes"), strict=True):
            np.testing.assert_array_equal(one.view(kernels.word), many.view(kernels.word))
        pair = kernels.atan2(y, x, "own"), kernels.atan2(y, x, "lanes")
        np.testing.assert_array_equal(pair[0].view(kernels.word), pair[1].view(kernels.word))
