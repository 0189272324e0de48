"""Singular poses, poses close to them, and sizes far from 1."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from .found import EPS, TYPES, found
from .geometries import GEOMETRIES, SEMI_REGULAR, Geometry
from .test_accuracy import errors, rounded
from .truth import truth

NAMES = ("D", "C", "values", "det", "status")
J1, J2, J = 1, 2, 4
QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])


def one(geometry: Geometry, o: Any, R: Any, real: str = "double", variant: str = "robust") -> dict[str, Any]:
    outputs = found(geometry.platform(variant), NAMES, [(np.array(o, dtype=float), np.array(R))], real)
    return {name: values[:, 0] for name, values in outputs.items()}


def is_singular(out: dict[str, Any]) -> None:
    """sigma and alpha have no least value, D is zero and C infinite; nothing is NaN."""
    assert out["det"][0] == 0
    assert not np.isnan(np.concatenate(list(out.values()))).any()
    zero = out["values"].reshape(4, 3)[:, 2] == 0
    assert (out["D"][zero] == 0).all() and (out["D"][~zero] > 0).all()
    assert np.isinf(out["C"][zero]).all() and np.isfinite(out["C"][~zero]).all()


@pytest.mark.parametrize("variant", ["robust", "balanced"])
@pytest.mark.parametrize("real", EPS)
@pytest.mark.parametrize("o", [[0, 0, 0.9], [0.25, 0, 0.5], [0.125, -0.25, 2]])
def test_a_platform_turned_by_a_quarter_is_singular_after_fichter(o: list[float], real: str, variant: str) -> None:
    out = one(SEMI_REGULAR, o, QUARTER, real, variant)
    is_singular(out)
    assert out["status"][0] == J
    assert (out["values"].reshape(4, 3)[:, 2] == 0).tolist() == [True, False, True, False]


@pytest.mark.parametrize("real", EPS)
def test_a_platform_that_lies_in_its_base_is_singular_in_every_block(real: str) -> None:
    out = one(SEMI_REGULAR, [0, 0, 0], np.eye(3), real)
    is_singular(out)
    assert out["status"][0] == J1 + J2 + J


@pytest.mark.parametrize("real", EPS)
def test_legs_that_all_meet_one_line_are_singular_after_hunt(real: str) -> None:
    """The platform of the octahedral design is tilted until the legs of one of its joints lie in its plane."""
    geometry = GEOMETRIES["3-3, octahedral optimum"]
    out = one(geometry, *hunt(0.0), real)
    is_singular(out)
    assert out["status"][0] == J


def hunt(distance: float) -> tuple[Any, Any]:
    """A pose at so many radians from Hunt's configuration: turned about the side of the platform between two joints.

    The two legs of the third joint then lie in the plane of the platform, so that all six legs meet that side.
    """
    base_side, top_side = 2.0, 1.0
    third = np.array([top_side / np.sqrt(3), 0, 0])
    down = np.array([base_side / 2 / np.sqrt(3), 0, 0])  # middle of the two base joints of the third joint
    side = np.array([-top_side / 2 / np.sqrt(3), 0, 0])
    tilt = 0.7
    along = np.array([np.cos(tilt), 0, -np.sin(tilt)])
    lever = np.linalg.norm(third - side)
    start = down - along * 1.2
    R = Rotation.from_euler("y", tilt + distance).as_matrix()
    origin = start - R @ np.array([lever, 0, 0]) - R @ side
    return origin, R


@pytest.mark.parametrize("distances", [[10.0**-k for k in range(13)]])
def test_hunts_configuration_is_approached_without_loss(distances: list[float]) -> None:
    geometry = GEOMETRIES["3-3, octahedral optimum"]
    poses = [hunt(distance) for distance in distances]
    check(geometry, poses)


def test_fichters_configuration_is_approached_without_loss() -> None:
    o = np.array([0.1, 0, 0.9])
    check(SEMI_REGULAR, [(o, Rotation.from_rotvec([0, 0, np.pi / 2 - 10.0**-k]).as_matrix()) for k in range(13)])


def test_a_parked_platform_keeps_its_digits() -> None:
    check(SEMI_REGULAR, [(np.array([0.01, 0, 10.0**-k]), np.eye(3)) for k in range(3, 13)])


def test_a_parked_platform_keeps_its_digits_in_float() -> None:
    check(rounded(SEMI_REGULAR, "float"), [(np.array([0, 0, 2.0**-k]), np.eye(3)) for k in range(3, 17)], "float")


@pytest.mark.parametrize("factor", [1e-9, 1e-6, 1e-3, 1e3])
@pytest.mark.parametrize("real", EPS)
def test_any_unit_of_length_keeps_the_digits(factor: float, real: str) -> None:
    small = Geometry(factor * SEMI_REGULAR.base, factor * SEMI_REGULAR.joints, factor * 0.9, 0.1 * factor)
    small = rounded(small, real)
    check(small, list(small.poses()), real)


def test_a_base_frame_far_away_keeps_the_digits_that_the_numbers_have() -> None:
    """1e7 m away a double has 2e-9 m; what is computed from these numbers is right to all digits."""
    far = np.array([[1e7], [-2e7], [1e7]])
    moved = replace(SEMI_REGULAR, base=SEMI_REGULAR.base + far)
    check(moved, [(o + far[:, 0], R) for o, R in SEMI_REGULAR.poses()])


def test_a_reference_point_far_away_costs_what_kappa_says() -> None:
    shift = np.array([[100.0], [-50.0], [20.0]])
    moved = replace(SEMI_REGULAR, joints=SEMI_REGULAR.joints - shift)
    check(moved, [(o + R @ shift[:, 0], R) for o, R in SEMI_REGULAR.poses()])


def check(geometry: Geometry, poses: list[tuple[Any, Any]], real: str = "double") -> None:
    """Errors of at most 8 eps kappa; where that is more than everything, at most everything."""
    kind = TYPES[real]
    expected = [truth(geometry.base, geometry.joints, o.astype(kind), R.astype(kind)) for o, R in poses]
    wrong = errors(found(geometry.platform(), ("D", "C"), poses, real), expected, ("D", "C"))
    bounds = np.array([8 * EPS[real] * t.kappa for t in expected])
    small = bounds < 0.05
    assert small.any()
    assert (wrong <= bounds)[small].all(), (wrong / bounds)[small].max()


@pytest.mark.parametrize("variant", ["robust", "balanced"])
def test_only_a_leg_without_length_and_input_that_is_no_number_give_no_number(variant: str) -> None:
    touching = replace(SEMI_REGULAR, base=SEMI_REGULAR.joints.copy())
    for geometry, o in ((touching, [0, 0, 0]), (SEMI_REGULAR, [np.nan, 0, 1]), (SEMI_REGULAR, [0, np.inf, 1])):
        out = one(geometry, o, np.eye(3), variant=variant)
        assert np.isnan(out["D"]).all() and np.isnan(out["C"]).all()
        assert out["status"][0] == 8
