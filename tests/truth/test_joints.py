"""What makes the rows a joint: phi = 0 where the joint is assembled, and rows of full rank, found from emitted C."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from codegen.spec.request import Variant
from tests.reference.constraints import pair
from tests.reference.poses import consistent_pose, random_alpha

from .cases import SEEDS, VARIANTS, Values, each, every_variant, largest, usual_size
from .notes import Notes
from .workshop import Bench

ASSEMBLED = tuple(range(100, 120))
"""Seeds of the consistent poses."""
SMALLEST_SINGULAR_VALUE = 0.1
"""Of phi_q with rows of full rank; lengths are of order 1 m, frames orthonormal."""
ROUNDING = 1e-14

every_regular = each(*(variant for variant in VARIANTS if variant.rows == "regular"))
every_table4 = each(*(variant for variant in VARIANTS if variant.rows == "table4"))
every_quaternion = each(*(variant for variant in VARIANTS if variant.rows == "quaternion"))
every_conventional = each(*(variant for variant in VARIANTS if variant.form == "conventional"))
every_rot3 = each(*(v for v in VARIANTS if v.rows == "regular" and pair(v.joint)[1] == 3))


def turns(variant: Variant) -> int:
    """Number of rotational coordinates."""
    return pair(variant.joint)[1]


def placed(variant: Variant, seed: int, angles: Any = None) -> dict[str, Any]:
    """A consistent pose with general frames, and with the given rotational coordinates in the parametric form."""
    rng = np.random.default_rng(seed)
    alpha = None
    if angles is not None:
        alpha = random_alpha(variant.joint, variant.rows, rng)
        alpha[len(alpha) - len(angles) :] = angles
    return consistent_pose(variant.joint, variant.form, rng, variant.rows, alpha)


def singular_values(bench: Bench, inputs: dict[str, Any]) -> Values:
    """Singular values of the emitted phi_q, descending."""
    return np.asarray(np.linalg.svd(bench.value("phi_q", inputs), compute_uv=False))


def special_angles(variant: Variant) -> Iterator[tuple[float, ...]]:
    """Rotational coordinates with every mixture of 0, pi and general values."""
    for choice in product((0.0, np.pi, None), repeat=turns(variant)):
        for seed in SEEDS:
            general = np.random.default_rng(seed).uniform(0.2, 1.3, size=len(choice))
            signed = general * np.random.default_rng(seed + 1).choice([-1, 1], size=len(choice))
            yield tuple(float(x) if special is None else special for special, x in zip(choice, signed, strict=True))


@every_variant
def test_phi_is_zero_where_the_joint_is_assembled(bench: Bench, variant: Variant, note: Notes) -> None:
    """To 1e-14 of the usual size of phi off the manifold."""
    sizes = [largest(bench.value("phi", placed(variant, seed))) for seed in ASSEMBLED]
    note("largest phi", max(sizes))
    assert max(sizes) < ROUNDING * max(1.0, usual_size(variant, "phi"))


@every_conventional
def test_conventional_rows_have_full_rank(bench: Bench, variant: Variant, note: Notes) -> None:
    smallest = min(singular_values(bench, placed(variant, seed))[-1] for seed in ASSEMBLED)
    note("smallest singular value", smallest)
    assert smallest > SMALLEST_SINGULAR_VALUE


@every_regular
def test_regular_rows_have_full_rank_at_every_alpha(bench: Bench, variant: Variant, note: Notes) -> None:
    smallest = min(
        singular_values(bench, placed(variant, seed, angles))[-1] for seed, angles in enumerate(special_angles(variant))
    )
    note("smallest singular value", smallest)
    assert smallest > SMALLEST_SINGULAR_VALUE


@every_rot3
def test_gimbal_lock_costs_a_coordinate_and_no_row(bench: Bench, variant: Variant) -> None:
    """rot3 at a2 = +-pi/2: the columns of alpha become dependent, and nowhere else."""
    for seed in SEEDS:
        for angle in (np.pi / 2, -np.pi / 2, 0.0, 1.2):
            first = bench.value("phi_q", placed(variant, seed, (0.3, angle, -0.7)))
            independent = np.linalg.svd(first[:, 12:], compute_uv=False)[-1]
            assert np.linalg.svd(first, compute_uv=False)[-1] > SMALLEST_SINGULAR_VALUE
            assert (independent < ROUNDING) == (abs(angle) == np.pi / 2)


@every_quaternion
def test_quaternion_rows_have_full_rank_everywhere(bench: Bench, variant: Variant, note: Notes) -> None:
    rng = np.random.default_rng(SEEDS[0])
    general = [unit / np.linalg.norm(unit) for unit in rng.normal(size=(20, 4))]
    smallest = min(
        np.linalg.svd(matrix, compute_uv=False)[-1]
        for seed, e in enumerate([*np.eye(4), *general])
        for phi_q in [bench.value("phi_q", placed(variant, seed, e))]
        for matrix in (phi_q, phi_q[:, 12:])
    )
    note("smallest singular value", smallest)
    assert smallest > SMALLEST_SINGULAR_VALUE


@every_table4
def test_table4_rows_lose_rank_at_0_and_pi(bench: Bench, variant: Variant) -> None:
    """rot1: at alpha = 0, pi; rot2: at either angle; rot3: at the first or the third. In the reference pose always."""
    deciding = (0, 2) if turns(variant) == 3 else tuple(range(turns(variant)))
    for seed, angles in enumerate(special_angles(variant)):
        smallest = singular_values(bench, placed(variant, seed, angles))[-1]
        singular = any(angles[k] in (0.0, np.pi) for k in deciding)
        assert (smallest < ROUNDING) if singular else (smallest > 1e-3), (angles, smallest)


@every_table4
def test_rank_of_table4_rows_falls_with_the_sine(bench: Bench, variant: Variant) -> None:
    """sigma_min ~ |sin alpha|, of order 1."""
    for seed in SEEDS:
        near = [
            singular_values(bench, placed(variant, seed, (angle, *[0.6] * (turns(variant) - 1))))[-1]
            for angle in (1e-3, 1e-2)
        ]
        assert 0.1 < near[0] / 1e-3 < 10
        assert 9 < near[1] / near[0] < 11
