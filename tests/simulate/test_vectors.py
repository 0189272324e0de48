"""The compiled operations on vectors against numpy."""

from __future__ import annotations

import ctypes
from ctypes import c_double, c_int, c_void_p

import numpy as np
import pytest
from numpy.typing import NDArray

from codegen.simulate.library import library
from codegen.simulate.vectors import vector_headers

Array = NDArray[np.float64]

SIZE = 13
NUMBER, PLACE = c_double, c_void_p


class Operations(ctypes.Structure):
    """``struct jg_vector_operations``."""

    _fields_ = [
        ("linear_sum", ctypes.CFUNCTYPE(None, NUMBER, PLACE, NUMBER, PLACE, PLACE)),
        ("constant", ctypes.CFUNCTYPE(None, NUMBER, PLACE)),
        ("scale", ctypes.CFUNCTYPE(None, NUMBER, PLACE, PLACE)),
        ("abs", ctypes.CFUNCTYPE(None, PLACE, PLACE)),
        ("inv", ctypes.CFUNCTYPE(None, PLACE, PLACE)),
        ("wrms_norm", ctypes.CFUNCTYPE(NUMBER, PLACE, PLACE)),
        ("wrms_norm_mask", ctypes.CFUNCTYPE(NUMBER, PLACE, PLACE, PLACE)),
        ("linear_combination", ctypes.CFUNCTYPE(c_int, c_int, PLACE, PLACE, PLACE)),
    ]


class Vector:
    """Entries, and what begins with a pointer to a pointer to them."""

    def __init__(self, entries: Array) -> None:
        self.entries = entries.copy()
        self._content = c_void_p(self.entries.ctypes.data)
        self._vector = c_void_p(ctypes.addressof(self._content))
        self.address = ctypes.addressof(self._vector)


@pytest.fixture(scope="module")
def operations() -> Operations:
    loaded = library('#include "jg_vector.h"\n', vector_headers(SIZE))
    found = Operations.in_dll(loaded, "jg_vector_operations")
    found.library = loaded
    return found


@pytest.fixture
def three() -> tuple[Vector, Vector, Vector]:
    x, y, z = (Vector(entries) for entries in np.random.default_rng(1).standard_normal((3, SIZE)))
    return x, y, z


Three = tuple[Vector, Vector, Vector]


def test_each_operation_is_that_of_its_name(operations: Operations, three: Three) -> None:
    x, y, z = three
    operations.linear_sum(2.0, x.address, -3.0, y.address, z.address)
    np.testing.assert_allclose(z.entries, 2.0 * x.entries - 3.0 * y.entries, rtol=1e-14, atol=1e-15)
    operations.constant(4.0, z.address)
    np.testing.assert_array_equal(z.entries, 4.0)
    operations.scale(-0.5, x.address, z.address)
    np.testing.assert_array_equal(z.entries, -0.5 * x.entries)
    operations.abs(x.address, z.address)
    np.testing.assert_array_equal(z.entries, np.abs(x.entries))
    operations.inv(x.address, z.address)
    np.testing.assert_array_equal(z.entries, 1.0 / x.entries)


def test_results_may_stand_in_the_place_of_arguments(operations: Operations, three: Three) -> None:
    x, y, _ = three
    expected = x.entries + y.entries
    operations.linear_sum(1.0, x.address, 1.0, y.address, y.address)
    np.testing.assert_array_equal(y.entries, expected)
    operations.scale(3.0, y.address, y.address)
    np.testing.assert_array_equal(y.entries, 3.0 * expected)


def test_norms_are_means_over_all_entries_of_those_that_are_not_masked(operations: Operations, three: Three) -> None:
    x, w, _ = three
    mask = Vector((np.arange(SIZE) % 3 > 0).astype(float))
    weighted = x.entries * w.entries
    assert operations.wrms_norm(x.address, w.address) == pytest.approx(np.sqrt(np.mean(weighted**2)), rel=1e-14)
    expected = np.sqrt(np.mean((weighted * mask.entries) ** 2))
    assert operations.wrms_norm_mask(x.address, w.address, mask.address) == pytest.approx(expected, rel=1e-14)


@pytest.mark.parametrize("count", range(1, 9))
def test_any_number_of_vectors_is_combined_also_into_the_first(operations: Operations, count: int) -> None:
    rng = np.random.default_rng(count)
    vectors, factors = [Vector(entries) for entries in rng.standard_normal((count, SIZE))], rng.standard_normal(count)
    expected = factors @ np.array([vector.entries for vector in vectors])
    places = (c_void_p * count)(*(vector.address for vector in vectors))
    code = operations.linear_combination(count, factors.ctypes.data, ctypes.addressof(places), vectors[0].address)
    assert code == 0
    np.testing.assert_allclose(vectors[0].entries, expected, rtol=1e-13, atol=1e-14)
