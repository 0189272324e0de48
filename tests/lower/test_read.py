"""What is read of an expression has its value: frames drop out without loss."""

from __future__ import annotations

from typing import Any

import numpy as np

from codegen.ir.lower.factors import is_matrix
from codegen.mechanics.frames import A_ij, A_j, dp_ij
from codegen.spec.request import QUANTITIES, Variant

from .models import Laid, each, laid_out
from .numbers import Inputs, of_symbols, random_inputs
from .sympy_values import Values

OUTPUTS = (*QUANTITIES, "phi_q_v", "phi_q_t_lambda")

READ = (
    *(
        Variant(joint, "conventional", None, "exact", variation)
        for joint in ("revolute", "translational", "screw")
        for variation in ("body", "world")
    ),
    Variant("screw", "conventional", None, "substituted"),
    Variant("universal", "parametric", "regular"),
    Variant("ball", "parametric", "table4", "exact", "world"),
    Variant("screw", "parametric", "regular", "substituted"),
    Variant("ball", "parametric", "table4", "substituted"),
    Variant("rigid", "parametric", "regular", "substituted"),
    Variant("ball", "parametric", "quaternion"),
    Variant("ball", "parametric", "quaternion", "substituted"),
)


def value_of_demand(laid: Laid, inputs: Inputs, kind: str, found: Any) -> Any:
    """Entries of a demand from the meaning of its node, [3, 3] of a matrix."""
    sign, node, *turned = found
    entries = np.array(laid.meaning(inputs).of(laid.demands.layout.nodes[node].key), dtype=object) * sign
    if kind != "matrix":
        return entries
    return entries.reshape(3, 3).T if turned[0] else entries.reshape(3, 3)


def symbolic_values(laid: Laid, inputs: Inputs) -> Values:
    """Values of the model's expressions; where the joint relation is inserted, body j is where it says."""
    form = laid.model.form
    values = of_symbols(laid.model, inputs)
    stages = dict(form.stages)
    if A_j not in laid.part.places.given:
        stages[A_ij] = form.substitution[A_ij]
        stages[dp_ij] = form.substitution[dp_ij]
        values["A_j"] = values["A_i"] @ Values(values, stages).of(stages[A_ij])
    return Values(values, stages)


@each(*READ)
def test_a_block_that_is_read_has_the_value_of_its_expression(variant: Variant) -> None:
    for laid in laid_out(variant, OUTPUTS):
        inputs = random_inputs(laid.model, 1)
        values = symbolic_values(laid, inputs)
        for output in laid.part.outputs:
            demands = {demand[:2]: demand[2:] for demand in laid.found(output.name)}
            assert set(demands) <= {(block.row, block.column) for block in output.blocks}
            for block in output.blocks:
                expected = np.ravel(np.asarray(values.of(block.expression), dtype=object))
                found = demands.get((block.row, block.column))
                actual = np.ravel(value_of_demand(laid, inputs, *found)) if found else np.zeros(len(expected))
                assert np.array_equal(actual, expected), (output.name, block)
                assert not found or (found[0] == "scalar") != is_matrix(block.expression)


@each(*(variant for variant in READ if variant.joint == "screw" and variant.form == "conventional"))
def test_a_scalar_that_is_no_polynomial_has_the_value_of_its_stage(variant: Variant) -> None:
    (laid,) = laid_out(variant, OUTPUTS)
    inputs = random_inputs(laid.model, 3)
    values, meaning = symbolic_values(laid, inputs), laid.meaning(inputs)
    layout = laid.demands.layout
    stages = [symbol for symbol in laid.model.form.stages if str(symbol) in layout.definitions]
    assert stages
    for symbol in stages:
        expected = values.of(laid.model.form.stages[symbol])
        assert meaning.scalar(layout.space.scalar("stage", symbol.name)) == expected
