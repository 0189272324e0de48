"""Weight, torques and forces on a body: constant in world axes, so that they turn as seen from the body.

With ``s`` from the centre of mass to the point where a force F acts, its moment is ``s~ A^T F`` in body axes. As
``delta A = A delta pi~``, a vector ``u = A^T F`` changes by ``u~ delta pi``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy

from codegen.ir.lower import Tilde
from codegen.mechanics import frames
from codegen.mechanics.arrays import body_symbol
from codegen.mechanics.placed import rational
from codegen.spec.scene import ZERO_VECTOR, Body, Scene, Vector

Load = tuple[Any, Any | None]
"""A vector, and its derivative by the turn of the body; None where it does not change."""


@dataclass(frozen=True)
class ConstantLoad:
    """What acts on a body with a constant direction.

    Attributes:
        scene: where it acts.
        body: on which it acts.
        identifier: of the body.
    """

    scene: Scene
    body: Body
    identifier: str

    def pulls(self, translations: str) -> Iterator[Load]:
        """Forces on the centre of mass, N.

        Args:
            translations: axes of the virtual translations, ``world`` or ``body``.
        """
        own = (force.vector for force in self.scene.forces if force.body == self.body.name)
        force = rational(self.body.mass) * _column(self.scene.gravity) + _sum(own)
        if not force.is_zero_matrix:
            yield self._turning(force) if translations == "body" else (force, None)

    @property
    def moments(self) -> Iterator[Load]:
        """Moments about the centre of mass, body axes, N m."""
        torque = _sum(torque.vector for torque in self.scene.torques if torque.body == self.body.name)
        if not torque.is_zero_matrix:
            yield self._turning(torque)
        for s, seen in zip(self.points, self.seen, strict=True):
            yield sympy.MatMul(Tilde(s), seen), sympy.MatMul(Tilde(s), Tilde(seen))

    @cached_property
    def points(self) -> Mapping[Any, Any]:
        """Symbols of the points off the centre of mass where forces act, [3] m, body axes, and their components."""
        return {
            frames.vector(f"point_{k}_of_{self.identifier}"): _column(point)
            for k, (point, _) in enumerate(self._off_centre)
        }

    @cached_property
    def seen(self) -> Mapping[Any, Any]:
        """Symbols of the forces at these points, [3] N, body axes, and their definitions: vectors of their own."""
        return {
            frames.vector(f"force_{k}_on_{self.identifier}"): self._turning(force)[0]
            for k, (_, force) in enumerate(self._off_centre)
        }

    @cached_property
    def _off_centre(self) -> list[tuple[Vector, Any]]:
        """Points and what acts there, each point once."""
        found: dict[Vector, list[Vector]] = {}
        for force in self.scene.forces:
            if force.body == self.body.name and force.point != ZERO_VECTOR:
                found.setdefault(force.point, []).append(force.vector)
        sums = ((point, _sum(vectors)) for point, vectors in found.items())
        return [(point, force) for point, force in sums if not force.is_zero_matrix]

    def _turning(self, vector: Any) -> Load:
        seen = sympy.MatMul(sympy.Transpose(body_symbol("A", self.identifier)), vector)
        return seen, Tilde(seen)


def _sum(vectors: Iterable[Vector]) -> Any:
    return sum(map(_column, vectors), sympy.zeros(3, 1)).as_immutable()


def _column(vector: Vector) -> Any:
    return sympy.ImmutableDenseMatrix([rational(x) for x in vector])
