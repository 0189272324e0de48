"""A scene in the plane is the scene in space, restricted to the plane and to the rows that are not zero there."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction
from functools import cache
from itertools import product

import numpy as np
import pytest

from codegen.mechanics.assembly import Assembly
from codegen.scenes.programs import without_zero_rows
from codegen.spec.scene import Joint, Marker, Matrix
from tests.lower.numbers import EXACT, Inputs, fraction

from .library import System, assembled
from .mechanisms import TURN, Link, as_matrix, mechanism, pose
from .workshop import any_program, values

TYPES = ("revolute", "translational", "planar", "rigid")
FORMS = (
    ("conventional", "exact"),
    ("regular", "exact"),
    ("table4", "exact"),
    ("regular", "substituted"),
    ("table4", "substituted"),
)
ALONG = np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0]], dtype=object) * Fraction(1)
"""A joint frame with its third axis along x and its second along z."""

ENDS = {"revolute": (0, -1), "translational": (0, 1), "planar": (-1, 0), "rigid": (1, 0)}

every_joint = pytest.mark.parametrize(
    ("type_", "form"), list(product(TYPES, FORMS)), ids=lambda x: "-".join((x,) if isinstance(x, str) else x)
)


def axes(source: random.Random, type_: str, leaning: bool) -> Matrix:
    """Axes of a marker: the third along the normal, or against it; of a slide in the plane."""
    turns = [np.eye(3, dtype=object) * Fraction(1), TURN, TURN.T]
    if type_ == "translational":
        about_h = TURN if leaning else np.eye(3, dtype=object) * Fraction(1)
        return as_matrix(source.choice(turns) @ ALONG @ about_h)
    upside_down = np.diag([Fraction(1), Fraction(-1), Fraction(-1)])
    return as_matrix(source.choice(turns) @ (upside_down if leaning else turns[0]))


@cache
def scene(types: tuple[str, ...], form: tuple[str, str], leaning: bool = False) -> Assembly:
    """Two bodies in the plane with some joints."""
    found = mechanism(1, 2, [Link(type_, form[0], ENDS[type_]) for type_ in types], form[1])
    source = random.Random(len(types[0]))

    def marker(type_: str) -> Marker:
        x = source.choice((Fraction(0), fraction(source)))
        return Marker((x, fraction(source), Fraction(0)), axes(source, type_, leaning))

    joints: tuple[Joint, ...] = tuple(
        replace(joint, marker_i=marker(joint.type), marker_j=marker(joint.type)) for joint in found.scene.joints
    )
    return without_zero_rows(replace(found, scene=replace(found.scene, joints=joints, motion="planar")))


def in_space(planar: Assembly, inputs: Inputs) -> Inputs:
    """Inputs of the same scene in space."""
    zero, one = Fraction(0), Fraction(1)
    there = dict(inputs) | {"r": [], "A": [], "velocity": []}
    for k in range(len(planar.scene.bodies)):
        x, y = inputs["r"][2 * k : 2 * k + 2]
        cosine, sine, *_ = inputs["A"][4 * k : 4 * k + 4]
        v_x, v_y, omega = inputs["velocity"][3 * k : 3 * k + 3]
        there["r"] += [x, y, zero]
        there["A"] += [cosine, sine, zero, -sine, cosine, zero, zero, zero, one]
        there["velocity"] += [v_x, v_y, zero, zero, zero, omega]
    there["velocity"] += inputs["velocity"][3 * len(planar.scene.bodies) :]
    return there


def kept(planar: Assembly) -> list[int]:
    """Displacements in the plane among those in space."""
    bodies = len(planar.scene.bodies)
    return [6 * body + k for body in range(bodies) for k in (0, 1, 5)] + [
        6 * bodies + k for k in range(planar.coordinates)
    ]


@every_joint
def test_every_quantity_is_that_in_space_restricted(type_: str, form: tuple[str, str]) -> None:
    """Exactly, at poses in the plane that are on no manifold."""
    assert_restricted(scene((type_,), form))


@pytest.mark.parametrize("type_", TYPES)
def test_joint_frames_need_not_lie_along_the_plane(type_: str) -> None:
    """A slide whose other axes lean out of the plane, axes against the normal."""
    assert_restricted(scene((type_,), ("conventional", "exact"), leaning=True))


@pytest.mark.parametrize("form", (FORMS[0], FORMS[3]), ids="-".join)
@pytest.mark.parametrize("types", (("translational",) * 2, ("rigid", "revolute")), ids="-".join)
def test_blocks_of_several_joints_at_one_place_are_added_up(types: tuple[str, ...], form: tuple[str, str]) -> None:
    assert_restricted(scene(types, form))


def assert_restricted(planar: Assembly) -> None:
    """Compare with the library's joints in space."""
    inputs = pose(planar, 5)
    spatial = replace(planar, scene=replace(planar.scene, motion="spatial"))
    expected = assembled(System(spatial, in_space(planar, inputs), Fraction), EXACT)
    expected["phi_q"] = expected["phi_q"][:, kept(planar)]
    expected["phi_q_t_lambda_q"] = expected["phi_q_t_lambda_q"][np.ix_(kept(planar), kept(planar))]
    expected["phi_q_t_lambda"] = expected["phi_q_t_lambda"][kept(planar)]
    emitted = values(any_program(planar), inputs)
    for quantity, matrix in expected.items():
        assert emitted[quantity].shape == matrix.shape, quantity
        assert (emitted[quantity] == matrix).all(), quantity


@every_joint
def test_rows_that_are_left_out_are_zero_all_over_the_plane_and_no_others(type_: str, form: tuple[str, str]) -> None:
    planar = scene((type_,), form)
    whole = replace(planar, dropped=frozenset(), scene=replace(planar.scene, motion="spatial"))
    moving = set()
    for seed in (3, 4):
        inputs = pose(planar, seed) | {"lambda": [Fraction(1)] * whole.all_rows}
        found = assembled(System(whole, in_space(planar, inputs), Fraction), EXACT)
        for row in planar.dropped:
            assert found["phi"][row, 0] == 0 and found["gamma"][row, 0] == 0
            assert not found["phi_q"][row, kept(planar)].any()
        moving |= {
            row for row in range(whole.all_rows) if found["phi"][row, 0] or found["phi_q"][row, kept(planar)].any()
        }
    assert moving == set(planar.rows)


@every_joint
def test_a_joint_in_the_plane_takes_three_rows_less_its_freedoms(type_: str, form: tuple[str, str]) -> None:
    """And one more for each of its coordinates; the rows that all vanish across the plane are gone."""
    freedoms = {"revolute": 1, "translational": 1, "planar": 3, "rigid": 0}[type_]
    planar = scene((type_,), form)
    assert len(planar.rows) == 3 - freedoms + planar.coordinates
