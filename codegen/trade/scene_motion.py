"""Many poses of a scene at once: led away from t = 0 along its freedoms and closed by Newton's method, in doubles."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.cache import kept
from codegen.ir.program import Program
from codegen.measure.attitudes import turned
from codegen.measure.constraints import Pose
from codegen.measure.judge import by_program
from codegen.mechanics.system import System
from codegen.scenes.equations import quantities
from codegen.spec.scene import COORDINATE_UNITS

Array = NDArray[np.float64]

TRAVEL = 3.0
"""Largest turn, rad, and largest move over s."""

_STEPS = 8
_CLOSED = 1e-9
_ENOUGH = 1e-13
"""What is left of ``phi`` where further steps in doubles gain nothing."""

_LAST = 12
"""Newton steps at the end, where those on the way are `_ON_THE_WAY`."""

_ON_THE_WAY = 3
_SINGULAR = 1e-16
_TINY = 1e-300


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """Many poses: ``r`` [poses, bodies, 3], ``A`` [poses, bodies, 3, 3], ``alpha`` [poses, coordinates]."""

    r: Array
    A: Array
    alpha: Array

    def where(self, kept: Array, other: State) -> State:
        """These poses where they are kept, those of another elsewhere."""
        return State(
            np.where(kept[:, None, None], self.r, other.r),
            np.where(kept[:, None, None, None], self.A, other.A),
            np.where(kept[:, None], self.alpha, other.alpha),
        )


@dataclass(frozen=True, eq=False)
class SceneMotion:
    """A scene that can be moved.

    Attributes:
        system: its constraints.
        start: at t = 0, all joints closed.
    """

    system: System
    start: Pose

    @cached_property
    def phi(self) -> Program:
        """The constraints of joints and drives, lowered in a hurry."""
        return self._lowered("phi")

    @cached_property
    def phi_q(self) -> Program:
        """Their Jacobian."""
        return self._lowered("phi_q")

    def _lowered(self, name: str) -> Program:
        return kept(("motion", self.system, name), lambda: quantities(self.system, (name,)))

    @property
    def size(self) -> int:
        """Components of a position: 2 in the plane."""
        return self.system.assembly.arrays.position

    def units(self, length: float) -> Array:
        """Unit of each displacement."""
        assembly = self.system.assembly
        body = [length] * self.size + [1.0] * (assembly.arrays.displacements - self.size)
        moving = [placed.joint.type for placed in assembly.placed if placed.form.coordinates]
        coordinates = [length if unit == "m" else 1.0 for type_ in moving for unit in COORDINATE_UNITS[type_]]
        return np.array(body * len(self.start.r) + coordinates)

    def led(self, direction: Array, far: Array, units: Array) -> State:
        """Lead the scene away from t = 0.

        Args:
            direction: [poses, displacements], of which the part is kept that leaves the joints closed.
            far: [poses] part of `TRAVEL`.
            units: of each displacement.
        """
        count = len(direction)
        start = State(*(np.repeat(x[None], count, axis=0) for x in (self.start.r, self.start.A, self.start.alpha)))
        now = start
        for _ in range(_STEPS):
            direction = self._along(now, direction, units)
            now = self._moved(now, direction * (far * TRAVEL / _STEPS)[:, None])
            now = self._closed(now, _ON_THE_WAY)
        now = self._closed(now, _LAST)
        reach = np.max(np.abs(self._displacement(start, now)) / self._bounds(units), axis=1)
        return now.where((np.max(np.abs(self.values(now)[0]), axis=1) < _CLOSED) & (reach <= 1.0), start)

    def _along(self, now: State, direction: Array, units: Array) -> Array:
        """The part of a direction that keeps the joints closed; its largest entry is its unit."""
        _, matrix = self.values(now)
        scaled = matrix * units
        free = direction / units
        free = free - _least(scaled, np.einsum("pmn,pn->pm", scaled, free))
        size = np.max(np.abs(free), axis=1, keepdims=True, initial=0.0)
        return np.where(size > 1e-6, free / np.maximum(size, 1e-6), 0.0) * units

    def _closed(self, now: State, steps: int) -> State:
        for _ in range(steps):
            phi, matrix = self.values(now)
            if np.max(np.abs(phi), initial=0.0) < _ENOUGH:
                break
            now = self._moved(now, _least(matrix, -phi))
        return now

    def _moved(self, now: State, step: Array) -> State:
        moves, turns, slips = self.parts(step)
        if self.system.assembly.translations == "body":
            moves = np.einsum("pbij,pbj->pbi", now.A, moves)
        A = turned(now.A.reshape(-1, 3, 3), turns.reshape(-1, 3)).reshape(now.A.shape)
        return State(now.r + moves, A, now.alpha + slips)

    def parts(self, step: Array) -> tuple[Array, Array, Array]:
        """Moves and turns of bodies [poses, bodies, 3], changes of the coordinates."""
        arrays, bodies = self.system.assembly.arrays, len(self.start.r)
        own = step[:, : arrays.displacements * bodies].reshape(len(step), bodies, -1)
        moves, turns = np.zeros((2, len(step), bodies, 3))
        moves[:, :, : self.size] = own[:, :, : self.size]
        turns[:, :, 3 - (arrays.displacements - self.size) :] = own[:, :, self.size :]
        return moves, turns, step[:, arrays.displacements * bodies :]

    def _displacement(self, start: State, now: State) -> Array:
        count = len(now.r)
        return np.hstack([(now.r - start.r).reshape(count, -1), now.alpha - start.alpha])

    def _bounds(self, units: Array) -> Array:
        """How far positions and coordinates may go."""
        first = len(units) - len(self.start.alpha)
        return TRAVEL * np.concatenate([np.full(3 * len(self.start.r), units[0]), units[first:]])

    def values(self, now: State) -> tuple[Array, Array]:
        """``phi`` [poses, m] and ``phi_q`` [poses, m, n] of the joints, without drives."""
        rows = len(self.system.assembly.rows)
        given: dict[str, Array] = {
            "r": _rows(now.r[:, :, : self.size]),
            "A": _rows(np.swapaxes(now.A[:, :, : self.size, : self.size], 2, 3)),
            "alpha": now.alpha.T,
            "revolutions": np.zeros((self.system.assembly.counted, len(now.r))),
            "t": np.zeros((1, len(now.r))),
        }
        phi = self.dense(by_program(self.phi)(given)["phi"], len(now.r))
        (output,) = self.phi_q.outputs
        matrix = np.zeros((len(now.r), output.sparsity.nrow, output.sparsity.ncol))
        for (row, column), entry in zip(output.sparsity.entries(), by_program(self.phi_q)(given)["phi_q"], strict=True):
            matrix[:, row, column] = entry
        return phi[:, :rows], matrix[:, :rows]

    def dense(self, entries: Sequence[Any], count: int) -> Array:
        """``phi`` [poses, rows] of its nonzeros."""
        (output,) = self.phi.outputs
        found = np.zeros((count, output.sparsity.nrow))
        for (row, _), entry in zip(output.sparsity.entries(), entries, strict=True):
            found[:, row] = entry
        return found


def _least(matrix: Array, right: Array) -> Array:
    """The least steps x with ``matrix x = right`` of many poses, by ``J^T (J J^T)^-1``.

    Rows are independent but at singular poses, where a small part of the trace keeps steps finite. What digits a step
    lacks the next one mends.
    """
    square = matrix @ np.swapaxes(matrix, 1, 2)
    diagonal = np.arange(square.shape[1])
    square[:, diagonal, diagonal] += _SINGULAR * np.trace(square, axis1=1, axis2=2)[:, None] + _TINY
    least: Array = np.einsum("pmn,pm->pn", matrix, np.linalg.solve(square, right[:, :, None])[:, :, 0])
    return least


def _rows(values: Array) -> Array:
    """[poses, ...] to [entries, poses]."""
    return values.reshape(len(values), -1).T
