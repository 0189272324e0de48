"""Count the routines of the library for the catalogue and for the comparison with the paper's tables.

Input: the catalogue. Output: documents of numbers (:mod:`flopcount.compare`); every count is of a program of
:mod:`codegen.build`.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from codegen.build import Progress
from codegen.cache import kept
from codegen.counted import Counted, counted
from codegen.ir.lower import SymbolicOutput
from codegen.mechanics.formulation import coordinate_count
from codegen.mechanics.joints import BASIC, JOINTS
from codegen.mechanics.left_out import conventional_quantities, parametric_quantities
from codegen.models import Model, model
from codegen.parallel import parallel
from codegen.spec.request import QUANTITIES, VARIATIONS, Variant
from codegen.spec.selection import library_variants
from flopcount.compare import Document, table_2, table_7
from flopcount.counts import Counts
from flopcount.models import MODELS, Operations
from flopcount.models import Model as Prices
from flopcount.paper import DERIVATIVES, Derivative


def counted_variants() -> tuple[Variant, ...]:
    """The variants whose operations the tables compare: the library, and the basic constraints alone."""
    library = (variant for joint in JOINTS.values() for variant in library_variants(joint))
    basic = (
        Variant(joint.name, "conventional", None, "exact", axes) for joint in BASIC.values() for axes in VARIATIONS
    )
    return (*library, *basic)


def tables(
    progress: Progress = lambda _: None,
    models: Mapping[str, Prices] = MODELS,
    known: Mapping[Variant, Counted] | None = None,
) -> dict[str, Document]:
    """Count the derivatives of every joint and basic constraint and compare them with the paper's Tables 2 and 7.

    Args:
        progress: told each variant as it is counted.
        models: how to price the operations.
        known: what is counted already.
    """
    found = dict(known or {})
    new = [variant for variant in counted_variants() if variant not in found]
    found |= zip(new, parallel(_derivatives, new, lambda variant: progress(variant.file_stem)), strict=True)
    emitted: dict[tuple[str, Derivative], dict[str, Operations]] = {}
    per_step: dict[tuple[str, Derivative], dict[str, int]] = {}
    for variant in counted_variants():
        column = variant.stem.removeprefix(f"jg_{variant.joint}_")
        for derivative, (number, left) in found[variant].items():
            emitted.setdefault((variant.joint, derivative), {})[column] = number
            per_step.setdefault((variant.joint, derivative), {})[column] = left
    of_joints = {key: kinds for key, kinds in emitted.items() if key[0] in JOINTS}
    of_basic = {(name, d): emitted[joint.name, d] for name, joint in BASIC.items() for d in DERIVATIVES}
    left_out = dict(zip(JOINTS, parallel(left_out_operations, list(JOINTS), lambda _: None), strict=True))
    return {"table2": table_2(of_basic, models), "table7": table_7(of_joints, left_out, models, per_step)}


def _derivatives(variant: Variant) -> Counted:
    symbolic = model(variant)
    return counted({derivative: symbolic.program([derivative]) for derivative in DERIVATIVES})


def left_out_operations(joint: str) -> dict[str, Operations]:
    """Count what the paper takes as given: on the conventional side, and on the parametric side for this joint."""
    return kept(("left out", joint), lambda: _left_out_operations(joint))


def _left_out_operations(joint: str) -> dict[str, Operations]:
    conventional = model(Variant(joint, "conventional", None))
    counted = {name: _operations(conventional, outputs) for name, outputs in conventional_quantities().items()}
    parametric = model(Variant(joint, "parametric", "regular"))
    for name, outputs in parametric_quantities(parametric.form).items():
        counted[name] = _operations(parametric, outputs, is_substituted=True)
    both, value = counted.pop("with derivatives"), counted["A_ij(alpha)"]
    counted["dA_ij/dalpha"] = _difference(both, value)
    return counted


def _operations(symbolic: Model, outputs: tuple[SymbolicOutput, ...], is_substituted: bool = False) -> Operations:
    return Operations.of(symbolic.lowered(outputs, is_substituted))


def _difference(whole: Operations, part: Operations) -> Operations:
    """What a program does beyond another that it contains."""
    kinds = part.counts.as_dict()
    rest = {kind: number - kinds[kind] for kind, number in whole.counts.as_dict().items()}
    return Operations(Counts.of(rest), whole.contractions - part.contractions)


def catalogue_size() -> int:
    """Number of steps of `catalogue`."""
    return 2 * len(JOINTS)


def catalogue(progress: Progress = lambda _: None) -> list[dict[str, Any]]:
    """Describe every joint: forms, degrees of freedom, rows, coordinates, operations of all quantities at once."""
    chosen = [
        variant
        for name in JOINTS
        for variant in (Variant(name, "conventional", None), Variant(name, "parametric", "regular"))
    ]
    counted = parallel(_all_quantities, chosen, lambda variant: progress(variant.file_stem))
    totals = {(variant.joint, variant.form): number for variant, number in zip(chosen, counted, strict=True)}
    return [
        {
            "joint": joint.name,
            "forms": ["conventional", "parametric"],
            "dof": joint.dof,
            "conventional_rows": joint.conventional_rows,
            "parametric_rows": 6,
            "coordinates": coordinate_count(joint, "regular"),
            "constraints": f"trn{joint.translations} + rot{joint.rotations}",
            "operations_conventional": totals[joint.name, "conventional"],
            "operations_parametric": totals[joint.name, "parametric"],
        }
        for joint in JOINTS.values()
    ]


def _all_quantities(variant: Variant) -> int:
    return Operations.of(model(variant).program(QUANTITIES)).counts.total
