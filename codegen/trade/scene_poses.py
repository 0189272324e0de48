"""Poses of a scene over a domain: led away from t = 0 along its freedoms, closed to twice the precision of doubles.

A point of the unit cube says which way and how far: a direction in the displacements is kept in the null space of the
Jacobian, step by step, and Newton's method closes the joints after each. Angles turn by up to `TRAVEL`, lengths by as
many of the domain's `s`; poses that do not close or leave that box are those of t = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from codegen.measure.double_double import DoubleDouble
from codegen.measure.draw import Draw, Points, drifted
from codegen.measure.ideal_rotations import Matrix, Vector, apply, rotation, small_rotation, times
from codegen.measure.judge import true_values
from codegen.measure.pose_domain import MOST_TURNS, PoseDomain
from codegen.measure.poses import Poses
from codegen.passes.given_trigonometry import SINES_COSINES
from codegen.trade.scene_motion import SceneMotion, State

Array = NDArray[np.float64]

_REFINEMENTS = 3


@dataclass(frozen=True, eq=False)
class SceneSampler:
    """Draws poses of a scene.

    Attributes:
        motion: moves the scene.
    """

    motion: SceneMotion

    @property
    def columns(self) -> int:
        """Dimensions of the points."""
        system, bodies = self.motion.system, len(self.motion.start.r)
        return 3 * len(system.assembly.columns) + 15 * bodies + system.row_count + system.assembly.counted + 8

    def poses(self, domain: PoseDomain, points: Points, is_converged: bool) -> Poses:
        """Make poses of points of the unit cube; see `codegen.measure.poses.poses_at`.

        Those that were made before are kept: every candidate of a budget is judged from the same ones.
        """
        key = domain, points.tobytes(), is_converged
        if key not in self._made:
            self._made[key] = self._poses(domain, points, is_converged)
        return self._made[key]

    @cached_property
    def _made(self) -> dict[tuple[PoseDomain, bytes, bool], Poses]:
        return {}

    def _poses(self, domain: PoseDomain, points: Points, is_converged: bool) -> Poses:
        draw = Draw(points)
        units = self.motion.units(domain.s)
        direction = np.array([draw.within(-1.0, 1.0).high for _ in units]).T
        state = self.motion.led(direction * units, draw.unit().high, units)
        r, A, alpha = self._ideal(state)
        if not is_converged:
            r = [self._off(draw, v, domain.misfit * domain.s) for v in r]
            A = [times(M, small_rotation(self._turn(draw, domain.misfit))) for M in A]
            slips = units[len(units) - len(alpha) :] * domain.misfit
            alpha = [x + draw.within(-1, 1) * _of(float(slip)) for x, slip in zip(alpha, slips, strict=True)]
        turns = [draw.whole(MOST_TURNS) for _ in range(self.motion.system.assembly.counted)]
        ideal = self._entries(r, A, alpha) | {
            "revolutions": turns,
            "velocity": draw.vector(len(units), domain.velocity),
            "lambda": draw.vector(self.motion.system.row_count, domain.multiplier),
            "t": [draw.unit()],
        }
        ideal[SINES_COSINES] = [part for angle in alpha for part in angle.sine_and_cosine()]
        moved = [drifted(M, domain.drift, draw) for M in A] if domain.drift else []
        return Poses(ideal, {"A": self._attitudes(moved)} if moved else {})

    # --- twice the precision

    def _ideal(self, state: State) -> tuple[list[Vector], list[Matrix], Vector]:
        """Exact rotations, closed by steps that doubles know well enough."""
        r = [[_of_row(state.r[:, k, i]) for i in range(3)] for k in range(state.r.shape[1])]
        A = [_exact_rotation(state.A[:, k]) for k in range(state.A.shape[1])]
        alpha = [_of_row(column) for column in state.alpha.T]
        inverse = np.linalg.pinv(self.motion.values(state)[1], rcond=1e-8)
        for _ in range(_REFINEMENTS):
            found = true_values(self.motion.phi, self._entries(r, A, alpha) | self._still(len(state.r)))["phi"]
            phi = self.motion.dense([entry.high for entry in found], len(state.r))[:, : inverse.shape[2]]
            moves, turns, slips = self.motion.parts(np.einsum("pnm,pm->pn", inverse, -phi))
            for k, M in enumerate(A):
                move = [_of_row(moves[:, k, i]) for i in range(3)]
                move = apply(M, move) if self.motion.system.assembly.translations == "body" else move
                r[k] = [x + step for x, step in zip(r[k], move, strict=True)]
                A[k] = times(M, small_rotation([_of_row(turns[:, k, i]) for i in range(3)]))
            alpha = [x + _of_row(step) for x, step in zip(alpha, slips.T, strict=True)]
        return r, A, alpha

    def _entries(self, r: list[Vector], A: list[Matrix], alpha: Vector) -> dict[str, Vector]:
        return {"r": [x for v in r for x in v[: self.motion.size]], "A": self._attitudes(A), "alpha": alpha}

    def _attitudes(self, A: list[Matrix]) -> Vector:
        size = self.motion.size
        return [M[i][j] for M in A for j in range(size) for i in range(size)]

    def _still(self, count: int) -> dict[str, Vector]:
        zero = _of_row(np.zeros(count))
        return {"revolutions": [zero] * self.motion.system.assembly.counted, "t": [zero]}

    def _off(self, draw: Draw, r: Vector, misfit: float) -> Vector:
        steps = [*draw.vector(self.motion.size, misfit), draw.zero][:3]
        return [x + step for x, step in zip(r, steps, strict=True)]

    def _turn(self, draw: Draw, misfit: float) -> Vector:
        vector = draw.vector(3, misfit)
        return vector if self.motion.size == 3 else [draw.zero, draw.zero, vector[2]]


def _of(value: float) -> DoubleDouble:
    return DoubleDouble.of(value)


def _of_row(values: Array) -> DoubleDouble:
    return DoubleDouble.of(np.asarray(values, dtype=np.float64))


def _exact_rotation(A: Array) -> Matrix:
    x, y, z, w = (DoubleDouble.of(column) for column in Rotation.from_matrix(A).as_quat().T)
    norm = (w * w + x * x + y * y + z * z).sqrt()
    return rotation([part / norm for part in (w, x, y, z)])
