"""Watch a run: how near it comes to a singular configuration, and whether the rows left out still follow from the rest.

Input: states. Output: of each closed part the smallest singular value of ``phi_q`` of the rows kept over the largest,
lengths by the characteristic length; and ``phi`` of the rows that were left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from codegen.dynamics.layout import Layout
from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.ir.program import Program
from codegen.measure.constraints import Array, characteristic_length
from codegen.measure.threads import one_thread
from codegen.mechanics.system import System
from codegen.scenes.equations import WATCHED, quantities
from codegen.scenes.generate import Judged, row_names
from codegen.scenes.numbers import constraint_system, coordinates, rows_of
from codegen.scenes.state import bodies_of

SINGULAR = 1e-3
"""A part whose smallest singular value is below this part of the largest is in a singular configuration."""

DROPPED = 1e-6
"""Rows that were left out hold within this, lengths by the characteristic length; or within `PER_TOLERANCE` times the
tolerance of the run, if that is more."""

PER_TOLERANCE = 100.0

_TAKES_PART = 0.1
"""A row or a displacement takes part in a singularity with more than this of a direction of length 1."""


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A connected part whose joints close loops; rows among those kept, columns among all."""

    rows: NDArray[np.intp]
    columns: NDArray[np.intp]


class Watch:
    """The constraints of a run, for many states at once.

    Args:
        judged: forms and rows.
        layout: of the state.

    Attributes:
        system: with all rows that are not identically zero, then those of the drives.
    """

    def __init__(self, judged: Judged, layout: Layout) -> None:
        self.system = System(judged.undropped)
        self._layout = layout
        scene, assembly = judged.undropped.scene, judged.undropped
        self._length = characteristic_length(constraint_system(scene, assembly.forms, assembly.dropped))
        own = set(judged.assembly.rows)
        is_kept = np.array([row in own for row in assembly.rows] + [True] * len(self.system.drives), dtype=bool)
        self.kept, self.dropped = np.flatnonzero(is_kept), np.flatnonzero(~is_kept)

    # --- values

    @cached_property
    def _program(self) -> Program:
        return quantities(self.system, WATCHED)

    @cached_property
    def row_units(self) -> Array:
        """Unit of each row: the characteristic length, or 1."""
        assembly = self.system.assembly
        units = [row.unit for joint in assembly.scene.joints for row in rows_of(assembly.forms[joint.name])]
        moved = [self._coordinate_units[driven.alpha] for driven in self.system.drives]
        return self._lengths([units[row] for row in assembly.rows] + moved)

    @cached_property
    def column_units(self) -> Array:
        """Unit of each displacement."""
        arrays = self.system.assembly.arrays
        body = ["m"] * arrays.position + ["rad"] * (arrays.displacements - arrays.position)
        return self._lengths(body * len(self.system.assembly.scene.bodies) + self._coordinate_units)

    @cached_property
    def _coordinate_units(self) -> list[str]:
        assembly = self.system.assembly
        return [unit for joint in assembly.scene.joints for unit in coordinates(assembly.forms[joint.name])]

    def _lengths(self, units: Sequence[str]) -> Array:
        return np.array([self._length if unit == "m" else 1.0 for unit in units])

    def values(self, t: Array, y: Array) -> tuple[Array, Array]:
        """Evaluate ``phi`` [n, m] and ``phi_q`` [n, m, columns] of all rows, without dimension.

        Args:
            t: [n] s.
            y: [n, size] states.
        """
        values = evaluate(self._program, self._arguments(t, y), numpy_domain())
        phi = np.zeros((len(t), len(self.row_units)))
        phi_q = np.zeros((len(t), len(self.row_units), len(self.column_units)))
        for (row, _), value in zip(self._program.output("phi").sparsity.entries(), values["phi"], strict=True):
            phi[:, row] = value
        pattern = self._program.output("phi_q").sparsity
        for (row, column), value in zip(pattern.entries(), values["phi_q"], strict=True):
            phi_q[:, row, column] = value
        return phi / self.row_units, phi_q / self.row_units[:, None] * self.column_units

    def _arguments(self, t: Array, y: Array) -> dict[str, list[Array]]:
        assembly = self.system.assembly
        bodies, size, times = (
            bodies_of(self.system, self._layout, y, np.zeros_like(y)),
            assembly.arrays.position,
            len(t),
        )
        attitudes = bodies.A[..., :size, :size].transpose(1, 3, 2, 0)
        return {
            "r": list(bodies.r[..., :size].reshape(times, -1).T),
            "A": list(attitudes.reshape(-1, times)),
            "alpha": list(bodies.alpha.T),
            "revolutions": [np.zeros(times)] * len(assembly.placed),
            "t": [t],
        }

    # --- verdicts

    @cached_property
    def parts(self) -> tuple[Part, ...]:
        """Parts with loops; the rows of a tree are independent in every pose."""
        pattern = self._program.output("phi_q").sparsity
        place = {row: k for k, row in enumerate(self.kept.tolist())}
        entries = [(place[row], column) for row, column in pattern.entries() if row in place]
        rows, columns = np.array(entries, dtype=np.intp).reshape(-1, 2).T
        m, n = len(self.kept), len(self.column_units)
        graph = coo_matrix((np.ones(len(rows)), (rows, m + columns)), shape=(m + n, m + n))
        _, labels = connected_components(graph, directed=False)
        found = []
        for label in np.unique(labels[:m]):
            own = Part(np.flatnonzero(labels[:m] == label), np.flatnonzero(labels[m:] == label))
            if len(self._joints(own.rows)) > len(self._bodies(own.columns)) or not self._is_of_joints(own.rows):
                found.append(own)
        return tuple(found)

    def _is_of_joints(self, rows: NDArray[np.intp]) -> bool:
        return bool(np.all(self.kept[rows] < len(self.system.assembly.rows)))

    def conditions(self, t: Array, y: Array) -> tuple[Array, Array]:
        """How near states are to a singular configuration, and what became of the rows that were left out.

        Args:
            t: [n] s.
            y: [n, size] states.

        Returns:
            Smallest singular value over the largest, [n, parts], see `SINGULAR`; ``phi`` [n, d] of the rows that were
            left out, without dimension, see `DROPPED`.
        """
        phi, phi_q = self.values(t, y)
        least = np.ones((len(t), len(self.parts)))
        for k, part in enumerate(self.parts):
            with one_thread():
                sigma = np.linalg.svd(phi_q[:, self.kept[part.rows]][..., part.columns], compute_uv=False)
            least[:, k] = sigma[:, -1] / sigma[:, 0]
        return least, phi[:, self.dropped]

    # --- words

    def singular_words(self, t: float, y: Array, part: int) -> str:
        """Say what is singular in a state.

        Args:
            t: s.
            y: [size].
            part: its number.
        """
        own = self.parts[part]
        phi_q = self.values(np.array([t]), y[None])[1][0][self.kept[own.rows]][:, own.columns]
        left, sigma, right = np.linalg.svd(phi_q)
        rank = int(np.sum(sigma >= SINGULAR * sigma[0]))
        joints = self._joints(own.rows[np.abs(left[:, -1]) > _TAKES_PART])
        bodies = self._bodies(own.columns[np.abs(right[len(sigma) - 1]) > _TAKES_PART])
        return (
            f"singular configuration at t = {t:.9g} s: rank {rank} of {len(sigma)} rows; "
            f"not independent: {', '.join(joints)}; free to move besides: {', '.join(bodies) or 'joint coordinates'}"
        )

    def dropped_words(self, t: float, phi: Array) -> str:
        """Say which row that was left out does not hold.

        Args:
            t: s.
            phi: [d] of the rows that were left out.
        """
        worst = int(np.argmax(np.abs(phi)))
        joint, row = self._name(int(self.dropped[worst]))
        return (
            f"at t = {t:.9g} s the mechanism has left the poses at which its rows were chosen: {row} of {joint}, which "
            f"was left out as redundant, is off by {abs(phi[worst]):.1e}"
        )

    def _name(self, row: int) -> tuple[str, str]:
        rows = self.system.assembly.rows
        if row < len(rows):
            return row_names(self.system.assembly)[rows[row]]
        return self.system.drives[row - len(rows)].joint, "drive"

    def _joints(self, rows: NDArray[np.intp]) -> list[str]:
        """Names of the joints that rows, among those kept, belong to."""
        return list(dict.fromkeys(self._name(int(row))[0] for row in self.kept[rows]))

    def _bodies(self, columns: NDArray[np.intp]) -> list[str]:
        """Names of the bodies that displacements belong to."""
        names = [body.name for body in self.system.assembly.scene.bodies]
        numbers = np.unique(columns // self.system.assembly.arrays.displacements)
        return [names[k] for k in numbers.tolist() if k < len(names)]
