"""Rotations of cuts, the factor of a Jacobian, and reactions that are not determined."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from codegen.chains.factor import RankLoss, factor, least_singular_value
from codegen.chains.generated import Generated
from codegen.chains.rotation import quaternion, rotation_vector, rotation_vector_slope
from codegen.chains.undetermined import undetermined
from codegen.spec.chain import Chain
from codegen.spec.chain_motions import Independent, Polynomial

from .mechanisms import spatial_slider_crank, three_cranks
from .runs import generated, prescribed_run

COMPONENT = st.floats(-1, 1)
ANGLES = st.sampled_from([0.0, 1e-9, 1e-5, 1e-3, 0.5, 2.0, 3.0, np.pi - 1e-3, np.pi - 1e-7])


@given(COMPONENT, COMPONENT, COMPONENT, ANGLES)
def test_the_rotation_vector_is_found_at_every_angle(x: float, y: float, z: float, angle: float) -> None:
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z]) if np.linalg.norm([x, y, z]) > 0.1 else np.eye(3)[0]
    e = quaternion(Rotation.from_rotvec(angle * axis).as_matrix())
    assert e @ e == pytest.approx(1.0, abs=1e-15)
    assert e[0] >= 0
    assert rotation_vector(e) == pytest.approx(angle * axis, abs=1e-12)


@given(COMPONENT, COMPONENT, COMPONENT, st.sampled_from([0.0, 1e-5, 1e-3, 1.0, 3.0]))
def test_the_slope_of_the_rotation_vector_is_a_difference_quotient(x: float, y: float, z: float, angle: float) -> None:
    axis = np.array([x, y, z]) / np.linalg.norm([x, y, z]) if np.linalg.norm([x, y, z]) > 0.1 else np.eye(3)[1]
    u, h = angle * axis, 1e-5
    R = Rotation.from_rotvec(u)
    sides = [[(Rotation.from_rotvec(s * h * w) * R).as_rotvec() for w in np.eye(3)] for s in (1, -1)]
    quotient = (np.array(sides[0]) - np.array(sides[1])).T / (2 * h)
    assert rotation_vector_slope(u) == pytest.approx(quotient, abs=1e-8)


def test_a_half_turn_has_a_unit_axis() -> None:
    for axis in np.eye(3):
        e = quaternion(Rotation.from_rotvec(np.pi * axis).as_matrix())
        assert np.abs(rotation_vector(e)) == pytest.approx(np.pi * axis, abs=1e-14)


def test_least_squares_and_least_norm_agree_with_the_pseudo_inverse() -> None:
    rng = np.random.default_rng(5)
    for m, n in ((6, 6), (9, 6), (1, 1), (5, 0)):
        A, b, c = rng.normal(size=(m, n)), rng.normal(size=(m, 2)), rng.normal(size=n)
        found, P = factor(A), np.linalg.pinv(A)
        assert found.solve(b) == pytest.approx(P @ b, abs=1e-12)
        assert found.solve_transposed(c) == pytest.approx(P.T @ c, abs=1e-12)
        assert np.max(np.abs(found.undetermined().T @ A), initial=0.0) < 1e-12
        assert found.undetermined().shape == (m, m - n)


def test_a_matrix_that_lacks_rank_is_told_with_what_is_free() -> None:
    A = np.array([[1.0, 2.0, 0.0], [0.0, 0.0, 1.0], [2.0, 4.0, 1.0]])
    with pytest.raises(RankLoss) as told:
        factor(A)
    assert (told.value.rank, told.value.wanted) == (2, 3)
    assert np.max(np.abs(A @ told.value.free)) < 1e-14
    assert least_singular_value(A) < 1e-15
    with pytest.raises(RankLoss):
        factor(np.ones((1, 2)))


def marked(chain: Chain) -> tuple[str, ...]:
    ready = generated(chain)
    assert isinstance(ready.equations, Generated)
    state = prescribed_run(ready, np.array([0.0, 0.01])).states[0]
    return undetermined(ready, ready.equations, state)


def test_a_spatial_loop_determines_all_reactions() -> None:
    assert marked(spatial_slider_crank()) == ()


def test_one_crank_too_many_leaves_forces_along_the_coupler_open() -> None:
    """Across the plane everything is open; in it the forces along the cranks, but no moment about their axes."""
    chain = three_cranks()
    driven = Independent("crank 1", Polynomial((F(0.7), F(1))))
    names = marked(replace(chain, independents=(driven,)))
    for cut in ("coupler's end", "coupler's middle"):
        assert {f"cut.{cut}.{axis}" for axis in ("fx", "fy", "fz", "mx", "my")} <= set(names)
        assert f"cut.{cut}.mz" not in names
    assert {"crank 1.fx", "crank 2.fx", "crank 3.fx"} <= set(names)
    assert not [name for name in names if name.endswith(".mz")]
