"""The box of inputs that holds every pose of a domain: what bounds are proved over."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from codegen.ir.program import Program
from codegen.measure.bounds import ARITHMETICS, Box
from codegen.measure.named_ranges import gap_length, nearest_to_axis, ranges
from codegen.measure.pose_domain import LARGEST_PITCH, LARGEST_START, LEAST_PITCH, MOST_TURNS, PoseDomain
from codegen.measure.poses import DIRECTION
from codegen.passes.given_trigonometry import SINES_COSINES
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

_Range = tuple[float, float]
_MARGIN = 1 + 1e-6
"""For inputs rounded to the number type."""


def pose_box(program: Program, joint: JointType, variant: Variant, domain: PoseDomain, real: str) -> Box:
    """Enclose the inputs of a domain.

    Args:
        program: of which the values with a name have ranges too.
        joint: its type.
        variant: form and rows.
        domain: bounds of the poses.
        real: number type of the inputs.
    """
    lengths = {argument.name: argument.length for argument in program.arguments}
    rotation = [_even(1 + domain.drift)] * 9
    arm = domain.s / math.sqrt(3)
    frame = [*[_even(arm)] * 3, *[_even(1.0)] * 9]
    screw = [(LEAST_PITCH, LARGEST_PITCH), _even(LARGEST_START), _even(MOST_TURNS)]
    inputs = {
        "r_i": _position(domain, 0.0),
        "A_i": rotation,
        "r_j": _position(domain, 2 * domain.s + gap_length(joint, domain)),
        "A_j": rotation,
        "alpha": _coordinates(joint, variant, domain),
        SINES_COSINES: [_even(1.0)] * lengths.get(SINES_COSINES, 0),
        "geometry": [*frame, *frame, *(screw if joint.is_screw else [])],
        "velocity": [_even(domain.velocity)] * lengths.get("velocity", 0),
        "lambda": [_even(domain.multiplier)] * lengths.get("lambda", 0),
    }
    unit = ARITHMETICS[real].unit
    attitudes = [(name, k) for name in ("A_i", "A_j") for k in range(9)]
    axes = [("geometry", start + k) for start in (3, 15) for k in range(9)]
    turns = [(SINES_COSINES, k) for k in range(lengths.get(SINES_COSINES, 0))]
    deviation = {place: unit + domain.drift for place in attitudes} | {place: unit for place in (*axes, *turns)}
    return Box(inputs, ranges(program, joint, variant, domain), deviation, nearest_to_axis(domain))


def neighbourhood(given: Mapping[str, NDArray[np.floating]], pose: int, width: float) -> Box:
    """Enclose the neighbourhood of one pose; nothing is taken for granted in it, not even rotations.

    Args:
        given: argument -> [length, poses].
        pose: its number.
        width: of the box in each entry, to either side.
    """
    return Box({name: [(float(x) - width, float(x) + width) for x in rows[:, pose]] for name, rows in given.items()})


def _even(bound: float) -> _Range:
    return -bound * _MARGIN, bound * _MARGIN


def _position(domain: PoseDomain, reach: float) -> list[_Range]:
    middles = [domain.distance * float(part) for part in DIRECTION]
    size = domain.r + reach
    return [(middle - (size + middle * 1e-6), middle + (size + middle * 1e-6)) for middle in middles]


def _coordinates(joint: JointType, variant: Variant, domain: PoseDomain) -> list[_Range]:
    """Ranges of alpha."""
    shifts = 0 if joint.is_screw else joint.translations
    if variant.rows == "quaternion":
        return [*[_even(domain.d + domain.misfit)] * shifts, *[_even(1 + domain.misfit)] * 4]
    angles = [domain.angle] * joint.rotations
    if joint.rotations == 3:
        angles[1] = domain.pitch_angle
    return [*[_even(domain.d + domain.misfit)] * shifts, *[_even(angle + domain.misfit) for angle in angles]]
