"""Semi-regular hexagons: the family of designs whose home poses have a closed form (S3, SPEC S3.1).

Three pairs of joints on a circle of the base, three on a circle of the platform; turning both patterns does not matter,
only the angle delta between the two ends of a leg does.
"""

from __future__ import annotations

import numpy as np

from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.platforms.attitudes import Array
from codegen.platforms.programs import program
from codegen.spec.placement import IDENTITY
from codegen.spec.platform import LEGS, Platform, PlatformPose, WantedIndices
from codegen.spec.scene import ZERO_VECTOR


def joints(radius: Array, angles: Array) -> Array:
    """Points [3, 6, designs] on circles of some radii [designs], at some angles [6, designs]."""
    return np.array([radius * np.cos(angles), radius * np.sin(angles), 0 * angles])


def hexagons(top: Array, delta: Array, apart: float = 0.6) -> tuple[Array, Array]:
    """Joints [3, 6, designs] on a base of radius 1 and on platforms of radius ``top``.

    Args:
        top: [designs] radius of the platform.
        delta: [designs] angle between the ends of each leg, rad.
        apart: angle between the joints of a pair on the base, rad.
    """
    sides = np.array([-1.0, 1.0] * 3)[:, None]
    pairs = np.repeat(np.arange(3), 2)[:, None] * (2 * np.pi / 3)
    base = pairs + sides * apart / 2
    return joints(np.ones_like(top), base + 0 * delta), joints(top, base + sides * delta)


def conditions(base: Array, top: Array, height: Array) -> Array:
    """C [4, designs] of sigma, beta, alpha and gamma at home, of designs [3, 6, designs] at some heights [designs]."""
    points = tuple(IDENTITY[k % 3] for k in range(LEGS))
    anything = Platform("hexagon", points, points, PlatformPose(ZERO_VECTOR, IDENTITY), (), WantedIndices())
    found = program(anything, ("C",), is_symbolic=True)
    nothing, one = np.zeros_like(height), np.ones_like(height)
    inputs = {
        "o": [nothing, nothing, height],
        "R": [one if k % 4 == 0 else nothing for k in range(9)],
        "base": [base[i, leg] for leg in range(LEGS) for i in range(3)],
        "platform": [top[i, leg] for leg in range(LEGS) for i in range(3)],
    }
    with np.errstate(all="ignore"):
        return np.array(evaluate(found, inputs, numpy_domain())["C"])
