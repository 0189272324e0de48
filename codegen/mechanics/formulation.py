"""`Formulation`: the rows of a joint's constraint and everything that is needed to derive from them.

The conventional form follows S1 section 2, the parametric form section 3. The variation decides the axes in which
vectors are kept: in ``body`` variation relative quantities (``A_ij``, ``d'_ij = A_i^T d_ij``), in ``world``
variation world vectors.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import sympy

from codegen.ir.lower import Tilde
from codegen.mechanics import frames, mixed
from codegen.mechanics.algebra import Algebra
from codegen.mechanics.basic import (
    SCREW_PARTIALS,
    axis_i,
    constraint,
    screw_stages,
    theta,
    theta_axis,
    theta_variation,
)
from codegen.mechanics.branch import conventional_branch, parametric_branch
from codegen.mechanics.frames import A_i, A_ij, A_j, C_i, C_j, H, d_ij, dp_ij, e_ij, ep_ij, r_i, r_ij, r_j, s_i, s_j
from codegen.mechanics.terms import Factors, unit
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

_AXES = "fgh"


@dataclass(frozen=True)
class Formulation:
    """A constraint ready to be differentiated.

    Attributes:
        algebra: normal form in force.
        stages: named intermediates and their definitions.
        aliases: names of products for readers only.
        rows: scalars and [3] vectors, in row order.
        displacements: virtual displacement symbols with the column each starts at.
        virtual: variation of the root symbols under the displacements.
        rates: variation of the root symbols under the velocity.
        velocities: velocity symbols, one for each displacement.
        velocity_rates: rate of a velocity symbol at zero acceleration, where its axes turn.
        partials: known partial derivatives of scalar stages.
        substitution: what the joint relation makes of ``A_ij`` and ``d'_ij`` (derivative ``substituted``), else empty.
        reduction: stages that derivatives express by others, where they meet terms that cancel.
        coordinates: number of alphas.
        branch: positive where the joint is closed as it was meant, see `codegen.mechanics.branch`.
    """

    algebra: Algebra
    stages: dict[Any, Any]
    aliases: dict[Factors, str]
    rows: tuple[Any, ...]
    displacements: tuple[tuple[Any, int], ...]
    virtual: dict[Any, Any]
    rates: dict[Any, Any]
    velocities: tuple[Any, ...]
    velocity_rates: dict[Any, Any] = field(default_factory=dict)
    partials: dict[Any, dict[Any, Any]] = field(default_factory=dict)
    substitution: dict[Any, Any] = field(default_factory=dict)
    reduction: dict[Any, Any] = field(default_factory=dict)
    coordinates: int = 0
    branch: Any = sympy.S.One

    @property
    def row_count(self) -> int:
        """Number of scalar rows."""
        return sum(height(row) for row in self.rows)

    @property
    def column_count(self) -> int:
        """Length of the variation vector."""
        return 12 + self.coordinates


def height(row: Any) -> int:
    """Scalar rows of an entry of ``Formulation.rows``."""
    return 3 if isinstance(row, sympy.matrices.expressions.matexpr.MatrixExpr) else 1


def formulation(joint: JointType, variant: Variant, translations: str | None = None) -> Formulation:
    """Formulate a joint in the form and with the options of a variant.

    Args:
        joint: its type.
        variant: form and options.
        translations: axes of the virtual translations, ``world`` or ``body``; those of the variant if left out.
    """
    axes = translations or variant.translations
    return _conventional(joint, variant, axes) if variant.form == "conventional" else _parametric(joint, variant, axes)


RELATIVE_REDUCTION = {dp_ij: sympy.MatAdd(ep_ij, sympy.MatMul(-1, s_i))}
"""``d'_ij + s_i = e'_ij``: for derivatives, since it takes ``A_i^T A_i = I``."""


TOGETHER = (r_ij,)
"""``r_j - r_i`` as one vector: no product takes a position alone, which would lose digits far from the origin."""

APART = (r_j, sympy.MatMul(-1, r_i))
"""``r_j - r_i`` as a sum: in the parametric form virtual translations are in body axes, and products take d' whole."""


def relative_algebra(difference: tuple[Any, ...]) -> tuple[Algebra, dict[Any, Any], dict[Factors, str]]:
    """Vectors in the axes of body i: ``A_ij = A_i^T A_j`` and ``d'_ij = A_i^T d_ij`` are named.

    Args:
        difference: terms of ``r_j - r_i``: `TOGETHER` or `APART`.
    """
    r_j_part, *r_i_part = difference
    stages = {
        A_ij: sympy.MatMul(sympy.Transpose(A_i), A_j),
        e_ij: sympy.MatAdd(r_j_part, sympy.MatMul(A_j, s_j), *r_i_part),
        d_ij: sympy.MatAdd(e_ij, sympy.MatMul(-1, A_i, s_i)),
        dp_ij: sympy.MatMul(sympy.Transpose(A_i), d_ij),
        ep_ij: sympy.MatMul(sympy.Transpose(A_i), e_ij),
    }
    names: dict[Factors, Any] = {
        (sympy.Transpose(A_i), A_j): A_ij,
        (sympy.Transpose(A_j), A_i): sympy.Transpose(A_ij),
        (sympy.Transpose(A_i), d_ij): dp_ij,
        (sympy.Transpose(A_i), e_ij): ep_ij,
    }
    aliases: dict[Factors, str] = {(C_i, unit(k)): f"{_AXES[k]}_i" for k in range(3)}
    aliases |= {(C_j, unit(k)): f"{_AXES[k]}_j" for k in range(3)}
    aliases |= {(C_i, H, unit(k)): f"{_AXES[k]}_star" for k in range(3)}
    aliases |= {(C_i, H, sympy.Transpose(C_j)): A_ij.name, (sympy.Transpose(A_i), A_j): A_ij.name}
    aliases |= {(sympy.Transpose(A_i), d_ij): dp_ij.name, (sympy.Transpose(A_i), e_ij): ep_ij.name}
    rotations = frozenset({A_i, A_j, A_ij, C_i, C_j, H})
    algebra = Algebra(rotations, names, pulled=frozenset({A_i}), flipped=frozenset({A_ij}))
    return algebra, stages, aliases


def world_algebra() -> tuple[Algebra, dict[Any, Any], dict[Factors, str]]:
    """Vectors in world axes: the axes of the joint frames and the attachments are named."""
    stages: dict[Any, Any] = {}
    names: dict[Factors, Any] = {}
    for A, C, body in ((A_i, C_i, "i"), (A_j, C_j, "j")):
        for k, axis in enumerate(_AXES):
            names[A, C, unit(k)] = frames.vector(f"{axis}_{body}")
    attachments = {(A_i, s_i): frames.vector("s_i_world"), (A_j, s_j): frames.vector("s_j_world")}
    names |= attachments
    stages |= {symbol: sympy.MatMul(*chain) for chain, symbol in names.items()}
    s_i_world, s_j_world = attachments.values()
    stages[e_ij] = sympy.MatAdd(r_ij, s_j_world)
    stages[d_ij] = sympy.MatAdd(e_ij, sympy.MatMul(-1, s_i_world))
    aliases = {chain: symbol.name for chain, symbol in names.items()}
    return Algebra(frozenset({A_i, A_j, C_i, C_j}), names), stages, aliases


def _world_reduction(stages: dict[Any, Any]) -> dict[Any, Any]:
    """``d_ij + s_i = e_ij`` in world axes."""
    return {d_ij: stages[d_ij]}


def _conventional(joint: JointType, variant: Variant, translations: str) -> Formulation:
    algebra, stages, aliases = relative_algebra(TOGETHER) if variant.variation == "body" else world_algebra()
    virtual = _body_motion(frames.BODY_DISPLACEMENTS, variant.variation, translations)
    rates = _body_motion(frames.BODY_VELOCITIES, variant.variation, translations)
    if joint.is_screw:
        in_body = variant.variation == "body"
        stages |= screw_stages(algebra, A_i if in_body else None)
        exact = sympy.MatMul(A_i, theta_axis) if in_body else theta_axis
        axis = axis_i("h") if variant.derivative == "substituted" else exact
        turns = (frames.delta_pi_i, frames.delta_pi_j), (frames.omega_i, frames.omega_j)
        for motion, (turn_i, turn_j) in zip((virtual, rates), turns, strict=True):
            motion[theta] = theta_variation(axis, _relative_turn(turn_i, turn_j, variant.variation), algebra)
    return Formulation(
        algebra,
        stages,
        aliases,
        tuple(constraint(kind, algebra) for kind in joint.conventional),
        _displacements(0),
        virtual,
        rates,
        frames.BODY_VELOCITIES,
        _turning_axes() if translations == "body" else {},
        partials=SCREW_PARTIALS if joint.is_screw else {},
        reduction=RELATIVE_REDUCTION if variant.variation == "body" else _world_reduction(stages),
        branch=conventional_branch(joint.conventional, algebra),
    )


def _relative_turn(turn_i: Any, turn_j: Any, variation: str) -> Any:
    if variation == "world":
        return sympy.MatAdd(turn_j, sympy.MatMul(-1, turn_i))
    return sympy.MatAdd(sympy.MatMul(A_j, turn_j), sympy.MatMul(-1, A_i, turn_i))


def _body_motion(bodies: tuple[Any, ...], variation: str, translations: str) -> dict[Any, Any]:
    """Variation of positions and rotations (SPEC S0).

    Args:
        bodies: translation and rotation of body i, then of body j.
        variation: axes of the rotations.
        translations: axes of the translations; in ``body`` axes ``delta r = A delta r'``.
    """
    move_i, turn_i, move_j, turn_j = bodies
    motion: dict[Any, Any] = {r_i: move_i, r_j: move_j}
    if translations == "body":
        motion = {r_i: sympy.MatMul(A_i, move_i), r_j: sympy.MatMul(A_j, move_j)}
    motion[r_ij] = sympy.MatAdd(motion[r_j], sympy.MatMul(-1, motion[r_i]))
    for A, turn in ((A_i, turn_i), (A_j, turn_j)):
        motion[A] = sympy.MatMul(A, Tilde(turn)) if variation == "body" else sympy.MatMul(Tilde(turn), A)
    return motion


def _displacements(coordinates: int) -> tuple[tuple[Any, int], ...]:
    bodies = tuple((symbol, 3 * k) for k, symbol in enumerate(frames.BODY_DISPLACEMENTS))
    return bodies + tuple((symbol, 12 + k) for k, symbol in enumerate(frames.delta_alpha(coordinates)))


def coordinate_count(joint: JointType, rows: str | None) -> int:
    """Number of alphas of a joint in the parametric form."""
    if joint.is_screw:
        return 1
    return joint.translations + (4 if rows == "quaternion" else joint.rotations)


def _parametric(joint: JointType, variant: Variant, translations: str) -> Formulation:
    algebra, stages, aliases = relative_algebra(APART)
    count = coordinate_count(joint, variant.rows)
    algebra = replace(algebra, displacements=frozenset((*frames.delta_alpha(count), *frames.alpha_dot(count))))
    alphas = frames.alpha(count)
    turning = alphas if joint.is_screw else alphas[joint.translations :]
    if variant.rows == "quaternion":
        rotation = mixed.quaternion_rotation(turning)
    else:
        rotation = mixed.euler_rotation(mixed.ROTATION_AXES[joint.rotations], turning)
    stages[H] = rotation.definition
    if joint.is_screw:
        stages[mixed.advance] = mixed.screw_advance(alphas[0])
    d_of_alpha = mixed.translation(joint.translations, alphas, joint.is_screw)
    is_in_world = variant.point == "world" and not joint.translations
    rows = (
        d_ij if is_in_world else mixed.translational_rows(d_of_alpha),
        *mixed.rotational_rows(variant.rows or "regular", joint.rotations, rotation, algebra),
    )
    substituted = variant.derivative == "substituted"
    rotation_of_alpha = (
        sympy.MatMul(C_i, H, sympy.Transpose(C_j)) if joint.rotations else sympy.MatMul(C_i, sympy.Transpose(C_j))
    )
    return Formulation(
        algebra,
        stages,
        aliases,
        rows,
        _displacements(count),
        _body_motion(frames.BODY_DISPLACEMENTS, variant.variation, translations)
        | _joint_motion(frames.delta_alpha(count), alphas, rotation),
        _body_motion(frames.BODY_VELOCITIES, variant.variation, translations)
        | _joint_motion(frames.alpha_dot(count), alphas, rotation),
        (*frames.BODY_VELOCITIES, *frames.alpha_dot(count)),
        _turning_axes() if translations == "body" else {},
        substitution={A_ij: rotation_of_alpha, dp_ij: d_of_alpha} if substituted else {},
        reduction=RELATIVE_REDUCTION,
        coordinates=count,
        branch=parametric_branch(joint.rotations, algebra),
    )


def _joint_motion(
    changes: tuple[Any, ...], alphas: tuple[Any, ...], rotation: mixed.RelativeRotation
) -> dict[Any, Any]:
    """Variation of the joint coordinates and of H."""
    motion: dict[Any, Any] = dict(zip(alphas, changes, strict=True))
    turns = [
        sympy.MatMul(motion[coordinate], rate)
        for coordinate, rate in zip(rotation.coordinates, rotation.rates, strict=True)
    ]
    if turns:
        motion[H] = sympy.MatAdd(*turns) if len(turns) > 1 else turns[0]
    return motion


def _turning_axes() -> dict[Any, Any]:
    """Rate of ``A^T rdot`` at ``rddot = 0``: its axes turn with the body."""
    v_i, omega_i, v_j, omega_j = frames.BODY_VELOCITIES
    return {v_i: sympy.MatMul(-1, Tilde(omega_i), v_i), v_j: sympy.MatMul(-1, Tilde(omega_j), v_j)}
