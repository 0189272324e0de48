"""What the stages of a joint's program can be at most, by their names: tighter than what intervals know.

A stage is named after what it is (``h_j_in_i``, ``f_i_dot_h_j``, ``A_ij``): the length of a vector is the same in all
axes, a product of rotations is one. The ranges hold for rotations; `codegen.measure.bounds` adds what roundings do.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from codegen.ir.program import Program
from codegen.measure.pose_domain import LARGEST_PITCH, LARGEST_START, MOST_TURNS, PoseDomain
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

_VECTOR = re.compile(r"^(.+?)_(?:in_(?:i|j|star|joint_i|joint_j)|world)$")
_UNIT = re.compile(r"^[fgh]_(?:i|j|star)$")
_ROTATION = re.compile(r"^(?:A_(?:ij|ji|joint_i_j|joint_i_world|joint_j_i|star_j)|H_\d\d)$")
_SWING = "h_i_dot_f_j"
"""Zero where a conventional screw joint is closed."""


def named_range(name: str, joint: JointType, variant: Variant, domain: PoseDomain) -> float | None:
    """Give the largest magnitude of an entry of a stage; None where its name does not tell.

    Args:
        name: of the stage.
        joint: its type.
        variant: form and rows.
        domain: of the inputs.
    """
    if variant.rows == "quaternion" and ("star" in name or name.startswith("H_")):
        return None
    if _ROTATION.match(name):
        return 1.0
    if name == _SWING and joint.is_screw and variant.form == "conventional":
        return math.sin(_turn(domain))
    lengths = _lengths(joint, domain)
    if "_dot_" in name:
        return _product(name.split("_dot_"), lengths)
    vector = _VECTOR.match(name)
    return _product(vector[1].split("_cross_"), lengths) if vector else None


def nearest_to_axis(domain: PoseDomain) -> float:
    """Least length of the part of ``f_j`` across ``h_i`` where a screw joint is closed but for the misfit."""
    return math.cos(_turn(domain))


def _turn(domain: PoseDomain) -> float:
    return math.sqrt(3) * domain.misfit


def _product(names: list[str], lengths: Mapping[str, float]) -> float | None:
    known = [1.0 if _UNIT.match(name) else lengths.get(name) for name in names]
    return math.prod(length for length in known if length is not None) if None not in known else None


def offset_length(joint: JointType, domain: PoseDomain) -> float:
    """Largest distance of the joint's two origins where it is closed."""
    if joint.is_screw:
        return LARGEST_PITCH * (domain.angle + 2 * math.pi * MOST_TURNS + LARGEST_START)
    return math.sqrt(joint.translations) * domain.d


def gap_length(joint: JointType, domain: PoseDomain) -> float:
    """Largest distance of the joint's two origins."""
    return offset_length(joint, domain) + math.sqrt(3) * domain.misfit + 2 * math.sin(_turn(domain) / 2) * domain.s


def _lengths(joint: JointType, domain: PoseDomain) -> dict[str, float]:
    """Largest lengths of vectors that are no axes."""
    root, gap = math.sqrt(3), gap_length(joint, domain)
    return {
        "s_i": domain.s,
        "s_j": domain.s,
        "omega_i": root * domain.velocity,
        "omega_j": root * domain.velocity,
        "v_i": root * domain.velocity,
        "v_j": root * domain.velocity,
        "lambda_0_1_2": root * domain.multiplier,
        "d_ij": gap,
        "e_ij": gap + domain.s,
        "r_ij": gap + 2 * domain.s,
    }


def ranges(program: Program, joint: JointType, variant: Variant, domain: PoseDomain) -> dict[int, float]:
    """Position of a value -> its largest magnitude on rotations, where a name tells."""
    found = {}
    for position, instruction in enumerate(program.instructions):
        if instruction.label is not None:
            largest = named_range(instruction.label[0], joint, variant, domain)
            if largest is not None:
                found[position] = largest
    return found
