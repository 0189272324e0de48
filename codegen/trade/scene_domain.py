"""The joints of a scene as requests of their own: types, and the lengths of the mechanism."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

from codegen.measure.pose_domain import PoseDomain
from codegen.spec.scene import Scene


def scene_joints(scene: Scene) -> tuple[str, ...]:
    """The types of a scene's joints, each once."""
    return tuple(dict.fromkeys(joint.type for joint in scene.joints))


def scene_domain(scene: Scene) -> PoseDomain:
    """Positions and attachment points as far as those of the scene at t = 0; all else as in the standard domain."""
    points = [marker.point for joint in scene.joints for marker in (joint.marker_i, joint.marker_j)]
    arm = max((_length(point) for point in points), default=0.0) or 1.0
    place = max((float(abs(entry)) for body in scene.bodies for entry in body.position), default=0.0)
    return replace(PoseDomain(), s=arm, d=arm, r=place)


def _length(vector: tuple[Fraction, ...]) -> float:
    return math.sqrt(sum(entry * entry for entry in vector))
