"""Far from the origin, after many turns, with attitudes that are no rotations: digits of the routines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from codegen.measure.double_double import PI, DoubleDouble
from codegen.measure.errors import number_type
from codegen.measure.judge import block_errors, by_program, true_values
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.poses import Poses
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import Variant
from codegen.trade.extreme_table import (
    POSES,
    REALS,
    Cell,
    ExtremeTable,
    digits_of_given,
    digits_of_ideal,
    least_digits,
    poses_of,
    routine_of,
)
from codegen.trade.specimens import blocks_of

DISTANCES = tuple(10.0**k for k in (0, 3, 6, 9, 12))
DRIFTS = tuple(10.0**k for k in (-12, -10, -8, -6, -4, -2))
TURNS = (0, 1, 1000, 1_000_000)
_PARTS = 1e-3
"""Size of a joint far away, m."""

DISTANT = (
    (Variant("revolute", "conventional", None), "phi"),
    (Variant("revolute", "parametric", "regular"), "phi"),
    (Variant("cylindrical", "conventional", None), "phi"),
    (Variant("planar", "conventional", None), "phi"),
    (Variant("ball", "parametric", "regular"), "phi"),
    (Variant("planar", "conventional", None), "phi_q_t_lambda_q"),
    (Variant("planar", "conventional", None), "phi_q_v"),
    (Variant("screw", "conventional", None), "phi_q_v"),
    (Variant("cylindrical", "parametric", "regular"), "phi_q_v"),
    (Variant("translational", "conventional", None, variation="world"), "phi_q_v"),
    (Variant("translational", "conventional", None, variation="world"), "gamma"),
)
ANGLED = (
    Variant("revolute", "parametric", "regular"),
    Variant("universal", "parametric", "regular"),
    Variant("revolute", "parametric", "table4"),
)
DRIFTING = (
    *(
        (Variant(name, form, rows), ("phi", "phi_q", "phi_q_t_lambda_q", "gamma"))
        for name in JOINTS
        for form, rows in (("conventional", None), ("parametric", "regular"))
    ),
    (Variant("revolute", "conventional", None, matrices="raw"), ("phi",)),
)


def distances() -> ExtremeTable:
    """Body origins far away, with parts of a millimetre."""
    rows: list[tuple[Cell, ...]] = []
    for variant, output in DISTANT:
        routine = routine_of(variant, output)
        for distance in DISTANCES:
            domain = PoseDomain(r=_PARTS, s=_PARTS, d=_PARTS, misfit=_PARTS, distance=distance)
            poses = poses_of(routine, domain)
            near = _relative(poses)
            cells = [digits_of_given(routine, poses, domain, real) for real in REALS]
            cells += [digits_of_ideal(routine, one, domain, "double") for one in (poses, near)]
            rows.append((routine.symbol, f"{distance:.0e} m", *cells))
    return ExtremeTable(
        "distance",
        "Digits of joints with parts of 1 mm, bodies far from the origin",
        ("routine", "distance", "double, given", "float, given", "double, ideal", "double, ideal, relative position"),
        tuple(rows),
        (
            "Given: against the exact value at the rounded inputs. Ideal: against geometry before rounding.",
            "Relative position: r_j - r_i is given for r_j, and 0 for r_i. Every sum begins with r_j - r_i.",
        ),
    )


def _relative(poses: Poses) -> Poses:
    moved = [r_j - r_i for r_j, r_i in zip(poses.ideal["r_j"], poses.ideal["r_i"], strict=True)]
    nothing = [DoubleDouble.of(np.zeros(POSES)) for _ in range(3)]
    return Poses(poses.ideal | {"r_j": moved, "r_i": nothing})


def angles() -> ExtremeTable:
    """Joint angles near 0, near half a turn, and after many turns."""
    rows: list[tuple[Cell, ...]] = []
    for variant in ANGLED:
        for output in ("phi", "phi_q"):
            routine = routine_of(variant, output)
            for name, angle in _ANGLES.items():
                domain = PoseDomain()
                poses = _with_angle(poses_of(routine, domain), angle)
                rows.append((routine.symbol, name, *(digits_of_given(routine, poses, domain, real) for real in REALS)))
    return ExtremeTable(
        "angle",
        "Digits at extreme angles, against the given angle",
        ("routine", "angle", "double", "float"),
        tuple(rows),
    )


_ANGLES: dict[str, Fraction] = {
    "1e-300": Fraction(1, 10**300),
    "1e-8": Fraction(1, 10**8),
    "pi - 1e-8": PI - Fraction(1, 10**8),
    "-pi": -PI,
    "1e6 turns + 1": 2 * PI * 10**6 + 1,
    "-1e6 turns - 1": -2 * PI * 10**6 - 1,
}


def _with_angle(poses: Poses, angle: Fraction) -> Poses:
    """Set all angles; the pose is off the constraint then, which does not matter to digits against the given angle."""
    value = DoubleDouble.exact(angle)
    ones = DoubleDouble.of(np.ones(POSES))
    return Poses(poses.ideal | {"alpha": [value * ones for _ in poses.ideal["alpha"]]})


def turns() -> ExtremeTable:
    """A screw after many turns: the angle as one number, or as revolutions and the angle within a turn."""
    routine = routine_of(Variant("screw", "parametric", "regular"), "phi")
    domain = PoseDomain()
    poses = poses_of(routine, domain)
    rows: list[tuple[Cell, ...]] = []
    for count in TURNS:
        ideal = poses.ideal | {
            "geometry": [*poses.ideal["geometry"][:26], DoubleDouble.of(np.full(POSES, float(count)))]
        }
        turned = poses.ideal["alpha"][0] + DoubleDouble.exact(2 * PI * count)
        zeros = DoubleDouble.of(np.zeros(POSES))
        one = Poses(ideal | {"alpha": [turned], "geometry": [*ideal["geometry"][:26], zeros]})
        scale = replace(domain, d=max(1.0, 2.0 * count))
        cells = [
            least_digits(routine, way.given(number_type(real)), ideal, scale)
            for way in (one, Poses(ideal))
            for real in REALS
        ]
        rows.append((f"{count}", *cells))
    return ExtremeTable(
        "turns",
        "Digits of phi of a screw joint after many turns, against ideal geometry",
        ("turns", "double, one angle", "float, one angle", "double, turns and angle", "float, turns and angle"),
        tuple(rows),
        ("Lengths are measured by the travel, some 0.3 m/rad times the angle; rotation rows by 1.",),
    )


def drifts(routines: Sequence[tuple[Variant, tuple[str, ...]]] = DRIFTING) -> ExtremeTable:
    """Attitudes that are no rotations: the effect on each block, in units of the drift."""
    rows: list[tuple[Cell, ...]] = []
    for variant, outputs in routines:
        for output in outputs:
            routine = routine_of(variant, output)
            judged = blocks_of(routine)
            effects = [_effect(variant, output, drift) for drift in DRIFTS]
            for k, block in enumerate(judged):
                rows.append((routine.symbol, block.name, *(found[k] for found in effects)))
    return ExtremeTable(
        "drift",
        "Effect of attitudes that are off a rotation, over the drift",
        ("routine", "block", *(f"{drift:.0e}" for drift in DRIFTS)),
        tuple(rows),
        (
            "A_i and A_j with each entry off by up to the drift; values against those of the rotation, over scale and",
            "drift. The routine orthonormalise takes the drift away.",
        ),
    )


def _effect(variant: Variant, output: str, drift: float) -> list[float]:
    routine = routine_of(variant, output)
    domain = PoseDomain(drift=drift)
    poses = poses_of(routine, domain)
    program, judged = routine.straight, blocks_of(routine)
    found = by_program(program)(poses.given(np.float64))
    errors = block_errors(found, true_values(program, poses.ideal), judged, POSES)
    scales = [domain.scale(block.output, block.is_rotation) for block in judged]
    return [float(np.max(error)) / scale / drift for error, scale in zip(errors, scales, strict=True)]
