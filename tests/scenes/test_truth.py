"""Scenes against derivatives of their constraints on SO(3) that no part of the generator has a hand in."""

from __future__ import annotations

import pytest

from codegen.ir.evaluate import evaluate

from . import cases
from .cases import SCENES, every_scene, scene
from .library import dense
from .mechanisms import pose
from .truth import quantities
from .workshop import any_program

TOLERANCE = 1e-13
"""Beside the largest entry of a quantity, at least 1."""


@every_scene
def test_every_quantity_is_the_derivative_of_the_constraints(name: str) -> None:
    inputs = {argument: [float(x) for x in entries] for argument, entries in pose(scene(name), 2).items()}
    expected = quantities(scene(name), inputs)
    emitted = evaluate(cases.program(name), inputs)
    for output in cases.program(name).outputs:
        value = dense(output, emitted[output.name], 0.0).astype(float)
        scale = max(1.0, abs(expected[output.name]).max())
        assert abs(value - expected[output.name]).max() < TOLERANCE * scale, output.name


@pytest.mark.parametrize("name", (SCENES[0], SCENES[6], SCENES[13], SCENES[14]))
def test_the_derivative_of_phi_q_v_is_that_of_the_constraints(name: str) -> None:
    """At fixed components of the velocity."""
    inputs = {argument: [float(x) for x in entries] for argument, entries in pose(scene(name), 2).items()}
    expected = quantities(scene(name), inputs)["phi_q_v_q"]
    found = any_program(scene(name), ("phi_q_v_q",))
    value = dense(found.output("phi_q_v_q"), evaluate(found, inputs)["phi_q_v_q"], 0.0).astype(float)
    assert abs(value - expected).max() < TOLERANCE * abs(expected).max()
