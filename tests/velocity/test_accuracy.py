"""The accuracy gate: robust indices are right to 8 eps kappa, and errors grow with kappa and not faster."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from flopcount.count import count

from .found import EPS, TYPES, cached_program, found
from .geometries import GEOMETRIES, SEMI_REGULAR, Geometry
from .truth import Truth, error, truth

INDICES = ("D", "C")


def rounded(geometry: Geometry, real: str) -> Geometry:
    """The geometry in numbers of the type: what is then computed has no other input."""
    kind = TYPES[real]
    base, joints = (array.astype(kind).astype(float) for array in (geometry.base, geometry.joints))
    return Geometry(base, joints, geometry.height, geometry.step)


def truths(geometry: Geometry, poses: list[tuple[Any, Any]], real: str) -> list[Truth]:
    kind = TYPES[real]
    return [truth(geometry.base, geometry.joints, o.astype(kind), R.astype(kind)) for o, R in poses]


def errors(outputs: dict[str, Any], expected: list[Truth], names: tuple[str, ...]) -> Any:
    """The greatest relative error of the indices of each pose."""
    return np.array(
        [
            max(error(outputs[n][k][j], getattr(t, n)[k]) for n in names for k in range(len(outputs[n])))
            for j, t in enumerate(expected)
        ]
    )


@pytest.mark.parametrize("real", EPS)
@pytest.mark.parametrize("name", GEOMETRIES)
def test_robust_indices_and_values_are_right_to_8_eps_kappa(name: str, real: str) -> None:
    geometry = rounded(GEOMETRIES[name], real)
    poses = list(geometry.poses())
    expected = truths(geometry, poses, real)
    outputs = found(geometry.platform(), (*INDICES, "values"), poses, real)
    wrong = errors(outputs, expected, (*INDICES, "values"))
    bounds = np.array([8 * EPS[real] * t.kappa for t in expected])
    assert (wrong <= bounds).all(), (wrong / bounds).max()


def test_fused_products_and_sums_keep_the_bounds() -> None:
    geometry = GEOMETRIES["3-3, octahedral optimum"]
    poses = list(geometry.poses())
    expected = truths(geometry, poses, "double")
    plain = geometry.platform()
    fused = replace(plain, wanted=replace(plain.wanted, fma=True))
    wrong = errors(found(fused, INDICES, poses), expected, INDICES)
    assert count(cached_program(fused, INDICES)).fma > 400
    assert (wrong <= [8 * EPS["double"] * t.kappa for t in expected]).all()


@pytest.mark.parametrize("name", GEOMETRIES)
def test_the_four_volumes_alone_are_right_to_8_eps_kappa(name: str) -> None:
    geometry = GEOMETRIES[name]
    poses = list(geometry.poses())
    expected = truths(geometry, poses, "double")
    wrong = errors(found(geometry.platform("values"), ("D",), poses), expected, ("D",))
    assert (wrong <= [8 * EPS["double"] * t.kappa for t in expected]).all()


def test_the_four_volumes_keep_their_digits_for_a_reference_point_far_away_and_near_a_singular_pose() -> None:
    shift = np.array([[100.0], [-50.0], [20.0]])
    far = Geometry(SEMI_REGULAR.base, SEMI_REGULAR.joints - shift, SEMI_REGULAR.height, SEMI_REGULAR.step)
    away = [(o + R @ shift[:, 0], R) for o, R in SEMI_REGULAR.poses()]
    for geometry, poses in ((far, away), (SEMI_REGULAR, approach(SEMI_REGULAR, [10.0**-k for k in range(1, 11)]))):
        expected = truths(geometry, poses, "double")
        wrong = errors(found(geometry.platform("values"), ("D",), poses), expected, ("D",))
        assert (wrong <= [8 * EPS["double"] * t.kappa for t in expected]).all()


def approach(geometry: Geometry, distances: Any) -> list[tuple[Any, Any]]:
    """Fichter's singular configuration, the platform turned by a quarter, from so many radians away."""
    from scipy.spatial.transform import Rotation

    o = np.array([0.05, 0.02, geometry.height])
    return [(o, Rotation.from_euler("ZYX", [np.pi / 2 + x, 0, 0]).as_matrix()) for x in distances]


def slope(wrong: Any, kappas: Any) -> float:
    """Growth of the error over kappa in a doubly logarithmic scale, of the means of five poses of about equal kappa."""
    x, y = np.log(np.array(kappas)), np.log(np.maximum(wrong, 1e-30))
    return float(np.polyfit(x.reshape(-1, 5).mean(1), y.reshape(-1, 5).max(1), 1)[0])


@pytest.mark.parametrize("variant, real, limit", [("robust", "double", 1.1), ("robust", "float", 1.1)])
def test_errors_grow_with_kappa_and_not_faster(variant: str, real: str, limit: float) -> None:
    geometry = rounded(SEMI_REGULAR, real)
    powers = range(1, 11) if real == "double" else range(1, 5)
    poses = approach(geometry, [10.0**-k * s for k in powers for s in (1, 1.3, 1.7, 2.1, 2.7)])
    expected = truths(geometry, poses, real)
    wrong = errors(found(geometry.platform(variant), INDICES, poses, real), expected, INDICES)
    kappas = [t.kappa for t in expected]
    assert max(kappas) > 1e3 * min(kappas)
    assert slope(wrong, kappas) <= limit
    assert (wrong <= 8 * EPS[real] * np.array(kappas)).all()


def test_the_literal_form_loses_digits_with_the_square_of_kappa() -> None:
    poses = approach(SEMI_REGULAR, [10.0**-k * s for k in range(2, 7) for s in (1, 1.3, 1.7, 2.1, 2.7)])
    expected = truths(SEMI_REGULAR, poses, "double")
    outputs = found(SEMI_REGULAR.platform("literal"), INDICES, poses)
    wrong = np.array([error(outputs["D"][0][j], t.D[0]) for j, t in enumerate(expected)])
    assert slope(wrong, [t.kappa for t in expected]) > 1.7


def test_the_literal_form_loses_half_of_the_digits_at_repeated_values_and_the_others_do_not() -> None:
    """At home beta and gamma have repeated values; C of gamma divides by the repeated ones."""
    home = [(np.array([0, 0, h]), np.eye(3)) for h in np.linspace(0.5, 1.3, 9)]
    expected = truths(SEMI_REGULAR, home, "double")

    def worst(variant: str) -> float:
        outputs = found(SEMI_REGULAR.platform(variant), ("values",), home)
        return float(errors(outputs, expected, ("values",)).max())

    assert worst("literal") > 1e-10
    assert worst("fast") < 1e-14
    assert worst("balanced") < 1e-14
    assert worst("robust") < 1e-14
