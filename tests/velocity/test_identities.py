"""What holds of every pose (S3, corrected), and the closed form of a semi-regular hexagon."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from codegen.ir.evaluate import evaluate
from codegen.platforms.programs import program
from codegen.spec.platform import ATTITUDES, QUANTITIES, VARIANTS
from flopcount.count import count
from tests.ir.programs import RANDOM

from .found import found
from .geometries import GEOMETRIES, SEMI_REGULAR, Geometry

FEW = settings(RANDOM, max_examples=10)
EVERYTHING = tuple(QUANTITIES)
SIGMA, BETA, ALPHA, GAMMA = range(4)

POSE = st.tuples(
    st.tuples(*[st.floats(-0.3, 0.3)] * 3), st.tuples(st.floats(-1, 1), st.floats(-0.5, 0.5), st.floats(-0.5, 0.5))
)


def pose(numbers: Any, height: float = 0.9) -> tuple[Any, Any]:
    (x, y, z), angles = numbers
    return np.array([x, y, height + z]), Rotation.from_euler("ZYX", angles).as_matrix()


def one(geometry: Geometry, names: tuple[str, ...], where: tuple[Any, Any], variant: str = "robust") -> dict[str, Any]:
    """Outputs of a pose as vectors and matrices."""
    platform = geometry.platform(variant)
    outputs = found(platform, names, [where])
    shapes = {"J": (6, 6), "Q1": (6, 3), "Q2": (6, 3), "w_of_v": (3, 3), "v_of_w": (3, 3)}
    dense = {name: values[:, 0] for name, values in outputs.items()}
    return {name: v.reshape(shapes[name][::-1]).T if name in shapes else v for name, v in dense.items()}


@FEW
@given(POSE)
def test_both_orders_of_the_blocks_give_the_determinant(numbers: Any) -> None:
    out = one(SEMI_REGULAR, ("J", "D", "det", "values"), pose(numbers))
    D, values = out["D"], out["values"].reshape(4, 3)
    kappa = np.linalg.cond(out["J"])
    assert out["det"][0] == pytest.approx(abs(np.linalg.det(out["J"])), rel=1e-14 * kappa)
    assert D[SIGMA] * D[GAMMA] == pytest.approx(D[BETA] * D[ALPHA], rel=1e-14 * kappa)
    assert (values[BETA] ** 2).sum() == pytest.approx(6, rel=1e-14)
    assert (values[SIGMA] <= values[BETA] * (1 + 1e-14 * kappa)).all()
    assert (values[ALPHA] <= values[GAMMA] * (1 + 1e-14 * kappa)).all()
    assert (np.diff(values, axis=1) <= 1e-14).all()


@FEW
@given(POSE)
def test_the_jacobian_is_the_derivative_of_the_lengths(numbers: Any) -> None:
    o, R = pose(numbers)
    J, step = one(SEMI_REGULAR, ("J",), (o, R))["J"], 1e-6
    twists = [sign * step * np.eye(6)[k] for sign in (1, -1) for k in range(6)]
    turned = [(o + twist[:3], Rotation.from_rotvec(twist[3:]).as_matrix() @ R) for twist in twists]
    lengths = found(SEMI_REGULAR.platform(), ("lengths",), turned)["lengths"]
    assert (lengths[:, :6] - lengths[:, 6:]) / (2 * step) == pytest.approx(J, abs=1e-9)


@FEW
@given(POSE)
def test_inverse_motions_and_ellipsoids_are_what_they_say(numbers: Any) -> None:
    out = one(SEMI_REGULAR, EVERYTHING, pose(numbers))
    J, tolerance = out["J"], 1e-13 * np.linalg.cond(out["J"])
    inverse = np.vstack([out["Q1"].T, out["Q2"].T])
    assert np.abs(inverse @ J - np.eye(6)).max() < tolerance
    assert out["limits"] == pytest.approx(np.abs(inverse).sum(axis=1), rel=1e-14)
    J1, J2 = J[:, :3], J[:, 3:]
    assert out["w_of_v"] == pytest.approx(-np.linalg.lstsq(J2, J1)[0], abs=tolerance)
    assert out["v_of_w"] == pytest.approx(-np.linalg.lstsq(J1, J2)[0], abs=tolerance)
    assert out["semi_axes"] == pytest.approx(1 / out["values"], rel=1e-14)
    platform = SEMI_REGULAR.platform()
    pattern = program(platform, ("ellipsoids",)).outputs[0].sparsity
    F = np.zeros((pattern.nrow, pattern.ncol))
    for (row, column), value in zip(pattern.entries(), out["ellipsoids"], strict=True):
        F[row, column] = value
    for k in range(4):
        axes = np.linalg.svd(F[:, 3 * k : 3 * k + 3], compute_uv=False)
        assert np.sort(axes) == pytest.approx(out["semi_axes"][3 * k : 3 * k + 3], rel=tolerance)


def test_the_ellipsoid_of_v_holds_every_velocity_of_unit_leg_speeds() -> None:
    out = one(SEMI_REGULAR, ("J", "ellipsoids", "Q1"), pose(((0.1, 0.2, 0), (0.3, 0.1, 0))))
    J1, J2 = out["J"][:, :3], out["J"][:, 3:]
    N_v = J1.T @ (np.eye(6) - J2 @ np.linalg.pinv(J2)) @ J1
    speeds = np.random.default_rng(1).normal(size=(200, 6))
    v = (speeds / np.linalg.norm(speeds, axis=1)[:, None]) @ out["Q1"]
    assert (np.einsum("ni,ij,nj->n", v, N_v, v) <= 1 + 1e-12).all()


@pytest.mark.parametrize("shift", [(0.5, -0.2, 0.3), (0, 0, -2.0)])
def test_another_reference_point_leaves_alpha_and_beta(shift: Any) -> None:
    o, R = pose(((0.1, 0.2, 0), (0.3, 0.1, 0)))
    moved = replace(SEMI_REGULAR, joints=SEMI_REGULAR.joints - np.array(shift)[:, None])
    first = one(SEMI_REGULAR, ("J", "values"), (o, R))
    second = one(moved, ("values",), (o + R @ np.array(shift), R))
    for block in (ALPHA, BETA):
        place = slice(3 * block, 3 * block + 3)
        assert second["values"][place] == pytest.approx(first["values"][place], rel=1e-13 * np.linalg.cond(first["J"]))


@pytest.mark.parametrize("factor", [1e-9, 1e-3, 1e3, 1e6])
def test_a_unit_of_length_scales_rotations_only(factor: float) -> None:
    o, R = pose(((0.1, 0, 0), (0.3, 0.2, 0)))
    scaled = Geometry(factor * SEMI_REGULAR.base, factor * SEMI_REGULAR.joints, factor * 0.9, 0.1)
    first = one(SEMI_REGULAR, ("lengths", "D", "C", "J"), (o, R))
    second = one(scaled, ("lengths", "D", "C", "J"), (factor * o, R))
    assert second["C"] == pytest.approx(first["C"], rel=1e-13)
    assert second["D"] == pytest.approx(first["D"] * [1, 1, factor**3, factor**3], rel=1e-13)
    assert second["lengths"] == pytest.approx(factor * first["lengths"], rel=1e-14)
    assert second["J"] == pytest.approx(first["J"] * np.repeat([1, factor], 3), rel=1e-12, abs=1e-14 * factor)


@pytest.mark.parametrize("height", [0.2, 0.9, 3.0])
def test_a_semi_regular_hexagon_at_home_has_the_values_of_its_closed_form(height: float) -> None:
    base, top, delta = 1.0, 0.6, np.radians(30 / 2 - 80 / 2)
    d = np.sqrt(base**2 + top**2 - 2 * base * top * np.cos(delta))
    leg = np.hypot(height, d)
    values = one(SEMI_REGULAR, ("values", "C"), (np.array([0, 0, height]), np.eye(3)))
    beta = sorted([np.sqrt(3) * d / leg] * 2 + [np.sqrt(6) * height / leg], reverse=True)
    gamma = sorted(
        [np.sqrt(3) * top * height / leg] * 2 + [np.sqrt(6) * top * base * abs(np.sin(delta)) / leg], reverse=True
    )
    assert values["values"][3:6] == pytest.approx(beta, rel=1e-14)
    assert values["values"][9:] == pytest.approx(gamma, rel=1e-14)


@pytest.mark.parametrize("attitude", ATTITUDES)
def test_every_attitude_gives_the_indices_of_its_rotation(attitude: str) -> None:
    from codegen.platforms.attitudes import attitude_entries

    o, R = pose(((0.1, 0, 0), (0.3, 0.2, -0.1)))
    rows = tuple(tuple(Fraction(float(x)) for x in row) for row in R)
    name, entries = attitude_entries(attitude, rows)  # type: ignore[arg-type]
    turned = program(SEMI_REGULAR.platform("values", attitude), ("D",))
    D = evaluate(turned, {"o": list(o), name: [float(x) for x in entries]})["D"]
    assert pytest.approx(one(SEMI_REGULAR, ("D",), (o, R), "values")["D"], rel=1e-13) == D


@pytest.mark.parametrize("variant", VARIANTS)
def test_variants_agree_where_nothing_is_near_singular(variant: str) -> None:
    for geometry in (SEMI_REGULAR, GEOMETRIES["general, Dietmaier"]):
        where = (
            np.array([0.1 * geometry.step, 0, geometry.height]),
            Rotation.from_euler("ZYX", [0.1, 0.1, 0]).as_matrix(),
        )
        expected = one(geometry, ("D", "C", "det", "lengths"), where)
        names = tuple(name for name in expected if name in VARIANTS[variant] and (variant, name) != ("smooth", "C"))
        out = one(geometry, names, where, variant)
        for name in names:
            assert out[name] == pytest.approx(expected[name], rel=1e-9, abs=1e-14), name


@FEW
@given(POSE)
def test_the_smooth_condition_number_is_that_of_frobenius(numbers: Any) -> None:
    where = pose(numbers)
    out = one(SEMI_REGULAR, ("C",), where, "smooth")
    values = one(SEMI_REGULAR, ("values",), where)["values"].reshape(4, 3)
    frobenius = np.sqrt((values**2).sum(1) * (values**-2.0).sum(1)) / 3
    assert out["C"] == pytest.approx(frobenius, rel=1e-11)


AIMS = {"fast": 1465, "balanced": 1630, "robust": 2460, "values": 637}


@pytest.mark.parametrize("variant", AIMS)
def test_a_platform_whose_joints_lie_in_planes_costs_no_more_than_its_aim(variant: str) -> None:
    names = tuple(name for name in ("D", "C") if name in VARIANTS[variant])
    assert count(program(SEMI_REGULAR.platform(variant), names)).total <= AIMS[variant]


def test_the_volumes_of_any_platform_cost_no_more_than_their_aim() -> None:
    generator = np.random.default_rng(0)
    general = Geometry(generator.normal(size=(3, 6)), generator.normal(size=(3, 6)), 1.0, 0.1)
    assert count(program(general.platform("values"), ("D",))).total <= AIMS["values"]
