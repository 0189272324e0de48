"""The condition of a program is that of its derivative by the pass, another piece of code."""

from __future__ import annotations

import numpy as np
import pytest

from codegen import models
from codegen.ir.evaluate import evaluate
from codegen.measure.condition import condition
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import sample_poses
from codegen.passes import simplify
from codegen.passes.differentiate import differentiate
from codegen.spec.request import Variant


@pytest.mark.parametrize(
    ("variant", "output"),
    [
        (Variant("revolute", "parametric", "regular"), "phi_q"),
        (Variant("screw", "conventional", None), "phi"),
        (Variant("ball", "parametric", "table4", "substituted"), "phi_q_t_lambda"),
    ],
    ids=str,
)
def test_condition_is_the_sum_of_derivatives_times_inputs(variant: Variant, output: str) -> None:
    program = models.model(variant).program([output])
    poses = sample_poses(models.joint_type(variant.joint), variant, program.arguments, PoseDomain(), 300, False)
    given = poses.given(np.float64)
    found = condition(program, given)[output]
    derivative = simplify(differentiate(program))
    (result,) = program.outputs
    places = {entry: k for k, entry in enumerate(result.sparsity.entries())}
    nrow = result.sparsity.nrow
    for pose in (0, 255, 256, 299):
        inputs = {name: [float(x) for x in rows[:, pose]] for name, rows in given.items()}
        expected = np.zeros(len(places))
        values = evaluate(derivative, inputs)
        for block in derivative.outputs:
            argument = block.name.removeprefix(f"jac_{output}_")
            for (row, column), value in zip(block.sparsity.entries(), values[block.name], strict=True):
                expected[places[row % nrow, row // nrow]] += abs(value * inputs[argument][column])
        np.testing.assert_allclose(found[:, pose], expected, rtol=1e-9)
