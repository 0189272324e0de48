"""What is said of motion in the plane: how the plane lies, or that there is one."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from codegen.spec.plane import in_plane, planar_normal
from codegen.spec.scene import Scene


def motion_notes(scene: Scene) -> list[str]:
    """Say in sentences how a scene moves, as far as a plane has to do with it."""
    if scene.motion == "planar":
        return _of_plane(scene)
    normal = planar_normal(scene)
    if normal is None:
        return []
    return [
        f"The mechanism moves in a plane across {_vector(normal)}:",
        'with motion = "planar" in its file the routines are those of the plane, which are much smaller.',
    ]


def _of_plane(scene: Scene) -> list[str]:
    found = in_plane(scene)
    x, y, normal = found.world
    notes = [f"x and y of the plane are {_vector(x)} and {_vector(y)} of the file, its normal is {_vector(normal)}."]
    if any(found.heights.values()):
        notes.append("Distances along the normal are left out: they do not change the motion.")
    if found.gravity:
        notes.append(f"So is gravity along it, {float(found.gravity):g} m/s^2.")
    notes.append("In the report on rows every body counts with the 3 rows that hold it in the plane.")
    return notes


def _vector(vector: Sequence[Fraction]) -> str:
    return f"({', '.join(f'{float(x):g}' for x in vector)})"
