"""The fused multiply-add in Python gives the bits of the C library's."""

from __future__ import annotations

import ctypes
import ctypes.util
import math
import struct

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from codegen.ir.fused import fused_multiply_add, fused_multiply_add_arrays

from .programs import RANDOM

LIBRARY = ctypes.util.find_library("m")
pytestmark = pytest.mark.skipif(LIBRARY is None, reason="needs the C library's fma")

EPSILON = 2.0**-52
TINY = 2.0**-1074
ANY = st.floats(allow_subnormal=True)
NEAR_ONE = st.integers(-(2**20), 2**20).map(lambda k: 1.0 + k * EPSILON)


def fma(a: float, b: float, c: float) -> float:
    function = ctypes.CDLL(LIBRARY).fma
    function.restype, function.argtypes = ctypes.c_double, [ctypes.c_double] * 3
    return float(function(a, b, c))


def fmaf(a: float, b: float, c: float) -> float:
    function = ctypes.CDLL(LIBRARY).fmaf
    function.restype, function.argtypes = ctypes.c_float, [ctypes.c_float] * 3
    return float(function(a, b, c))


def bits(value: float) -> bytes:
    """All bits, the sign of a zero too; one NaN for all."""
    return b"nan" if math.isnan(value) else struct.pack("<d", value)


@RANDOM
@given(ANY, ANY, ANY)
@example(math.inf, 0.0, 1.0)
@example(1e308, 10.0, -math.inf)
@example(1e308, 10.0, -1e308)
@example(1e200, 1e200, -1e300)
@example(-0.0, 1.0, -0.0)
@example(-0.0, 1.0, 0.0)
@example(1e-200, -1e-200, 0.0)
@example(1e-200, 1e-200, -TINY)
@example(TINY, 0.5, 0.0)
@example(TINY, 0.5, TINY)
@example(3.0, 5.0, -15.0)
def test_any_doubles(a: float, b: float, c: float) -> None:
    assert bits(fused_multiply_add(a, b, c)) == bits(fma(a, b, c))


@RANDOM
@given(NEAR_ONE, NEAR_ONE, NEAR_ONE, st.sampled_from([1.0, EPSILON, EPSILON / 2, EPSILON**2]))
def test_where_two_roundings_are_not_one(a: float, b: float, c: float, size: float) -> None:
    for addend in (-a * b, -c, c * size, -c * size):
        assert bits(fused_multiply_add(a, b, addend)) == bits(fma(a, b, addend))


def test_two_roundings_do_differ_somewhere() -> None:
    a = 1.0 + EPSILON
    assert fma(a, a, -a * a) == EPSILON**2 != a * a - a * a


@RANDOM
@given(ANY, ANY, ANY)
def test_arrays_of_doubles(a: float, b: float, c: float) -> None:
    with np.errstate(all="ignore"):
        found = fused_multiply_add_arrays(np.array([a, b]), np.array([b, b]), c)
    assert [bits(x) for x in found] == [bits(fma(a, b, c)), bits(fma(b, b, c))]


SINGLES = st.floats(width=32)
SHORT = st.integers(-(2**24), 2**24).map(lambda k: k * 2.0**-20)


@RANDOM
@given(*[st.one_of(SINGLES, SHORT)] * 3)
@example(1.0 + 2.0**-23, 1.0 + 2.0**-23, 2.0**-60)
@example(1.0 + 2.0**-12, 1.0 + 2.0**-12, -(2.0**-80))
@example(2.0**-75, 2.0**-75, 2.0**-149)
def test_arrays_of_singles_are_rounded_once(a: float, b: float, c: float) -> None:
    with np.errstate(all="ignore"):
        found = fused_multiply_add_arrays(*(np.array([x], dtype=np.float32) for x in (a, b, c)))
    assert found.dtype == np.float32
    assert bits(float(found[0])) == bits(fmaf(a, b, c))


@RANDOM
@given(st.integers(1, 2**24 - 1), st.integers(1, 2**24 - 1), st.integers(-60, 60), st.sampled_from([-1, 1]))
def test_singles_next_to_a_tie(a: int, b: int, exponent: int, sign: int) -> None:
    """A sum that is a tie but for a last small part is where rounding through double goes wrong."""
    product = a * b
    c = sign * 2.0 ** (product.bit_length() - 25 + exponent // 20)
    for addend in (c, c + math.copysign(2.0**-40, c), 2.0**-60 * sign):
        arrays = [np.array([x], dtype=np.float32) for x in (a, b, addend)]
        assert bits(float(fused_multiply_add_arrays(*arrays)[0])) == bits(fmaf(a, b, float(np.float32(addend))))
