"""The cuts of a chain: relative pose, constraint, Jacobian and bias acceleration (S2 18, 19, corrected).

R relative to C, in the axes of C: rotation ``R = R_C^T R_R``, position ``p``; constraint ``(p; 2 e)`` with e the vector
part of the quaternion of R, e_0 >= 0. ``J qd = (dp/dt; w)`` holds off closure too, w the angular velocity of R relative
to C; so ``d(2 e)/dq = (e_0 I - e~) J_w``. ``J qdd + gamma_R = 0`` holds on closure.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import sympy

from codegen.mechanics.chain.bias import Bias
from codegen.mechanics.chain.geometry import Geometry
from codegen.mechanics.chain.tree import Node
from codegen.mechanics.chain.vectors import ZERO, Rows, Vector, added, cross, dot, negative, rows, scaled, times

Column = tuple[Vector, Vector]
"""Linear and angular part."""


@dataclass(frozen=True)
class Loop:
    """A cut in the axes of the last link that carries both its frames.

    Attributes:
        number: of the cut, from 0.
        geometry: in those axes.
        bias: motion relative to that link.
        C: frame on the base's side.
        R: far frame.
    """

    number: int
    geometry: Geometry
    bias: Bias
    C: Node
    R: Node


class Closure:
    """What is asked of one cut; every part is derived once."""

    def __init__(self, loop: Loop) -> None:
        self._loop = loop
        self._geometry, self._bias = loop.geometry, loop.bias
        self._columns: dict[int, Column] | None = None
        self._pose: tuple[Rows, Vector] | None = None

    def pose(self) -> tuple[Rows, Vector]:
        """Rotation R and position p."""
        if self._pose is None:
            C, R = (self._geometry.axes(node.number) for node in (self._loop.C, self._loop.R))
            turned = [
                self._named("T", k, [dot(axis, other) for axis in C], "relative rotation") for k, other in enumerate(R)
            ]
            rotation = rows(zip(*turned, strict=True))
            self._pose = rotation, self._named("p", 0, times(C, self._gap()), "relative position")
        return self._pose

    def constraint(self) -> tuple[Vector, Vector]:
        """``p`` and ``2 e``."""
        _, p = self.pose()
        root, spin = self._root()
        return p, self._named("e", 0, (x / root for x in spin), "2 e")

    def _root(self) -> tuple[Any, Vector]:
        """``2 e_0`` and what ``2 e`` is when divided by it."""
        rotation, _ = self.pose()
        trace = 1 + rotation[0][0] + rotation[1][1] + rotation[2][2]
        root = self._named("e0", 0, (sympy.sqrt(trace), 0, 0), "2 e_0")[0]
        spin = [rotation[(k + 2) % 3][(k + 1) % 3] - rotation[(k + 1) % 3][(k + 2) % 3] for k in range(3)]
        return root, self._named("f", 0, spin, "4 e_0 e")

    def columns(self) -> dict[int, Column]:
        """Columns of J by coordinate: linear and angular part, axes of C; coordinates that are missing have none."""
        if self._columns is None:
            signs = [(self._loop.C, -1), (self._loop.R, 1)]
            path = [(node, sign) for end, sign in signs for node in self._path(end)]
            self._columns = {node.number: self._column(node, sign) for node, sign in path}
        return self._columns

    def derivative(self) -> dict[int, Column]:
        """Columns of ``d(p; 2e)/dq``, exact on and off closure."""
        root, _ = self._root()
        _, double = self.constraint()
        half = self._named("h", 0, scaled(sympy.Rational(1, 2), (root, 0, 0)), "e_0")[0]
        e = self._named("g", 0, scaled(sympy.Rational(1, 2), double), "e")
        return {
            number: (linear, added(scaled(half, angular), negative(cross(e, angular))))
            for number, (linear, angular) in self.columns().items()
        }

    def gamma(self) -> Column:
        """``c_R - c_C`` in the axes of C."""
        C, R, bias = self._loop.C, self._loop.R, self._bias
        axes = self._geometry.axes(C.number)
        linear = self._named("ar", 0, added(bias.a(R.number), negative(bias.a(C.number))), "relative acceleration")
        angular = self._named("er", 0, added(bias.e(R.parent), negative(bias.e(C.parent))), "and angular")
        return times(axes, linear), times(axes, angular)

    def _column(self, node: Node, sign: int) -> Column:
        axes, z = self._geometry.axes(self._loop.C.number), self._geometry.z(node.number)
        along = self._named("zc", node.number, times(axes, z), "axis of the joint, axes of C")
        signed = along if sign > 0 else negative(along)
        if not node.turns:
            return signed, ZERO
        linear = self._named("vc", node.number, times(axes, self._swept(node)), "velocity of R, axes of C")
        return added(linear if sign > 0 else negative(linear), scaled(node.advance, signed)), signed

    def _swept(self, node: Node) -> Vector:
        """Velocity of a point at the origin of R when a joint turns by 1."""
        C, R = self._loop.C, self._loop.R
        if node in self._path(R):
            return self._geometry.swept(node.number, R.number)
        arm = self._named("c", node.number, added(self._geometry.reach(node.number, C.number), self._gap()), "arm to R")
        return self._named("m", node.number, cross(self._geometry.z(node.number), arm), "velocity of R by the joint")

    def _gap(self) -> Vector:
        """From the origin of C to that of R."""
        root = self._geometry.root
        C, R = (self._geometry.reach(root, node.number) for node in (self._loop.C, self._loop.R))
        return self._named("r", 0, added(R, negative(C)), "from C to R")

    def _path(self, end: Node) -> list[Node]:
        return self._geometry.tree.path(end.parent, self._geometry.root)

    def _named(self, name: str, number: int, value: Any, words: str) -> Vector:
        return self._geometry.named(f"{name}{self._loop.number + 1}", number, value, words)
