"""The joint frames that a form of a joint takes.

The conventional form of most joints takes the axes of the joint only: what is across them is then laid along axes of
the bodies, so that as many components as possible are 0 or 1.
"""

from __future__ import annotations

from codegen.spec.placement import IDENTITY, frame, transposed
from codegen.spec.scene import Joint, Marker, Vector

_BY_AXES = ("revolute", "cylindrical", "planar")
"""Joints whose conventional form takes any f and g across their axis, on each body for itself."""


def markers(joint: Joint, form: str) -> tuple[Marker, Marker]:
    """Joint frames on body i and body j as a form has them.

    Args:
        joint: of a scene.
        form: ``conventional`` or ``parametric``.
    """
    first, second = joint.marker_i, joint.marker_j
    if form == "conventional" and joint.type == "ball":
        return Marker(first.point, IDENTITY), Marker(second.point, IDENTITY)
    if form == "conventional" and joint.type == "universal":  # its cross is h_i, h_j here, and h_i, f_j in a scene
        return _about(first, transposed(first.axes)[2]), _about(second, transposed(second.axes)[0])
    if form == "conventional" and joint.type in _BY_AXES:
        return _about(first, transposed(first.axes)[2]), _about(second, transposed(second.axes)[2])
    return first, second


def _about(marker: Marker, third: Vector) -> Marker:
    return Marker(marker.point, frame(third))
