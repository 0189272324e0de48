"""Finite motions along a variation vector, and central differences that know their own error.

Written apart from `tests.reference` and from the generator: closed form of the exponential map, floats only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from codegen.spec.request import Variant

from .cases import Values, largest

REACH = 4  # points on each side
EIGHTH_ORDER = {
    1: (0.0, 4 / 5, -1 / 5, 4 / 105, -1 / 280),
    2: (-205 / 72, 8 / 5, -1 / 5, 8 / 315, -1 / 560),
}
SIXTH_ORDER = {
    1: (0.0, 3 / 4, -3 / 20, 1 / 60, 0.0),
    2: (-49 / 18, 3 / 2, -3 / 20, 1 / 90, 0.0),
}
"""Weights of the points 0, 1, ..., 4 steps ahead, for the first and the second derivative; behind, with the sign."""


@dataclass(frozen=True)
class Difference:
    """A derivative by differences.

    Attributes:
        value: by the formula of eighth order.
        doubt: bound on its error: its distance from the formula of sixth order, and rounding.
    """

    value: Values
    doubt: float


def difference(function: Callable[[float], Values], step: float, order: int = 1) -> Difference:
    """Derivative of a function of one variable at 0 by central differences on nine points.

    Args:
        function: t -> array.
        step: between points.
        order: 1 or 2.
    """
    points = {k: np.asarray(function(k * step)) for k in range(-REACH, REACH + 1) if k or order == 2}
    size = max(largest(values) for values in points.values())
    better, worse = (_combined(points, weights[order], order) / step**order for weights in (EIGHTH_ORDER, SIXTH_ORDER))
    rounding = 8 * np.finfo(float).eps * size * 2 * sum(map(abs, EIGHTH_ORDER[order])) / step**order
    return Difference(better, largest(better - worse) + rounding)


def _combined(points: dict[int, Values], weights: tuple[float, ...], order: int) -> Values:
    behind = -1 if order == 1 else 1
    total = weights[0] * points[0] if order == 2 else 0.0
    for k in range(REACH, 0, -1):
        total = total + weights[k] * (points[k] + behind * points[-k])
    return np.asarray(total)


def rotation(w: Values) -> Values:
    """Rotation [3, 3] by the rotation vector w [3], rad (Rodrigues)."""
    angle = float(np.linalg.norm(w))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = w / angle
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * K + 2 * np.sin(angle / 2) ** 2 * (K @ K)


def translates_in_body_axes(variant: Variant) -> bool:
    """Whether delta r stands for delta r' = A^T delta r (SPEC S1.0): parametric, body variation."""
    return variant.form == "parametric" and variant.variation == "body"


def moved(variant: Variant, inputs: dict[str, Any], q: Values) -> dict[str, Any]:
    """Inputs with the pose moved by a finite q [n], components as in the variation vector at the pose."""
    there = dict(inputs)
    for body, part in (("i", q[0:6]), ("j", q[6:12])):
        A = inputs[f"A_{body}"]
        turn = rotation(part[3:])
        there[f"A_{body}"] = turn @ A if variant.variation == "world" else A @ turn
        there[f"r_{body}"] = inputs[f"r_{body}"] + (A @ part[:3] if translates_in_body_axes(variant) else part[:3])
    if "alpha" in inputs:
        there["alpha"] = inputs["alpha"] + q[12:]
    return there


def coasted(variant: Variant, inputs: dict[str, Any], t: float) -> dict[str, Any]:
    """Inputs after a time t of motion at rddot = 0 (world), omegadot = 0, alphaddot = 0; the velocity as it then is."""
    velocity = inputs["velocity"]
    there = moved(variant, inputs, t * velocity)
    if translates_in_body_axes(variant):
        there["velocity"] = velocity.copy()
        for body, part in (("i", slice(0, 3)), ("j", slice(6, 9))):
            there["velocity"][part] = there[f"A_{body}"].T @ (inputs[f"A_{body}"] @ velocity[part])
    return there
