"""Gradients of the indices by pose and design, against differences in 60 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from .found import cached_program, found
from .geometries import GEOMETRIES, SEMI_REGULAR, Geometry

DIGITS, STEP = 60, mpmath.mpf(10) ** -20
GENERIC = GEOMETRIES["general, Dietmaier"]


def matrix(values: Any) -> Any:
    return mpmath.matrix(np.asarray(values, dtype=float).tolist())


def indices(base: Any, joints: Any, o: Any, R: Any) -> tuple[list[Any], list[Any]]:
    """D and C by their definition, of matrices of mpmath."""
    J = mpmath.matrix(6, 6)
    for i in range(6):
        p = R * joints[:, i]
        l = p + o - base[:, i]
        e = l / mpmath.norm(l)
        m = (p[1] * e[2] - p[2] * e[1], p[2] * e[0] - p[0] * e[2], p[0] * e[1] - p[1] * e[0])
        for k in range(3):
            J[i, k], J[i, 3 + k] = e[k], m[k]
    first, second, mixed = J[:, :3].T * J[:, :3], J[:, 3:].T * J[:, 3:], J[:, :3].T * J[:, 3:]
    blocks = [first - mixed * second**-1 * mixed.T, first, second - mixed.T * first**-1 * mixed, second]
    values = [sorted(mpmath.sqrt(x) for x in mpmath.eigsy(b, eigvals_only=True)) for b in blocks]
    return [v[0] * v[1] * v[2] for v in values], [v[2] / v[0] for v in values]


def turned(R: Any, k: int, step: Any) -> Any:
    c, s = mpmath.cos(step), mpmath.sin(step)
    turn = mpmath.eye(3)
    a, b = (k + 1) % 3, (k + 2) % 3
    turn[a, a], turn[a, b], turn[b, a], turn[b, b] = c, -s, s, c
    return turn * R


def slopes(geometry: Geometry, o: Any, R: Any, direction: int) -> list[Any]:
    """Derivatives of D and C, [8], in one of the 42 directions."""
    with mpmath.workdps(DIGITS):
        ends = []
        for step in (STEP, -STEP):
            base, joints, origin, rotation = (matrix(x) for x in (geometry.base, geometry.joints, o, R))
            if direction < 3:
                origin[direction] += step
            elif direction < 6:
                rotation = turned(rotation, direction - 3, step)
            else:
                leg, k = divmod(direction - 6, 3)
                (base if leg < 6 else joints)[k, leg % 6] += step
            D, C = indices(base, joints, origin, rotation)
            ends.append([*D, *C])
        return [(a - b) / (2 * STEP) for a, b in zip(*ends, strict=True)]


def gradient(geometry: Geometry, o: Any, R: Any, names: tuple[str, ...] = ("dD", "dC")) -> Any:
    """[8, 42], what is structurally zero filled in."""
    platform = geometry.platform()
    values = found(platform, names, [(np.array(o, dtype=float), np.array(R))])
    outputs = {output.name: output for output in cached_program(platform, names).outputs}
    dense = np.zeros((4 * len(names), 42))
    for number, name in enumerate(names):
        for (row, column), value in zip(outputs[name].sparsity.entries(), values[name][:, 0], strict=True):
            dense[4 * number + row, column] = value
    return dense


@pytest.mark.parametrize("geometry", [GENERIC, GEOMETRIES["6-6, Wolfram"]], ids=["general", "6-6"])
def test_all_gradients_are_right_where_values_are_different(geometry: Geometry) -> None:
    o = np.array([0.1, 0.05, 1.0]) * geometry.height
    R = Rotation.from_euler("ZYX", [0.2, 0.1, -0.15]).as_matrix()
    found_ = gradient(geometry, o, R)
    sizes = np.abs(found_).max(axis=1)
    for direction in (0, 1, 2, 3, 4, 5, 6, 13, 23, 24, 32, 41):
        expected = np.array([float(x) for x in slopes(geometry, o, R, direction)])
        assert (np.abs(found_[:, direction] - expected) <= 1e-12 * sizes).all(), direction


@pytest.mark.parametrize("name", ["3-3, octahedral optimum", "cubic"])
def test_gradients_of_d_are_right_and_those_of_c_finite_at_home_with_its_repeated_values(name: str) -> None:
    geometry = GEOMETRIES[name]
    o = np.array([0, 0, geometry.height])
    found_ = gradient(geometry, o, np.eye(3))
    assert np.isfinite(found_).all()
    for direction in (2, 5, 7):
        expected = np.array([float(x) for x in slopes(geometry, o, np.eye(3), direction)[:4]])
        assert (np.abs(found_[:4, direction] - expected) <= 1e-12 * (1 + np.abs(found_[:4]).max(axis=1))).all()


def test_the_gradient_of_c_at_home_is_right_in_directions_that_keep_the_values_repeated() -> None:
    """Moving up keeps the symmetry of the design, so that C is smooth along it."""
    o = np.array([0, 0, 0.9])
    found_ = gradient(SEMI_REGULAR, o, np.eye(3))
    expected = np.array([float(x) for x in slopes(SEMI_REGULAR, o, np.eye(3), 2)])
    assert found_[:, 2] == pytest.approx(expected, rel=1e-12, abs=1e-12)
