"""No routine loses more than what rounding its inputs already does: eta <= 2 for every block of every output.

The C gives the bits of the Program (`tests.c.test_bits`), so that the Program is judged, by numpy, over the standard
domain: poses on the constraint and in mid-iteration.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from codegen import models
from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.ir.program import Program
from codegen.measure.errors import Truth, figures, number_type, truth
from codegen.measure.pose_domain import Block, PoseDomain, blocks
from codegen.measure.poses import Poses, sample_poses
from codegen.measure.row_names import conventional_rows, parametric_rows
from codegen.spec.request import Variant

from .cases import COMMITTED, each
from .notes import Notes
from .workshop import Bench

LARGEST_ETA = 2.0
POSES = 64
ZERO = 1e-20
"""Nothing that is not identically zero is as small at all poses of the domain."""

DOMAIN = PoseDomain()


def poses_of(variant: Variant, program: Program, is_converged: bool) -> Poses:
    return sample_poses(models.joint_type(variant.joint), variant, program.arguments, DOMAIN, POSES, is_converged)


def judged(variant: Variant, program: Program) -> tuple[Block, ...]:
    joint = models.joint_type(variant.joint)
    conventional = variant.form == "conventional"
    rows = conventional_rows(joint) if conventional else parametric_rows(joint, variant.rows or "")
    return tuple(block for output in program.outputs for block in blocks(output, rows))


def values_of(program: Program, known: Truth) -> dict[str, Any]:
    kind = number_type(known.real)
    zeros = np.zeros(POSES, dtype=kind)
    found = evaluate(program, known.inputs, numpy_domain())
    return {name: [np.asarray(entry, dtype=kind) + zeros for entry in entries] for name, entries in found.items()}


@pytest.mark.parametrize("is_converged", [True, False], ids=["converged", "mid-iteration"])
@each(*COMMITTED)
def test_eta_is_at_most_2(bench: Bench, variant: Variant, is_converged: bool, note: Notes) -> None:
    for output, program in bench.programs.items():
        known = truth(program, poses_of(variant, program, is_converged), "double")
        for found in figures(known, values_of(program, known), judged(variant, program), DOMAIN):
            assert found.eta <= LARGEST_ETA, (output, found)
            note(f"eta of {found.block}", found.eta)


@each(*COMMITTED)
def test_what_is_identically_zero_is_zero_and_no_noise(bench: Bench, variant: Variant) -> None:
    for output, program in bench.programs.items():
        known = truth(program, poses_of(variant, program, is_converged=False), "double")
        found = values_of(program, known)
        for name, entries in known.of_inputs.items():
            idle = [k for k, entry in enumerate(entries) if np.max(np.abs(entry.high)) < ZERO]
            noise = [k for k in idle if np.any(found[name][k] != 0)]
            assert not noise, (output, name, noise)
