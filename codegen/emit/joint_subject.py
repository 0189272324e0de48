"""A joint in one variant as the subject of routines: its arguments and outputs in the words of the C ABI."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit.routine import Member, Preparation, Words
from codegen.ir.looped import Looped
from codegen.ir.program import Argument, Program, Result
from codegen.spec.joints import JointType
from codegen.spec.request import BRANCH, PREPARE, Variant

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

_BRIEF: dict[str, str] = {
    "phi": "Constraint phi",
    "phi_q": "Jacobian phi_q of the constraint by the virtual displacements",
    "phi_q_t_lambda_q": "Second derivative d(phi_q^T lambda)/dq by the same virtual displacements (not symmetric)",
    "gamma": "Right-hand side gamma of phi_q a = gamma at acceleration level",
    "phi_q_v": "Product phi_q v, without forming phi_q",
    "phi_q_t_lambda": "Product phi_q^T lambda, without forming phi_q",
    "branch": "Branch of the joint: 1 where it is closed as it was meant, negative where on another branch",
    "all": "All quantities at once, sub-expressions shared",
    "prepare": "What the routines of this variant need of the geometry, to be computed once",
}

BRANCH_WORDS = (
    "Where phi is 0 a negative value says that axes meant to be parallel are antiparallel, or that the joint is half a "
    "turn off: start again from another pose. Rows table4 also hold at -alpha; there it is less than 1."
)

_ACCELERATION = (
    "a holds the classical accelerations: rddot of each body, in the axes of its delta r, and the rate of the "
    "components of omega; alphaddot last."
)

_OUTPUT_WORDS: dict[str, tuple[str, str]] = {
    "phi": ("constraint rows", "m or 1"),
    "phi_q": ("constraint rows x virtual displacements", "1, m, 1/rad"),
    "phi_q_t_lambda_q": ("virtual displacements x virtual displacements", "N/m, N, N m"),
    "gamma": ("constraint rows", "m/s^2 or 1/s^2"),
    "phi_q_v": ("constraint rows", "m/s or 1/s"),
    "phi_q_t_lambda": ("virtual displacements", "N, N m"),
    "branch": ("cosine of the angle that the joint is off", "1"),
}


@dataclass(frozen=True, slots=True)
class JointSubject:
    """A joint in one variant.

    Attributes:
        joint: its type.
        variant: form and options.
    """

    joint: JointType
    variant: Variant

    @property
    def stem(self) -> str:
        """Start of the symbols."""
        return self.variant.stem

    def routine_stem(self, output: str) -> str:
        """The symbol of a routine without its storage ending."""
        return self.variant.routine_stem(output)

    def part(self, kind: int) -> JointSubject:
        """A joint has one kind of instances: itself."""
        return self

    def argument(self, argument: Argument) -> Words:
        """Axes, unit and parts of an argument."""
        name = argument.name
        if name in _BODY_ARGUMENTS:
            return Words(*_BODY_ARGUMENTS[name])
        if name == "alpha":
            return Words("joint", self._alpha_unit())
        if name == "geometry":
            return Words("body", "mixed", geometry_members(self.joint))
        if name == "velocity":
            return Words(axes(self.variant), "m/s, rad/s", self._velocity(argument))
        return Words("constraint rows", "N, N m")

    def output(self, output: Result) -> Words:
        """Axes and unit of an output."""
        frame, unit = _OUTPUT_WORDS.get(output.name, ("partial derivatives by the entries of an argument", "mixed"))
        return Words(frame if output.name in ("phi", "branch") else f"{frame}; {axes(self.variant)}", unit)

    def brief(self, output: str) -> str:
        """What a routine does, in a line."""
        return f"{_BRIEF[output]}: {self.joint.name} joint, {self.variant.form} form."

    def details(self, output: str, program: Program | Looped, preparation: Preparation | None) -> Sequence[str]:
        """What a user must know besides, sentence by sentence."""
        if output == PREPARE:
            return ["Call it again when the geometry changes."]
        if output == BRANCH:
            return [BRANCH_WORDS]
        details = [f"Virtual displacements: {axes(self.variant)}."]
        details.append(
            "phi takes A_i and A_j as they are, derivatives take them as rotations."
            if self.variant.matrices == "raw"
            else "A_i and A_j are taken as rotations."
        )
        if self.variant.rows is not None:
            details.append(f"Rows of the rotational constraint: {self.variant.rows}.")
        if self.variant.derivative == "substituted":
            details += _substituted(self.variant)
        if any(output.name == "gamma" for output in program.outputs):
            details.append(_ACCELERATION)
        if preparation:
            details.append(f"Prepared by {preparation.symbol}, operations once: {preparation.counts}.")
        return details

    def record(self) -> dict[str, Any]:
        """What the manifest says of the joint."""
        variant = self.variant
        return {
            "joint": variant.joint,
            "form": variant.form,
            "rows": variant.rows,
            "derivative": variant.derivative,
            "variation": variant.variation,
            "geometry": variant.geometry,
            "matrices": variant.matrices,
        }

    def _velocity(self, argument: Argument) -> _Members:
        turning = "body axes" if self.variant.variation == "body" else "world axes"
        moving = "body axes (A^T rdot)" if self.variant.translations == "body" else "world axes"
        members: _Members = (
            ("v_i", 0, (3, 1), f"velocity of body i, {moving}, m/s"),
            ("omega_i", 3, (3, 1), f"angular velocity of body i, {turning}, rad/s"),
            ("v_j", 6, (3, 1), f"velocity of body j, {moving}, m/s"),
            ("omega_j", 9, (3, 1), f"angular velocity of body j, {turning}, rad/s"),
        )
        count = argument.length - 12
        return (*members, ("alphadot", 12, (count, 1), "rates of alpha, m/s or rad/s")) if count else members

    def _alpha_unit(self) -> str:
        if self.joint.is_screw:
            return "rad"
        turning = ["1"] * 4 if self.variant.rows == "quaternion" else ["rad"] * self.joint.rotations
        return ", ".join(["m"] * self.joint.translations + turning)


def geometry_members(joint: JointType) -> _Members:
    """Parts of ``geometry``."""
    extra = tuple((name, 24 + k, (1, 1), unit) for k, (name, unit) in enumerate(joint.parameters))
    return GEOMETRY_MEMBERS + extra


def axes(variant: Variant) -> str:
    """Axes of virtual displacements and velocities, in words."""
    turning = "body" if variant.variation == "body" else "world"
    return f"translations in {variant.translations} axes, rotations in {turning} axes"


def _substituted(variant: Variant) -> list[str]:
    words = [
        "The angle varies as on the manifold."
        if variant.form == "conventional"
        else "The joint relation is inserted before differentiation: exact on tangent directions only."
    ]
    if variant.rows == "quaternion":
        words.append("It takes e.e = 1: off the unit sphere the derivative along e is that of the simplified form.")
    return words
