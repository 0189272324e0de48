"""Doxygen comments: shapes, frames, units, equations and counts of every function."""

from __future__ import annotations

import textwrap

from codegen.emit.c import Entry
from codegen.emit.parameters import axes
from codegen.emit.routine import Parameter, Routine
from codegen.spec.request import PREPARE

_WIDTH = 112

_BRIEF: dict[str, str] = {
    "phi": "Constraint phi",
    "phi_q": "Jacobian phi_q of the constraint by the virtual displacements",
    "phi_q_t_lambda_q": "Second derivative d(phi_q^T lambda)/dq by the same virtual displacements (not symmetric)",
    "gamma": "Right-hand side gamma of phi_q a = gamma at acceleration level",
    "phi_q_v": "Product phi_q v, without forming phi_q",
    "phi_q_t_lambda": "Product phi_q^T lambda, without forming phi_q",
    "all": "All quantities at once, sub-expressions shared",
    "prepare": "What the routines of this variant need of the geometry, to be computed once",
}

_ACCELERATION = (
    "a holds the classical accelerations: rddot of each body, in the axes of its delta r, and the rate of the "
    "components of omega; alphaddot last."
)


def comment(entry: Entry) -> list[str]:
    """Write the comment of one function as lines."""
    routine = entry.routine
    variant = routine.variant
    lines = _wrapped(f"@brief {_BRIEF[routine.output]}: {routine.joint.name} joint, {variant.form} form.")
    lines += ["", *_wrapped(" ".join(_details(routine)))]
    lines += [line for parameter in entry.parameters for line in _parameter(parameter)]
    lines += [f"@note Operations: {routine.counts}; temporaries: {entry.temporaries}."]
    lines += _wrapped(f"@see {routine.equations}")
    return lines


def _details(routine: Routine) -> list[str]:
    variant = routine.variant
    if routine.output == PREPARE:
        return ["Call it again when the geometry changes."]
    details = [f"Virtual displacements: {axes(variant)}."]
    details.append(
        "phi takes A_i and A_j as they are, derivatives take them as rotations."
        if variant.matrices == "raw"
        else "A_i and A_j are taken as rotations."
    )
    if variant.rows is not None:
        details.append(f"Rows of the rotational constraint: {variant.rows}.")
    if variant.derivative == "substituted":
        details.append(
            "The angle varies as on the manifold."
            if variant.form == "conventional"
            else "The joint relation is inserted before differentiation: exact on tangent directions only."
        )
        if variant.rows == "quaternion":
            details.append(
                "It takes e.e = 1: off the unit sphere the derivative along e is that of the simplified form."
            )
    if any(output.name == "gamma" for output in routine.program.outputs):
        details.append(_ACCELERATION)
    if routine.preparation:
        details.append(f"Prepared by {routine.preparation.symbol}, operations once: {routine.preparation.counts}.")
    return details


def _parameter(parameter: Parameter) -> list[str]:
    rows, columns = parameter.shape
    shape = f"[{rows}]" if columns == 1 else f"[{rows} x {columns}] {parameter.layout}"
    stored = f", {parameter.length} nonzeros" if parameter.layout == "compressed-columns" else ""
    lines = _wrapped(
        f"@param[{parameter.direction}] {parameter.name} {shape}{stored}; {parameter.frame}; {parameter.unit}"
    )
    for name, offset, (nrow, ncol), meaning in parameter.members:
        size = f"[{nrow}]" if ncol == 1 else f"[{nrow} x {ncol}]"
        lines += _wrapped(f"  [{offset}] {name} {size} {meaning}")
    return lines


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
