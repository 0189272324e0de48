"""Six platforms, of published dimensions that were read or of what they are by definition, and grids of poses."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from codegen.spec.placement import IDENTITY
from codegen.spec.platform import Platform, PlatformPose, WantedIndices


@dataclass(frozen=True, eq=False)
class Geometry:
    """Joints [3, 6] on the base and on the platform, in m, and the height of the home."""

    base: Any
    joints: Any
    height: float
    step: float

    def platform(self, variant: str = "robust", attitude: str = "matrix") -> Platform:
        """The platform of exactly these doubles; the same object each time."""
        return _platform(self, variant, attitude)

    def poses(self) -> Iterator[tuple[Any, Any]]:
        """A grid with the home in it: at ordinary poses of symmetric designs values are repeated."""
        for z, x in ((0, 0), (1, 0), (0, 1), (-1, 1)):
            for yaw, pitch in ((0, 0), (0.2, 0), (-0.4, 0.1), (0, 0.3)):
                o = np.array([x * self.step, 0.5 * x * self.step, self.height + z * self.step])
                yield o, Rotation.from_euler("ZYX", [yaw, pitch, -pitch / 2]).as_matrix()


@cache
def _platform(geometry: Geometry, variant: str, attitude: str) -> Platform:
    base, joints = (
        tuple(tuple(Fraction(float(x)) for x in point) for point in array.T)
        for array in (geometry.base, geometry.joints)
    )
    home = PlatformPose((Fraction(0), Fraction(0), Fraction(geometry.height)), IDENTITY)
    return Platform("test", base, joints, home, (), WantedIndices((), variant, attitude))  # type: ignore[arg-type]


def _circle(radius: float, degrees: list[float]) -> Any:
    angles = np.radians(degrees)
    return np.array([radius * np.cos(angles), radius * np.sin(angles), 0 * angles])


def _pairs(apart: float, first: float = 0.0) -> list[float]:
    return [first + 120 * k + side * apart / 2 for k in range(3) for side in (-1, 1)]


def _cubic(side: float = 0.110, first: float = 0.075, height: float = 0.040) -> Geometry:
    """Legs along the six middle edges of a cube that stands on a corner (Geng and Haynes 1994): at right angles.

    Dimensions of initializeCubicConfiguration.m of T. Dehaeze's stewart-simscape: side of the cube, height of the base
    joints over the corner, and of the platform joints over these.
    """
    corners = {name: np.array([int(c) for c in name], dtype=float) for name in map("{:03b}".format, range(8))}
    edges = [("001", "011"), ("010", "011"), ("010", "110"), ("100", "110"), ("100", "101"), ("001", "101")]
    upright = Rotation.align_vectors([[0, 0, 1.0]], [[1, 1, 1.0]])[0].as_matrix()
    low, high = (side * upright @ np.array([corners[edge[k]] for edge in edges]).T for k in (0, 1))
    base, joints = (low + (z - low[2]) / (high - low)[2] * (high - low) for z in (first, first + height))
    up = np.array([[0], [0], [1]])
    return Geometry(base - first * up, joints - (first + height) * up, height, 0.1 * height)


# Stewart platform of the industry examples of Wolfram SystemModeler, its axes z, x, y taken as x, y, z.
_WOLFRAM = (
    [[0.0388228567653781, 0.14488887394336, 0.106066017177982, -0.106066017177982, -0.14488887394336,
      -0.0388228567653781],
     [0.14488887394336, -0.0388228567653781, -0.106066017177982, -0.106066017177982, -0.0388228567653781,
      0.14488887394336], [0.0] * 6],
    [[0.0707106781186548, 0.0965925826289068, 0.0258819045102521, -0.0258819045102521, -0.0965925826289068,
      -0.0707106781186548],
     [0.0707106781186548, 0.0258819045102521, -0.0965925826289068, -0.0965925826289068, 0.0258819045102521,
      0.0707106781186548], [0.0] * 6],
)  # fmt: skip

# The default hexapod of LinuxCNC, src/emc/kinematics/genhexkins.h: base a triangle. A tenth of its units.
_LINUXCNC = (
    [[-2.295, 2.295, 2.295, 0, 0, -2.295], [1.325, 1.325, 1.325, -2.65, -2.65, 1.325], [0.0] * 6],
    [[-0.1, 0.1, 1.0459, 0.9459, -0.9459, -1.0459], [1.15, 1.15, -0.4884, -0.6616, -0.6616, -0.4884], [0.0] * 6],
)

# Dietmaier 1998: the platform with 40 real assemblies, as CuikSuite (Dietmeier.world) and Drake have it too.
_DIETMAIER = (
    [[0, 1.107915, 0.549094, 0.735077, 0.514188, 0.590473], [0, 0, 0.756063, -0.223935, -0.526063, 0.094733],
     [0, 0, 0, 0.525991, -0.368418, -0.205018]],
    [[0, 0.542805, 0.956919, 0.665885, 0.478359, -0.137087], [0, 0, -0.528915, -0.353482, 1.158742, -0.235121],
     [0, 0, 0, 1.402538, 0.107672, 0.353913]],
)  # fmt: skip

SEMI_REGULAR = Geometry(_circle(1.0, _pairs(30)), _circle(0.6, _pairs(80)), 0.9, 0.15)

GEOMETRIES = {
    "6-6, Wolfram": Geometry(np.array(_WOLFRAM[0]), np.array(_WOLFRAM[1]), 0.15, 0.015),
    "3-6, LinuxCNC": Geometry(np.array(_LINUXCNC[0]), np.array(_LINUXCNC[1]), 2.5, 0.3),
    # Lee, Duffy and Hunt 1998: base side twice the platform side, height equal to it. |det J| is greatest there.
    "3-3, octahedral optimum": Geometry(
        _circle(2 / np.sqrt(3), [-60, 60, 60, 180, 180, 300]),
        _circle(1 / np.sqrt(3), [0, 0, 120, 120, 240, 240]),
        1.0,
        0.1,
    ),
    "octahedral, regular": Geometry(
        _circle(1 / np.sqrt(3), [-60, 60, 60, 180, 180, 300]),
        _circle(1 / np.sqrt(3), [0, 0, 120, 120, 240, 240]),
        np.sqrt(2 / 3),
        0.05,
    ),
    "cubic": _cubic(),
    "general, Dietmaier": Geometry(np.array(_DIETMAIER[0], float), np.array(_DIETMAIER[1], float), 0.7, 0.2),
}  # fmt: skip
"""By name: the legs of joints that coincide meet in a point."""
