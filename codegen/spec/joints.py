"""A joint type as data: which basic constraints it is made of, in both forms.

The catalogue itself (:data:`codegen.mechanics.joints.JOINTS`) is a literal of these; a new joint is one more entry.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

Axis = Literal["f", "g", "h"]
"""An axis of a joint frame: first, second, third column of C."""


@dataclass(frozen=True, slots=True)
class Dot1:
    """``a_i . b_j``: an axis of the joint frame on body i perpendicular to one on body j."""

    axis_i: Axis
    axis_j: Axis


@dataclass(frozen=True, slots=True)
class Dot2:
    """``a_i . d_ij``: the joint's origins apart only perpendicular to an axis on body i."""

    axis_i: Axis


@dataclass(frozen=True, slots=True)
class Spherical:
    """``d_ij = 0``: the joint's origins coincide; three rows."""


@dataclass(frozen=True, slots=True)
class Screw:
    """``h_i . d_ij - p (theta + 2 pi n + theta_0)``: advance along the axis by the angle turned."""


BasicConstraint = Dot1 | Dot2 | Spherical | Screw


@dataclass(frozen=True, slots=True)
class JointType:
    """A joint type.

    Attributes:
        name: as in the C symbols.
        dof: degrees of freedom left between the two bodies.
        conventional: basic constraints in row order (S1 Table 1); empty where the joint exists in the parametric
            form only.
        translations: k of ``trn_k`` (S1 Table 5).
        rotations: k of ``rot_k`` (S1 Table 5).
        is_screw: the translation is the advance of the rotation; one coordinate for both.
        parameters: joint parameters at the end of ``geometry``, with their units.
    """

    name: str
    dof: int
    conventional: tuple[BasicConstraint, ...]
    translations: int
    rotations: int
    is_screw: bool = False
    parameters: tuple[tuple[str, str], ...] = field(default=())

    @property
    def conventional_rows(self) -> int:
        """Rows of the conventional constraint."""
        return sum(3 if isinstance(constraint, Spherical) else 1 for constraint in self.conventional)
