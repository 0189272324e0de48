"""A scene as numbers: its joints evaluate themselves with the library's own routines, so that rows can be judged.

In planar motion every body has three more rows that hold it in the plane; joints have the rows that are left there.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from codegen import models
from codegen.cache import kept
from codegen.ir.evaluate import evaluate
from codegen.ir.program import Program
from codegen.measure.constraints import Array, ConstraintSystem, Evaluate, Frame, JointConstraint, Pose, Row
from codegen.measure.row_names import conventional_rows, coordinate_units, parametric_rows
from codegen.mechanics.joints import JOINTS
from codegen.scenes.programs import estimate
from codegen.spec.markers import markers
from codegen.spec.placement import IDENTITY, rotation
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, ZERO_VECTOR, Joint, Marker, Matrix, Scene, Vector
from codegen.spec.scene_file.bodies import GROUND_POSE
from codegen.spec.scene_file.bodies import Pose as BodyPose
from codegen.spec.scene_file.gaps import closure

_QUANTITIES = ("phi", "phi_q")


def rows_of(variant: Variant) -> tuple[Row, ...]:
    """Name the rows of a joint in a form."""
    joint = JOINTS[variant.joint]
    return (
        conventional_rows(joint)
        if variant.form == "conventional"
        else parametric_rows(joint, variant.rows or "", variant.point)
    )


def constraint_system(
    scene: Scene, forms: Mapping[str, Variant], dropped: frozenset[int] = frozenset()
) -> ConstraintSystem:
    """Give the constraints of a scene as numbers.

    Args:
        scene: the mechanism.
        forms: joint name -> form and rows.
        dropped: rows of the joints, counted over all of them, that are left out beforehand.
    """
    numbers: dict[str, int | None] = {GROUND: None} | {body.name: k for k, body in enumerate(scene.bodies)}
    joints = [_in_plane(body.name, k) for k, body in enumerate(scene.bodies) if scene.motion == "planar"]
    first = 0
    for joint in scene.joints:
        variant = forms[joint.name]
        count = len(rows_of(variant))
        kept = [k for k in range(count) if first + k not in dropped]
        joints.append(_constraint(joint, variant, (numbers[joint.bodies[0]], numbers[joint.bodies[1]]), kept))
        first += count
    return ConstraintSystem(tuple(body.name for body in scene.bodies), tuple(joints))


def plane_rows(scene: Scene) -> int:
    """Number of rows that hold bodies in the plane; they come first."""
    return 3 * len(scene.bodies) if scene.motion == "planar" else 0


def initial_pose(scene: Scene, forms: Mapping[str, Variant]) -> Pose:
    """The pose at t = 0; joint coordinates have the values at which the joints are closed there, or least open."""
    poses = {GROUND: GROUND_POSE} | {b.name: BodyPose(b.position, rotation(b.quaternion)) for b in scene.bodies}
    alpha = [
        value
        for joint in scene.joints
        if coordinates(forms[joint.name])
        for value in closure(joint, (poses[joint.bodies[0]], poses[joint.bodies[1]])).coordinates
    ]
    attitudes = [_array(rotation(body.quaternion)) for body in scene.bodies]
    return Pose(
        np.array([[float(x) for x in body.position] for body in scene.bodies]).reshape(-1, 3),
        np.array(attitudes).reshape(-1, 3, 3),
        np.array(alpha),
    )


def coordinates(variant: Variant) -> tuple[str, ...]:
    """Units of the joint coordinates of a form."""
    return () if variant.form == "conventional" else coordinate_units(JOINTS[variant.joint], variant.rows or "")


def _constraint(
    joint: Joint, variant: Variant, bodies: tuple[int | None, int | None], kept: Sequence[int]
) -> JointConstraint:
    rows = rows_of(variant)
    return JointConstraint(
        joint.name,
        joint.type,
        bodies,
        tuple(rows[k] for k in kept),
        coordinates(variant),
        (_frame(joint.marker_i), _frame(joint.marker_j)),
        _evaluate(variant, geometry_of(joint, variant), kept),
        (float(joint.pitch),) if joint.type == "screw" else (),
    )


def geometry_of(joint: Joint, variant: Variant) -> list[float]:
    """The argument ``geometry`` of the library's routine of a joint."""
    constants = [float(x) for m in markers(joint, variant.form) for x in (*m.point, *_columns(m.axes))]
    return constants + ([float(joint.pitch), 0.0, 0.0] if joint.type == "screw" else [])


def _in_plane(name: str, body: int) -> JointConstraint:
    """The rows that hold a body in the plane of world x and y."""
    variant = Variant("planar", "conventional", None)
    origin = Marker(ZERO_VECTOR, IDENTITY)
    joint = Joint(f"plane of {name}", "planar", (GROUND, name), origin, origin)
    return _constraint(joint, variant, (None, body), range(3))


@cache
def constraint_program(variant: Variant) -> Program:
    """``phi`` and ``phi_q`` of a joint, lowered in a hurry: it is evaluated here and not emitted."""

    def lowered() -> Program:
        model = models.model(variant)
        return model.lowered(model.outputs(_QUANTITIES), choose=estimate)

    return kept(("constraint", variant), lowered)


def exact(variant: Variant) -> Variant:
    """The same rows with their own derivatives."""
    return replace(variant, derivative="exact")


def _evaluate(variant: Variant, constants: list[float], kept: Sequence[int]) -> Evaluate:
    """A joint routine; translations of the parametric form are turned from body axes to the world's."""
    rows = list(kept)

    def evaluated(r_i: Array, A_i: Array, r_j: Array, A_j: Array, alpha: Array) -> tuple[Array, Array]:
        program = constraint_program(exact(variant))
        arrays = {"r_i": r_i, "A_i": A_i.ravel(order="F"), "r_j": r_j, "A_j": A_j.ravel(order="F"), "alpha": alpha}
        values = evaluate(program, {name: array.tolist() for name, array in arrays.items()} | {"geometry": constants})
        phi_q = _dense(program, values["phi_q"])
        if variant.translations == "body":
            phi_q[:, :3] = phi_q[:, :3] @ A_i.T
            phi_q[:, 6:9] = phi_q[:, 6:9] @ A_j.T
        return np.array(values["phi"])[rows], phi_q[rows]

    return evaluated


def _dense(program: Program, values: Sequence[Any]) -> Array:
    pattern = program.output("phi_q").sparsity
    matrix = np.zeros((pattern.nrow, pattern.ncol))
    for (row, column), value in zip(pattern.entries(), values, strict=True):
        matrix[row, column] = value
    return matrix


def _frame(marker: Marker) -> Frame:
    return Frame(np.array([float(x) for x in marker.point]), _array(marker.axes))


def _array(matrix: Matrix) -> Array:
    return np.array([[float(x) for x in row] for row in matrix])


def _columns(matrix: Matrix) -> Vector:
    return tuple(row[k] for k in range(3) for row in matrix)  # type: ignore[return-value]
