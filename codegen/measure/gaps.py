"""How far joints are open, and whether one is turned over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from codegen.measure.constraints import ConstraintSystem, JointConstraint, Pose

_ALIGNED = ("revolute", "translational", "screw", "cylindrical", "planar", "rigid")
"""Joints whose axes h on both bodies point the same way; their rows are met too where they point opposite ways."""

_FIXED = ("translational", "rigid")
"""Joints of which all axes point the same way."""


@dataclass(frozen=True, slots=True)
class Gap:
    """How far a joint is open: ``length`` in m, ``angle`` in rad."""

    joint: str
    length: float
    angle: float

    def __str__(self) -> str:
        return f'joint "{self.joint}": open by {1e3 * self.length:.4g} mm and {np.degrees(self.angle):.4g} degrees'


def gaps(system: ConstraintSystem, pose: Pose) -> tuple[Gap, ...]:
    """Measure how far each joint is open; a joint that is turned over by half a turn is open by that angle."""
    phi = system.phi(pose)
    over = turned_over(system, pose)
    found = []
    for joint, rows in zip(system.joints, system.row_ranges(), strict=True):
        own = phi[rows.start : rows.stop]
        is_length = np.array([row.unit == "m" for row in joint.rows], dtype=bool)
        sine = min(1.0, float(np.linalg.norm(own[~is_length])))
        angle = float(np.arcsin(sine))
        length = float(np.linalg.norm(own[is_length]))
        found.append(Gap(joint.name, length, np.pi - angle if joint.name in over else angle))
    return tuple(found)


def turned_over(system: ConstraintSystem, pose: Pose) -> tuple[str, ...]:
    """Name the joints whose axes point opposite ways: a spurious root of their rows."""
    return tuple(joint.name for joint in system.joints if _is_turned_over(joint, pose))


def _is_turned_over(joint: JointConstraint, pose: Pose) -> bool:
    axes = [pose.body(body)[1] @ frame.C for body, frame in zip(joint.bodies, joint.frames, strict=True)]
    cosines = np.sum(axes[0] * axes[1], axis=0)
    return bool(joint.type in _ALIGNED and cosines[2] < 0) or bool(joint.type in _FIXED and min(cosines) < 0)
