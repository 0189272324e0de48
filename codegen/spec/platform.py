"""A six-legged platform as data, as `codegen.spec.platform_file` reads it.

Numbers are exact, and lengths are in m: the unit of the file is folded in when it is read, so that no routine ever
multiplies by it.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from codegen.spec.scene import Matrix, Vector

LEGS = 6

UNITS: dict[str, Fraction] = {
    "km": Fraction(1000),
    "m": Fraction(1),
    "dm": Fraction(1, 10),
    "cm": Fraction(1, 100),
    "mm": Fraction(1, 1000),
    "um": Fraction(1, 10**6),
    "nm": Fraction(1, 10**9),
    "in": Fraction(254, 10**4),
    "ft": Fraction(3048, 10**4),
}
"""Units of length by name, in m."""

AXES_OF_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ")

EULER_ORDERS = (*AXES_OF_ORDERS, *(order.lower() for order in AXES_OF_ORDERS))
"""Euler orders: capital letters turn about axes of the platform, one after the other, small ones about axes of the
base; ``ZYX`` is yaw, pitch and roll."""

ATTITUDES = ("matrix", "quaternion", *EULER_ORDERS)
"""How a routine takes the attitude."""

QUANTITIES = (
    "lengths",
    "J",
    "D",
    "C",
    "values",
    "semi_axes",
    "ellipsoids",
    "Q1",
    "Q2",
    "w_of_v",
    "v_of_w",
    "det",
    "limits",
    "dD",
    "dC",
    "status",
)
"""What a platform may ask for; `codegen.mechanics.velocity` says what each is."""

VARIANTS: dict[str, tuple[str, ...]] = {
    "robust": QUANTITIES,
    "balanced": QUANTITIES,
    "fast": ("lengths", "J", "D", "C", "values", "semi_axes", "det"),
    "values": ("lengths", "J", "D", "det"),
    "smooth": ("lengths", "J", "D", "C", "det"),
    "literal": ("lengths", "J", "D", "C", "values", "semi_axes", "det"),
}
"""Ways to evaluate, with the quantities that each offers; ``literal`` is the paper's, for comparison only."""

DEFAULT_QUANTITIES = ("lengths", "D", "C", "det", "status")
"""What is generated of a platform that asks for nothing, as far as the variant offers it."""


@dataclass(frozen=True, slots=True)
class PlatformPose:
    """Where the platform is.

    Attributes:
        position: [3] m, its origin in base axes.
        rotation: [3, 3] rows, platform to base.
    """

    position: Vector
    rotation: Matrix


@dataclass(frozen=True, slots=True)
class WantedIndices:
    """What is generated of a platform.

    Attributes:
        quantities: of `QUANTITIES`; empty for `DEFAULT_QUANTITIES`.
        variant: of `VARIANTS`.
        attitude: of `ATTITUDES`.
        fma: whether products and sums are fused.
    """

    quantities: tuple[str, ...] = ()
    variant: str = "robust"
    attitude: str = "matrix"
    fma: bool = False

    @property
    def offered(self) -> tuple[str, ...]:
        """The quantities to evaluate, in the order of `QUANTITIES`."""
        asked = self.quantities or tuple(name for name in DEFAULT_QUANTITIES if name in VARIANTS[self.variant])
        return tuple(name for name in QUANTITIES if name in asked)


@dataclass(frozen=True, slots=True)
class Platform:
    """A platform on six legs.

    Attributes:
        name: of the routines; a C identifier.
        base: [6] points B_i in m, base axes.
        joints: [6] points p'_i in m, platform axes.
        home: the pose that pictures and grids start from.
        poses: further ones.
        wanted: what is generated.
    """

    name: str
    base: tuple[Vector, ...]
    joints: tuple[Vector, ...]
    home: PlatformPose
    poses: tuple[PlatformPose, ...] = ()
    wanted: WantedIndices = WantedIndices()
