"""From where a mechanism is looked at first: along the normal of its plane, or from above and aside in space."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from codegen.spec.plane import in_plane, planar_normal
from codegen.spec.scene import Scene

Array = NDArray[np.float64]

_AZIMUTH, _ELEVATION = math.radians(-60), math.radians(25)


def first_view(scene: Scene) -> Array:
    """Give the view: rows right, up and towards the reader, [3, 3], unit vectors, world.

    Gravity points down where there is any; else z is up, in the plane of x and y y.
    """
    normal = in_plane(scene).world[2] if scene.motion == "planar" else planar_normal(scene)
    gravity = np.array(scene.gravity, dtype=np.float64)
    candidates = [-gravity, *np.eye(3)[::-1]]
    if normal is not None:
        out = np.array(normal, dtype=np.float64)
        up = _first_across([-gravity, *np.eye(3)[[2, 1, 0]]], out)
    else:
        above = next(c for c in candidates if np.any(c))
        above = above / np.linalg.norm(above)
        aside = _first_across(list(np.eye(3)), above)
        level = math.cos(_AZIMUTH) * aside + math.sin(_AZIMUTH) * np.cross(above, aside)
        out = math.cos(_ELEVATION) * level + math.sin(_ELEVATION) * above
        up = _first_across([above], out)
    return np.stack([np.cross(up, out), up, out])


def _first_across(candidates: list[Array], out: Array) -> Array:
    """The first direction that is not along a unit vector, without its part along it."""
    for candidate in candidates:
        across = candidate - (candidate @ out) * out
        size = float(np.linalg.norm(across))
        if size > 0.1 * float(np.linalg.norm(candidate)):
            return across / size
    raise AssertionError("three axes are not all along one direction")
