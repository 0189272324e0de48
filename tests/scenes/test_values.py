"""Scenes against the joint library: the routine of a mechanism gives what the routines of its joints give."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from codegen.spec.markers import markers
from codegen.spec.scene import SCENE_JOINTS, Marker
from tests.lower.numbers import EXACT

from . import cases
from .cases import every_scene, scene
from .library import System, assembled
from .mechanisms import Link, determinant, mechanism, pose
from .workshop import values

DIGITS = Fraction(1, 10**39)
"""To which square roots are kept."""


@every_scene
def test_every_quantity_is_exactly_that_of_the_library_s_routines_put_into_place(name: str) -> None:
    """In fractions; sines and cosines are rational points of the circle. At poses anywhere, on no manifold."""
    inputs = pose(scene(name), 1)
    emitted, expected = values(cases.program(name), inputs), assembled(System(scene(name), inputs, Fraction), EXACT)
    for quantity, matrix in expected.items():
        assert emitted[quantity].shape == matrix.shape, quantity
        assert (emitted[quantity] == matrix).all(), quantity


@pytest.mark.parametrize("type_", SCENE_JOINTS)
def test_the_frames_that_a_form_takes_have_the_points_and_the_axes_of_the_joint(type_: str) -> None:
    """The cross of the universal joint, ``h_i`` and ``f_j``, is ``h_i`` and ``h_j`` in the conventional form."""
    (joint,) = mechanism(3, 1, [Link(type_, "conventional", (-1, 0))]).scene.joints
    for form in ("conventional", "parametric"):
        first, second = markers(joint, form)
        is_cross = type_ == "universal" and form == "conventional"
        assert first.point == joint.marker_i.point and second.point == joint.marker_j.point
        if type_ != "ball":  # it has no axis
            assert column(first, 2) == column(joint.marker_i, 2)
            assert column(second, 2) == column(joint.marker_j, 0 if is_cross else 2)
        for marker in (first, second):
            C = np.array(marker.axes, dtype=object)
            assert (np.eye(3) == C.T @ C).all() and determinant(C) == 1


def column(marker: Marker, k: int) -> tuple[Fraction, ...]:
    """An axis of a joint frame."""
    return tuple(row[k] for row in marker.axes)
