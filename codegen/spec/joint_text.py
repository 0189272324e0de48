"""Which of its two forms the geometry of a joint takes in a scene file.

By points and axes in the axes of both bodies, where the frames that are laid on these axes serve; else by world vectors
at t = 0, where both frames are in one place: a rigid or translational joint, or one that something acts on, needs the
frames of both bodies to agree about the axis too.
"""

from __future__ import annotations

from fractions import Fraction

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import quoted
from codegen.spec.placement import IDENTITY, frame, rotation, times, transposed
from codegen.spec.pose import plus
from codegen.spec.scene import ZERO_VECTOR, Joint, Marker, Matrix, Scene, Vector

_SAME = Fraction(1, 10**12)
"""Directions and, in m, points with a smaller difference are one."""


def joint_entries(joint: Joint, scene: Scene) -> dict[str, object]:
    """Points and axes of a joint, by their keys in a scene file.

    Args:
        joint: the joint.
        scene: the scene it is in.

    Raises:
        SpecificationError: the directions of its coordinates matter, and neither form gives them.
    """
    i, j = joint.marker_i, joint.marker_j
    h_i, second = transposed(i.axes)[2], transposed(j.axes)[0 if joint.type == "universal" else 2]
    if _is_free_about_axis(joint) or (
        joint.type != "universal" and _alike(frame(h_i), i.axes) and _alike(frame(second), j.axes)
    ):
        axes = {} if joint.type == "ball" and not joint.needs_coordinates else {"axes": (h_i, second)}
        return {"points": (i.point, j.point), **axes}
    here, there = (_in_world(marker, name, scene) for marker, name in zip((i, j), joint.bodies, strict=True))
    f, _, h = here[1]
    axes_of_bodies = [axis for name in joint.bodies for axis in transposed(_pose(name, scene)[1])]
    laid = transposed(frame(h, axes_of_bodies))
    meet = _alike([here[0]], [there[0]]) and _alike(here[1], there[1])
    if not meet or (_needs_f(joint) and not _alike(laid, here[1])):
        what = "acts on coordinates whose directions a scene file cannot give"
        remedy = "lay them along axes of the bodies, or take out what acts on them"
        raise SpecificationError([Mistake(f"joint {quoted(joint.name)}", what, remedy)])
    return {"point": here[0], "axis": h, **({"axis2": f} if joint.type == "universal" else {})}


def _is_free_about_axis(joint: Joint) -> bool:
    """Whether it does not matter how the joint frames lie about the axis."""
    if joint.type in ("ball", "planar", "universal"):
        return not joint.needs_coordinates
    counted = (coordinate.stiffness or coordinate.drive or coordinate.limit for coordinate in joint.coordinates)
    return joint.type in ("revolute", "cylindrical") and not any(counted)


def _needs_f(joint: Joint) -> bool:
    """Whether the world form must lay f where it is."""
    return joint.type in ("ball", "planar") and joint.needs_coordinates


def _pose(name: str, scene: Scene) -> tuple[Vector, Matrix]:
    body = scene.body(name)
    return (ZERO_VECTOR, IDENTITY) if body is None else (body.position, rotation(body.quaternion))


def _in_world(marker: Marker, name: str, scene: Scene) -> tuple[Vector, Matrix]:
    """Origin and the axes f, g, h as rows of a joint frame at t = 0."""
    position, attitude = _pose(name, scene)
    f, g, h = (times(attitude, axis) for axis in transposed(marker.axes))
    return plus(position, times(attitude, marker.point)), (f, g, h)


def _alike(a: Matrix | list[Vector], b: Matrix | list[Vector]) -> bool:
    return all(abs(x - y) < _SAME for u, v in zip(a, b, strict=True) for x, y in zip(u, v, strict=True))
