"""The parameters of a routine: shapes, layouts, frames and units, in the words of the C ABI."""

from __future__ import annotations

from codegen.emit.routine import Member, Parameter
from codegen.ir.program import Argument, Output, Program
from codegen.spec.joints import JointType
from codegen.spec.request import Variant

_Members = tuple[Member, ...]

_BODY_ARGUMENTS: dict[str, tuple[str, str]] = {
    "r_i": ("world", "m"),
    "A_i": ("body i to world", "1"),
    "r_j": ("world", "m"),
    "A_j": ("body j to world", "1"),
}

GEOMETRY_MEMBERS: _Members = (
    ("s_i", 0, (3, 1), "attachment point, body frame i, m"),
    ("C_i", 3, (3, 3), "joint frame [f g h], body frame i"),
    ("s_j", 12, (3, 1), "attachment point, body frame j, m"),
    ("C_j", 15, (3, 3), "joint frame [f g h], body frame j"),
)


def parameters(
    joint: JointType, variant: Variant, program: Program, dense: bool, prepared: _Members = ()
) -> tuple[Parameter, ...]:
    """Describe the parameters of a routine, in the order of its signature.

    Args:
        joint: for the joint parameters.
        variant: for the axes of velocities and virtual displacements.
        program: for the arguments it uses and the patterns of its outputs.
        dense: whether matrix outputs are stored dense.
        prepared: parts of the argument or output ``prepared``.
    """
    inputs = tuple(_input(argument, joint, variant, prepared) for argument in program.used_arguments())
    return inputs + tuple(_output(output, variant, dense, prepared) for output in program.outputs)


def _input(argument: Argument, joint: JointType, variant: Variant, prepared: _Members) -> Parameter:
    name = argument.name
    members: _Members = ()
    if name in _BODY_ARGUMENTS:
        frame, unit = _BODY_ARGUMENTS[name]
    elif name == "alpha":
        frame, unit = "joint", _alpha_unit(joint, variant)
    elif name == "geometry":
        frame, unit, members = "body", "mixed", geometry_members(joint)
    elif name == "prepared":
        frame, unit, members = "body", "mixed", prepared
    elif name == "velocity":
        frame, unit, members = axes(variant), "m/s, rad/s", _velocity(argument, variant)
    else:
        frame, unit = "constraint rows", "N, N m"
    layout = "column-major"
    return Parameter(name, "in", argument.shape, argument.length, layout, frame, unit, members)


def geometry_members(joint: JointType) -> _Members:
    """Parts of ``geometry``."""
    extra = tuple((name, 24 + k, (1, 1), unit) for k, (name, unit) in enumerate(joint.parameters))
    return GEOMETRY_MEMBERS + extra


def _velocity(argument: Argument, variant: Variant) -> _Members:
    turning = "body axes" if variant.variation == "body" else "world axes"
    moving = "body axes (A^T rdot)" if variant.translations == "body" else "world axes"
    members: _Members = (
        ("v_i", 0, (3, 1), f"velocity of body i, {moving}, m/s"),
        ("omega_i", 3, (3, 1), f"angular velocity of body i, {turning}, rad/s"),
        ("v_j", 6, (3, 1), f"velocity of body j, {moving}, m/s"),
        ("omega_j", 9, (3, 1), f"angular velocity of body j, {turning}, rad/s"),
    )
    count = argument.length - 12
    return (*members, ("alphadot", 12, (count, 1), "rates of alpha, m/s or rad/s")) if count else members


def axes(variant: Variant) -> str:
    """Axes of virtual displacements and velocities, in words."""
    turning = "body" if variant.variation == "body" else "world"
    return f"translations in {variant.translations} axes, rotations in {turning} axes"


def _alpha_unit(joint: JointType, variant: Variant) -> str:
    if joint.is_screw:
        return "rad"
    turning = ["1"] * 4 if variant.rows == "quaternion" else ["rad"] * joint.rotations
    return ", ".join(["m"] * joint.translations + turning)


def _output(output: Output, variant: Variant, dense: bool, prepared: _Members) -> Parameter:
    pattern = output.sparsity
    if output.name == "prepared":
        shape = (pattern.nrow, 1)
        return Parameter(output.name, "out", shape, pattern.nrow, "column-major", "body", "mixed", prepared)
    is_matrix = pattern.ncol > 1
    frame, unit = _OUTPUT_WORDS.get(output.name, ("partial derivatives by the entries of an argument", "mixed"))
    if output.name != "phi":
        frame = f"{frame}; {axes(variant)}"
    stored_dense = dense or not is_matrix
    length = pattern.nrow * pattern.ncol if stored_dense else pattern.nonzeros
    layout = "column-major" if stored_dense else "compressed-columns"
    return Parameter(output.name, "out", (pattern.nrow, pattern.ncol), length, layout, frame, unit)


_OUTPUT_WORDS: dict[str, tuple[str, str]] = {
    "phi": ("constraint rows", "m or 1"),
    "phi_q": ("constraint rows x virtual displacements", "1, m, 1/rad"),
    "phi_q_t_lambda_q": ("virtual displacements x virtual displacements", "N/m, N, N m"),
    "gamma": ("constraint rows", "m/s^2 or 1/s^2"),
    "phi_q_v": ("constraint rows", "m/s or 1/s"),
    "phi_q_t_lambda": ("virtual displacements", "N, N m"),
}
