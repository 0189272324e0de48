"""Guaranteed bounds hold: for random programs against exact rationals, for routines against what a search finds."""

from __future__ import annotations

import statistics
from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from codegen import models
from codegen.ir.evaluate import evaluate, fraction_domain, numpy_domain
from codegen.ir.ops import Op
from codegen.ir.program import Output, Program, Sparsity
from codegen.measure.adversary import searched
from codegen.measure.bounds import Box, rounding_bounds
from codegen.measure.errors import number_type
from codegen.measure.judge import block_errors, box_judge, by_program, true_values
from codegen.measure.named_ranges import ranges
from codegen.measure.pose_boxes import neighbourhood, pose_box
from codegen.measure.pose_domain import Block, PoseDomain, blocks
from codegen.measure.poses import exactly, sample_poses
from codegen.measure.row_names import conventional_rows, parametric_rows
from codegen.passes.contract_fma import contract_fma
from codegen.spec.request import Variant
from tests.ir.programs import FUSED_OPS, RANDOM, inputs_of, programs

DOMAIN = PoseDomain()
WIDTH = 1e-3
LARGEST_MEDIAN = 12.0
REALS = ("double", "float")
CASES = [
    (Variant("revolute", "conventional", None), ("phi", "phi_q", "phi_q_t_lambda_q")),
    (Variant("screw", "conventional", None, variation="world"), ("phi", "phi_q")),
    (Variant("ball", "parametric", "table4"), ("phi", "phi_q", "gamma")),
    (Variant("planar", "parametric", "regular", "substituted"), ("phi_q", "phi_q_t_lambda_q", "gamma")),
    (Variant("universal", "parametric", "regular"), ("phi", "phi_q_v", "phi_q_t_lambda")),
]


def program_of(variant: Variant, output: str) -> Program:
    return models.model(variant).program([output])


def blocks_of(variant: Variant, program: Program) -> list[Block]:
    joint = models.joint_type(variant.joint)
    is_conventional = variant.form == "conventional"
    rows = conventional_rows(joint) if is_conventional else parametric_rows(joint, variant.rows or "")
    return [block for output in program.outputs for block in blocks(output, rows)]


def given_poses(variant: Variant, program: Program, is_converged: bool, real: str, count: int) -> dict[str, Any]:
    joint = models.joint_type(variant.joint)
    poses = sample_poses(joint, variant, program.arguments, DOMAIN, count, is_converged)
    used = {argument.name for argument in program.used_arguments()}
    return {name: rows for name, rows in poses.given(number_type(real)).items() if name in used}


@pytest.mark.parametrize("real", REALS)
@settings(parent=RANDOM, max_examples=60)
@given(
    programs(ops=(*FUSED_OPS, Op.DIVIDE)),
    inputs_of(st.floats(-3, 3, width=32, allow_subnormal=False)),
    inputs_of(st.floats(0, 0.5, width=32)),
)
def test_no_random_program_exceeds_its_bound(
    real: str, program: Program, inputs: dict[str, list[float]], widths: dict[str, list[float]]
) -> None:
    """At the middle of a box, which need not be narrow; the truth is exact rational arithmetic."""
    entries = {name: [(x - w, x + w) for x, w in zip(inputs[name], widths[name], strict=True)] for name in inputs}
    bounds = rounding_bounds(program, Box(entries), real)
    try:
        exact = evaluate(program, {name: [Fraction(x) for x in row] for name, row in inputs.items()}, fraction_domain())
    except ZeroDivisionError:
        assume(False)
        return
    kind = number_type(real)
    with np.errstate(all="ignore"):
        found = evaluate(program, {name: [kind(x) for x in row] for name, row in inputs.items()}, numpy_domain())
    for name, values in found.items():
        for value, truth, bound in zip(values, exact[name], bounds[name], strict=True):
            rounded = float(kind(value)) if real == "float" and not isinstance(value, np.floating) else float(value)
            assert bound == float("inf") or abs(Fraction(rounded) - truth) <= Fraction(bound)


@pytest.mark.parametrize("real", REALS)
def test_sampled_below_searched_below_guaranteed_and_the_bound_is_no_idle_one(real: str) -> None:
    """In a neighbourhood of a pose; the median of guaranteed over searched is at most 12 in every kind of block."""
    ratios: dict[str, list[float]] = {}
    for variant, outputs in CASES:
        for output in outputs:
            program = program_of(variant, output)
            box = neighbourhood(given_poses(variant, program, True, "double", 2), 1, WIDTH)
            bounds = rounding_bounds(program, box, real)
            judged = blocks_of(variant, program)
            start = np.random.default_rng(5).random((128, sum(len(entries) for entries in box.inputs.values())))
            found = searched(box_judge(program, box, real, judged), start)
            assert np.all(found.sampled <= found.searched)
            for block, error in zip(judged, found.searched, strict=True):
                bound = max(bounds[block.output][k] for k in block.entries)
                assert 0 < error <= bound, (variant, block.name)
                ratios.setdefault(block.name, []).append(bound / error)
    assert len(ratios) == 7
    for name, found_ratios in ratios.items():
        assert statistics.median(found_ratios) <= LARGEST_MEDIAN, name


@pytest.mark.parametrize("real", REALS)
@pytest.mark.parametrize(("variant", "outputs"), CASES, ids=lambda case: getattr(case, "file_stem", ""))
def test_no_pose_of_the_domain_exceeds_the_bound_fused_or_not(
    variant: Variant, outputs: tuple[str, ...], real: str
) -> None:
    for output in outputs:
        program = program_of(variant, output)
        box = pose_box(program, models.joint_type(variant.joint), variant, DOMAIN, real)
        bounds = rounding_bounds(program, box, real)
        assert all(np.isfinite(bounds[output]))
        judged = blocks_of(variant, program)
        for is_converged in (True, False):
            given = given_poses(variant, program, is_converged, real, 64)
            true = true_values(program, exactly(given))
            fused = by_program(contract_fma(program))(given) if real == "double" else by_program(program)(given)
            for found in (by_program(program)(given), fused):
                errors = block_errors(found, true, judged, 64)
                for block, error in zip(judged, errors, strict=True):
                    assert np.max(error) <= max(bounds[block.output][k] for k in block.entries), block.name


@pytest.mark.parametrize(("variant", "outputs"), CASES, ids=lambda case: getattr(case, "file_stem", ""))
def test_stages_are_as_small_as_their_names_say(variant: Variant, outputs: tuple[str, ...]) -> None:
    joint = models.joint_type(variant.joint)
    seen = 0
    for output in outputs:
        program = program_of(variant, output)
        known = ranges(program, joint, variant, DOMAIN)
        seen += len(known)
        watched = watching(program, list(known))
        for is_converged in (True, False):
            values = by_program(watched)(given_poses(variant, program, is_converged, "double", 256))["watched"]
            for value, largest in zip(values, known.values(), strict=True):
                assert np.max(np.abs(value)) <= largest * (1 + 1e-14)
    assert seen


def watching(program: Program, positions: list[int]) -> Program:
    """The program with other outputs: the values at some positions."""
    pattern = Sparsity.of_entries(len(positions), 1, [(k, 0) for k in range(len(positions))])
    return Program(program.arguments, program.instructions, (Output("watched", pattern, tuple(positions)),))
