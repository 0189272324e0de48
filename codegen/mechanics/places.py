"""Which frames a formulation has, and in which of them its symbols, rows and virtual displacements are written.

Frames: ``world``, bodies ``i`` and ``j``, their joint frames ``joint i`` and ``joint j``, and in the exact parametric
form ``star``, the joint frame on body i turned by H(alpha). In the substituted form H joins the two joint frames.
"""

from __future__ import annotations

from typing import Any

import sympy

from codegen.ir.lower.places import Places
from codegen.mechanics import frames
from codegen.mechanics.basic import across
from codegen.mechanics.formulation import Formulation
from codegen.mechanics.frames import A_i, A_ij, A_j, C_i, C_j, H, d_ij, dp_ij, e_ij, ep_ij, r_i, r_ij, r_j, s_i, s_j
from codegen.spec.request import Variant

WORLD, BODY_I, BODY_J, JOINT_I, JOINT_J, STAR = "world", "i", "j", "joint i", "joint j", "star"

_AXES = {
    JOINT_I: ("f_i", "g_i", "h_i"),
    JOINT_J: ("f_j", "g_j", "h_j"),
    STAR: ("f_star", "g_star", "h_star"),
}


def displacement_frames(variant: Variant, translations: str | None = None) -> tuple[str, str, str, str]:
    """Frames of ``delta r_i``, ``delta pi_i``, ``delta r_j``, ``delta pi_j`` and of the velocities."""
    in_body = (translations or variant.translations) == "body"
    moves = (BODY_I, BODY_J) if in_body else (WORLD, WORLD)
    turns = (WORLD, WORLD) if variant.variation == "world" else (BODY_I, BODY_J)
    return moves[0], turns[0], moves[1], turns[1]


def places(form: Formulation, variant: Variant, is_substituted: bool, translations: str | None = None) -> Places:
    """Describe the frames of a formulation.

    Args:
        form: rows and stages.
        variant: for the axes of displacements.
        is_substituted: whether the joint relation takes the place of the rotation matrices.
        translations: as in `codegen.mechanics.formulation.formulation`.
    """
    motion = displacement_frames(variant, translations)
    is_together = form.stages[e_ij].has(r_ij)
    positions = {r_ij: WORLD} if is_together else {r_i: WORLD, r_j: WORLD}
    homes: dict[Any, str] = positions | {s_i: BODY_I, s_j: BODY_J}
    homes |= dict(zip(frames.BODY_VELOCITIES, motion, strict=True))
    rotations = {A_i: (WORLD, BODY_I), A_j: (WORLD, BODY_J), A_ij: (BODY_I, BODY_J)}
    has_rotation = H in form.stages and not isinstance(form.stages[H], sympy.Identity)
    joint_j = JOINT_J
    turning: dict[Any, Any] = {}
    if has_rotation and (is_substituted or _is_rotation(form)):
        turning = {H: (JOINT_I, JOINT_J if is_substituted else STAR)}
    elif is_substituted and form.stages[H].is_Identity:
        joint_j = JOINT_I
    rotations |= {C_i: (BODY_I, JOINT_I), C_j: (BODY_J, joint_j)} | turning
    given = [A_i, C_i, C_j, *turning] if is_substituted else [A_i, A_j, C_i, C_j, *turning]
    bodies = {WORLD: WORLD, BODY_I: BODY_I, BODY_J: BODY_J, JOINT_I: BODY_I, JOINT_J: BODY_J, STAR: BODY_I}
    used = {frame for symbol in given for frame in rotations[symbol]}
    skipped = {dp_ij, ep_ij, A_ij} | ({H} if turning else set())
    stages = {symbol: definition for symbol, definition in form.stages.items() if symbol not in skipped}
    stages |= {symbol: form.stages[symbol].args[1] for symbol in (dp_ij, ep_ij) if symbol in form.stages}
    return Places(
        rotations=rotations,
        given=tuple(given),
        explicit={H: form.stages[H]} if turning else {},
        frames=homes,
        stages=stages,
        bodies={frame: body for frame, body in bodies.items() if frame in used},
        axes=frozenset({JOINT_I, JOINT_J, STAR}),
        columns=tuple((column, frame) for column, frame in zip((0, 3, 6, 9), motion, strict=True)),
        rows=_row_frames(form),
        axis_names={frame: names for frame, names in _AXES.items() if frame in used},
        whole=frozenset({across}),
        is_raw=variant.matrices == "raw",
        vector_names={symbol: symbol.name for symbol in (d_ij, e_ij) if symbol in form.stages},
        constants={r_ij: frames.column(r_j) - frames.column(r_i)} if is_together else {},
    )


def _is_rotation(form: Formulation) -> bool:
    """Whether H is orthonormal as a formula, as it is for angles but not for Euler parameters."""
    return not form.stages[H].has(sympy.Pow) and H in form.algebra.rotations


def _row_frames(form: Formulation) -> dict[int, str]:
    """Frame of each vector among the rows, by its first row."""
    found, start = {}, 0
    for row in form.rows:
        is_vector = isinstance(row, sympy.matrices.expressions.matexpr.MatrixExpr)
        if is_vector:
            found[start] = BODY_I if row.has(dp_ij) else WORLD
        start += 3 if is_vector else 1
    return found
