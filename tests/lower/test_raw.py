"""Where matrices are taken as they are, ``phi`` is right for any matrices, whichever way is chosen."""

from __future__ import annotations

import random
from fractions import Fraction

import numpy as np

from codegen.ir.evaluate import evaluate
from codegen.passes import simplify
from codegen.spec.request import Variant

from .models import Covered, each, laid_out, model_of, program_of, random_choice
from .numbers import EXACT, random_inputs
from .truth import exact_truth


@each(
    *(Variant(joint, "conventional", None, matrices="raw") for joint in ("revolute", "translational", "screw")),
    Variant("cylindrical", "parametric", "regular", matrices="raw"),
    Variant("universal", "parametric", "table4", "substituted", matrices="raw"),
)
def test_phi_takes_raw_matrices_as_they_are(variant: Variant) -> None:
    parts, source = laid_out(variant, ("phi",)), random.Random(4)
    covered: list[Covered] = [set() for _ in parts]
    for seed in range(4):
        choices = [random_choice(laid.graph, source, seen) for laid, seen in zip(parts, covered, strict=True)]
        for choice, seen in zip(choices, covered, strict=True):
            seen |= set(choice.items())
        inputs = random_inputs(model_of(variant), seed, is_orthonormal=False)
        (values,) = evaluate(simplify(program_of(parts, choices)), inputs, EXACT).values()
        expected = exact_truth(variant, inputs)["phi"]
        assert np.array_equal(np.array(values, dtype=object), expected), (seed, list(map(Fraction, values)))
