"""Scenes against the joint library: the routine of a mechanism gives what the routines of its joints give."""

from __future__ import annotations

from fractions import Fraction

from tests.lower.numbers import EXACT

from .cases import every_scene, program, scene
from .library import System, assembled
from .mechanisms import pose
from .workshop import values


@every_scene
def test_every_quantity_is_exactly_that_of_the_library_s_routines_put_into_place(name: str) -> None:
    """In fractions; sines and cosines are rational points of the circle. At poses anywhere, on no manifold."""
    inputs = pose(scene(name), 1)
    emitted, expected = values(program(name), inputs), assembled(System(scene(name), inputs, Fraction), EXACT)
    for quantity, matrix in expected.items():
        assert emitted[quantity].shape == matrix.shape, quantity
        assert (emitted[quantity] == matrix).all(), quantity
