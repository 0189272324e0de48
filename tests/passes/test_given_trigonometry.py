"""With sines and cosines as inputs a program gives the same bits."""

from __future__ import annotations

import math

import pytest

from codegen import models
from codegen.ir.evaluate import evaluate
from codegen.ir.ops import Op
from codegen.passes.given_trigonometry import SINES_COSINES, given_trigonometry
from codegen.spec.request import Variant
from tests.reference.poses import sample

TRIGONOMETRIC = {Op.SIN, Op.COS, Op.SINCOS, Op.SINE_OF, Op.COSINE_OF}


@pytest.mark.parametrize("joint", ["revolute", "universal", "screw", "ball"])
def test_given_sines_and_cosines_change_no_bit(joint: str) -> None:
    program = models.model(Variant(joint, "parametric", "regular", "substituted")).program(["phi", "phi_q"])
    given = given_trigonometry(program)
    assert not TRIGONOMETRIC & {instruction.op for instruction in given.instructions}
    inputs = {
        name: [float(x) for x in value.ravel(order="F")] for name, value in sample(joint, "parametric", 3).items()
    }
    pairs = [part for angle in inputs["alpha"] for part in (math.sin(angle), math.cos(angle))]
    assert evaluate(given, inputs | {SINES_COSINES: pairs}) == evaluate(program, inputs)


def test_a_program_without_angles_is_left_alone() -> None:
    program = models.model(Variant("revolute", "conventional", None)).program(["phi"])
    assert given_trigonometry(program) is program
