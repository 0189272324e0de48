"""The outputs of a joint as expressions of a tool, in each form in which the tool can be fed.

- ``phi``: the tool is given the constraint at a pose moved twice by virtual displacements, epsilon and then delta, and
  differentiates it itself: phi_q by delta at 0; the gradient of lambda . phi by delta at 0, and that by epsilon at 0.
- ``formulas``: the tool is given the closed formulas of S1.
- ``lambda first``: the same formulas with the axes of constraints of one kind added up, multiplied by their lambda.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from benchmarks.peers import formulas
from benchmarks.peers.constraint import Geometry, Pose, geometry_of, matrix, phi
from benchmarks.peers.linear import Matrix, Scalar, Vector, dot
from benchmarks.peers.work import OUTPUTS, Work

FORMS = ("phi", "formulas", "lambda first")


class Algebra(Protocol):
    """What a tool must be able to do with its scalars."""

    def vector(self, name: str, length: int) -> Vector:
        """Symbols of one argument or of virtual displacements."""

    def atan2(self, y: Scalar, x: Scalar) -> Scalar:
        """Angle of (x, y), rad."""

    def jacobian(self, values: Sequence[Scalar], symbols: Vector) -> Matrix:
        """Derivatives [values x symbols] by the tool's own means."""

    def gradient(self, value: Scalar, symbols: Vector) -> Vector:
        """Derivatives [symbols] of one value by the tool's own means."""

    def at_zero(self, values: Sequence[Scalar], symbols: Vector) -> Vector:
        """The values where the symbols are 0."""


def outputs(algebra: Algebra, work: Work, form: str) -> tuple[dict[str, Vector], dict[str, Vector]]:
    """Express a joint in a tool.

    Returns:
        Argument -> symbols, output -> expressions of its stored entries. An entry may be a Python number.
    """
    arguments = {name: algebra.vector(name, length) for name, length in work.arguments.items()}
    pose = Pose(arguments["r_i"], matrix(arguments["A_i"]), arguments["r_j"], matrix(arguments["A_j"]))
    geometry = geometry_of(arguments["geometry"])
    values = phi(work.joint, pose, geometry, algebra.atan2)
    if form == "phi":
        first, second = _differentiated(algebra, work.joint, pose, geometry, arguments["lambda"])
    else:
        closed = formulas.Closed(pose, geometry)
        first = formulas.phi_q(work.joint, closed)
        second = formulas.second(work.joint, closed, arguments["lambda"], form == "lambda first")
    dense = dict(zip(OUTPUTS, ([[value] for value in values], first, second), strict=True))
    stored = {name: [dense[name][row][column] for row, column in work.patterns[name].places] for name in OUTPUTS}
    return arguments, stored


def _differentiated(
    algebra: Algebra, joint: str, pose: Pose, geometry: Geometry, multipliers: Vector
) -> tuple[Matrix, Matrix]:
    delta, epsilon = algebra.vector("delta", 12), algebra.vector("epsilon", 12)
    once = phi(joint, pose.moved(delta), geometry, algebra.atan2)
    first = [algebra.at_zero(row, delta) for row in algebra.jacobian(once, delta)]
    twice = phi(joint, pose.moved(epsilon).moved(delta), geometry, algebra.atan2)
    gradient = algebra.at_zero(algebra.gradient(dot(multipliers, twice), delta), delta)
    return first, [algebra.at_zero(row, epsilon) for row in algebra.jacobian(gradient, epsilon)]
