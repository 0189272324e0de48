"""The compiled LU factors against dense solutions of LAPACK."""

from __future__ import annotations

import ctypes
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray

from codegen.ir.program import Sparsity
from codegen.simulate.factors import blocks, lu_headers
from codegen.simulate.library import library
from codegen.simulate.straight import Pivots, Straight, straight_blocks

Array = NDArray[np.float64]

DONE, SINGULAR = 0, 1

SOURCE = """
#include "jg_lu.h"
int solve(
    const int *sizes, const int *tables[5], const struct jg_straight *kinds, const int *kind, int count,
    const double *values, const double *b, double *x);
int solve(
    const int *sizes, const int *tables[5], const struct jg_straight *kinds, const int *kind, int count,
    const double *values, const double *b, double *x)
{
    const struct jg_pattern pattern = {sizes[0], sizes[1], tables[0], tables[1], tables[2], tables[3], tables[4]};
    struct jg_lu *const lu = jg_lu_new(&pattern, kinds, kind);
    int code = lu ? JG_LU_DONE : JG_LU_NO_MEMORY;
    for (int k = 0; k < count && !code; ++k) {
        code = jg_lu_factor(lu, values + k * tables[0][sizes[0]]);
        if (!code) {
            jg_lu_solve(lu, b, x + k * sizes[0]);
        }
    }
    jg_lu_free(lu);
    return code;
}
"""

Solve = Callable[..., tuple[int, Array]]


NONE = Straight(None, np.zeros(0, dtype=np.intc), None)
"""No straight-line code."""


def largest_first(matrix: Array, pattern: Sparsity) -> Callable[[int, int], Pivots]:
    """Pivots of the blocks of a matrix: always the largest entry that is left."""
    found = blocks(pattern)

    def pivots(block: int, size: int) -> Pivots:
        part = slice(found.starts[block], found.starts[block] + size)
        left, places = matrix[np.ix_(found.rows[part], found.columns[part])].copy(), []
        for _ in range(size):
            row, column = np.unravel_index(np.argmax(np.abs(left)), left.shape)
            left -= np.outer(left[:, column], left[row]) / left[row, column]
            left[row], left[:, column] = 0.0, 0.0
            places.append((int(row), int(column)))
        rows, columns = zip(*places, strict=True)
        return rows, columns

    return pivots


@pytest.fixture(scope="module")
def solve() -> Solve:
    function = library(SOURCE, lu_headers()).solve

    def solved(pattern: Sparsity, values: Array, b: Array, straight: Straight = NONE) -> tuple[int, Array]:
        """Solve with matrices [count, nonzeros] one after the other; the code and the solutions [count, n]."""
        found = blocks(pattern)
        arrays = (pattern.colind, pattern.row, found.starts, found.columns, found.rows)
        tables = [(ctypes.c_int * len(table))(*table) for table in arrays]
        pointers = (ctypes.POINTER(ctypes.c_int) * 5)(*tables)
        sizes = (ctypes.c_int * 2)(pattern.ncol, len(found.starts) - 1)
        x = np.zeros((len(values), pattern.ncol))
        data = [ctypes.c_void_p(array.ctypes.data) for array in (values, b, x)]
        kinds, kind = ctypes.c_void_p(straight.kinds), ctypes.c_void_p(straight.kind.ctypes.data)
        return function(sizes, pointers, kinds, kind, len(values), *data), x

    return solved


def pattern_of(matrix: Array) -> Sparsity:
    return Sparsity.of_entries(*matrix.shape, zip(*(places.tolist() for places in np.nonzero(matrix)), strict=True))


def values_of(pattern: Sparsity, matrix: Array) -> Array:
    return np.array([matrix[row, column] for row, column in pattern.entries()])


def parts(sizes: tuple[int, ...], seed: int) -> Array:
    """Sparse connected blocks of full rank whose rows and columns are mixed."""
    rng = np.random.default_rng(seed)
    size = sum(sizes)
    matrix = np.zeros((size, size))
    first = 0
    for part in sizes:
        block = rng.standard_normal((part, part)) * (rng.random((part, part)) < 0.2)
        order = rng.permutation(part)
        block[order, np.arange(part)] += rng.choice((-3.0, 3.0), part)
        block[order, np.roll(np.arange(part), 1)] += 0.5
        matrix[first : first + part, first : first + part] = block
        first += part
    found: Array = matrix[rng.permutation(size)][:, rng.permutation(size)]
    return found


@pytest.mark.parametrize("sizes", [(1,), (40,), (7, 1, 20), (25, 25)])
def test_solutions_are_those_of_lapack(solve: Solve, sizes: tuple[int, ...]) -> None:
    for seed in range(5):
        matrix = parts(sizes, seed)
        pattern = pattern_of(matrix)
        b = np.random.default_rng(seed).standard_normal(len(matrix))
        code, x = solve(pattern, values_of(pattern, matrix)[None], b)
        assert code == DONE
        residual = np.abs(matrix @ x[0] - b)
        assert np.all(residual <= 1e-12 * (np.abs(matrix) @ np.abs(x[0]) + np.abs(b)))


def test_straight_line_code_solves_blocks_of_one_kind_with_one_routine(solve: Solve) -> None:
    block = parts((25,), 2)
    matrix = np.kron(np.diag((1.0, 2.0, -3.0)), block)
    pattern = pattern_of(matrix)
    straight = straight_blocks(pattern, largest_first(matrix, pattern))
    assert straight.kind.tolist() == [0, 0, 0]
    b = np.random.default_rng(3).standard_normal(75)
    code, x = solve(pattern, values_of(pattern, matrix)[None], b, straight)
    assert code == DONE
    residual = np.abs(matrix @ x[0] - b)
    assert np.all(residual <= 1e-12 * (np.abs(matrix) @ np.abs(x[0]) + np.abs(b)))


def test_straight_line_code_gives_way_where_its_pivots_vanish(solve: Solve) -> None:
    matrix = np.array([[3.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 4.0]])
    pattern = pattern_of(matrix)
    straight = straight_blocks(pattern, largest_first(matrix, pattern))
    turned = np.array([[3.0, 1.0, 0.0], [1.0, 2.0, 1.0], [0.0, 1.0, 0.0]])
    singular = np.array([[3.0, 1.0, 0.0], [6.0, 2.0, 0.0], [0.0, 0.0, 4.0]])
    b = np.array([1.0, 2.0, 3.0])
    some = [values_of(pattern, each) for each in (matrix, turned, matrix)]
    code, x = solve(pattern, np.array(some), b, straight)
    assert code == DONE
    for each, solution in zip((matrix, turned, matrix), x, strict=True):
        assert np.max(np.abs(each @ solution - b)) <= 1e-14
    assert solve(pattern, np.array([some[0], values_of(pattern, singular)]), b, straight)[0] == SINGULAR


def test_pivots_that_become_small_are_replaced(solve: Solve) -> None:
    matrix = parts((30,), 1)
    pattern = pattern_of(matrix)
    rng, b = np.random.default_rng(2), np.ones(30)
    scales = 10.0 ** rng.uniform(-9, 0, (20, pattern.nonzeros))
    values = values_of(pattern, matrix) * scales
    code, x = solve(pattern, values, b)
    assert code == DONE
    for entries, solution in zip(values, x, strict=True):
        dense = np.zeros((30, 30))
        rows, columns = zip(*pattern.entries(), strict=True)
        dense[list(rows), list(columns)] = entries
        assert np.max(np.abs(dense @ solution - b)) <= 1e-9 * np.max(np.abs(dense) @ np.abs(solution))


def test_a_singular_matrix_is_told(solve: Solve) -> None:
    matrix = np.array([[1.0, 2.0, 0.0], [2.0, 4.0, 0.0], [0.0, 0.0, 1.0]])
    pattern = pattern_of(matrix)
    regular = matrix.copy()
    regular[0, 0] = 5.0
    values = np.array([values_of(pattern, regular), values_of(pattern, matrix)])
    code, _ = solve(pattern, values, np.ones(3))
    assert code == SINGULAR


def test_mechanisms_side_by_side_are_blocks() -> None:
    matrix = parts((12, 5, 12), 3)
    found = blocks(pattern_of(matrix))
    assert sorted(np.diff(found.starts).tolist()) == [5, 12, 12]
    together = matrix[np.ix_(found.rows, found.columns)]
    for start, stop in zip(found.starts, found.starts[1:], strict=False):
        assert not np.any(together[start:stop, stop:])
        assert not np.any(together[stop:, start:stop])


def test_parts_that_are_not_square_are_left_together() -> None:
    matrix = np.array([[1.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    assert blocks(pattern_of(matrix)).starts == (0, 3)
