"""Accelerations and multipliers at given states, from the equations of motion themselves.

``M a + phi_q^T lambda = force``, ``phi_q a = gamma``. What an integrator has for them lacks an order: it keeps them out
of its error test, and its rates are derivatives of a polynomial.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from codegen.dynamics.layout import Layout
from codegen.ir.evaluate import evaluate, numpy_domain
from codegen.ir.program import Program
from codegen.measure.constraints import Array
from codegen.mechanics.condensed import Condensed
from codegen.mechanics.system import System
from codegen.scenes.state import Bodies, bodies_of
from codegen.simulate.start import dense, saddle


def settled(system: System, layout: Layout, values: Program, mass: Program, t: Array, y: Array, ydot: Array) -> Bodies:
    """Read the motion of the bodies off states, with accelerations and multipliers that fit.

    Args:
        system: the scene.
        layout: of the state.
        values: ``phi_q``, ``gamma`` and ``force``.
        mass: ``mass``.
        t: [n] s.
        y: [n, size].
        ydot: [n, size] its rate.
    """
    bodies = bodies_of(system, layout, y, ydot)
    found = _evaluated(system, t, bodies, values)
    if layout.condensed.coordinates:
        phi_q = _times(found["phi_q"], len(y))
        bodies = replace(bodies, alphadot=_rates(system, layout.condensed, values, phi_q, bodies))
        found = _evaluated(system, t, bodies, values)
    rows = {name: _times(found[name], len(y)) for name in ("phi_q", "gamma", "force")}
    M = dense(mass.output("mass"), evaluate(mass, {})["mass"])
    linear = _Saddle(M, values)
    solved = [linear.solve(*(rows[name][k] for name in ("phi_q", "force", "gamma"))) for k in range(len(y))]
    size = len(M)
    rates = np.array([solution[:size] for solution in solved])
    return _with_accelerations(system, bodies, rates, np.array([solution[size:] for solution in solved]))


def _evaluated(system: System, t: Array, bodies: Bodies, values: Program) -> dict[str, list[Array]]:
    arrays = _arguments(system, t, bodies)
    return evaluate(values, {name: list(array.T) for name, array in arrays.items()}, numpy_domain())


def _rates(system: System, condensed: Condensed, values: Program, phi_q: Array, bodies: Bodies) -> Array:
    """Rates of the joint coordinates [n, k]; those that the state leaves out are such that ``phi_q v = 0``."""
    found = bodies.alphadot.copy()
    found[:, condensed.coordinates] = 0.0
    velocity = _velocity(system, replace(bodies, alphadot=found))
    place = {row: k for k, row in enumerate(condensed.rows)}
    drift = np.zeros((len(phi_q), len(place)))
    for k, (row, column) in enumerate(values.output("phi_q").sparsity.entries()):
        if row in place:
            drift[:, place[row]] += phi_q[:, k] * velocity[:, column]
    for a, b, value in condensed.inverse:
        found[:, condensed.coordinates[a]] -= float(value) * drift[:, b]
    return found


def _times(values: list[Array], count: int) -> Array:
    """[n, entries], also where an entry is the same at all times."""
    found = np.zeros((count, len(values)))
    for k, value in enumerate(values):
        found[:, k] = value
    return found


def _arguments(system: System, t: Array, bodies: Bodies) -> dict[str, Array]:
    """Arguments of the programs of a system, [n, length] each."""
    times, size = len(bodies.r), system.assembly.arrays.position
    revolutions = next(a.length for a in system.arguments() if a.name == "revolutions")
    return {
        "r": bodies.r[..., :size].reshape(times, -1),
        "A": np.swapaxes(bodies.A[..., :size, :size], -1, -2).reshape(times, -1),
        "alpha": bodies.alpha,
        "velocity": _velocity(system, bodies),
        "revolutions": np.zeros((times, revolutions)),
        "t": t[:, None],
    }


def _velocity(system: System, bodies: Bodies) -> Array:
    """[n, k], in the axes of the programs."""
    size, v = system.assembly.arrays.position, bodies.v
    if system.assembly.translations == "body":
        v = np.einsum("nbji,nbj->nbi", bodies.A, v)
    turns = bodies.omega if size == 3 else bodies.omega[..., 2:]
    own = np.concatenate([v[..., :size], turns], axis=-1).reshape(len(v), -1)
    return np.concatenate([own, bodies.alphadot], axis=1)


def _with_accelerations(system: System, bodies: Bodies, rates: Array, multipliers: Array) -> Bodies:
    times, count, _ = bodies.r.shape
    arrays = system.assembly.arrays
    own = rates[:, : arrays.displacements * count].reshape(times, count, arrays.displacements)
    a, omegadot = np.zeros_like(bodies.a), np.zeros_like(bodies.omegadot)
    a[..., : arrays.position] = own[..., : arrays.position]
    omegadot[..., 3 - (arrays.displacements - arrays.position) :] = own[..., arrays.position :]
    if system.assembly.translations == "body":
        a = np.einsum("nbij,nbj->nbi", bodies.A, a)
    return replace(bodies, a=a, omegadot=omegadot, multipliers=multipliers)


class _Saddle:
    """``[M phi_q^T; phi_q 0]``, sparse, of one pattern."""

    def __init__(self, M: Array, values: Program) -> None:
        size, phi_q = len(M), values.output("phi_q").sparsity
        row, column = np.array(phi_q.entries(), dtype=np.int64).reshape(-1, 2).T
        inertia = np.nonzero(M)
        self._M = M
        self._masses = M[inertia]
        self._place = tuple(
            np.concatenate(parts) for parts in ((inertia[0], row + size, column), (inertia[1], column, row + size))
        )
        self._size = size + phi_q.nrow
        pushed, bent = (values.output(name).sparsity.entries() for name in ("force", "gamma"))
        self._right = [row for row, _ in pushed] + [size + row for row, _ in bent]

    def solve(self, phi_q: Array, force: Array, gamma: Array) -> Array:
        """Accelerations, then multipliers."""
        right = np.zeros(self._size)
        right[self._right] = np.concatenate([force, gamma])
        entries = np.concatenate([self._masses, phi_q, phi_q])
        matrix = sparse.csc_matrix((entries, self._place), shape=(self._size, self._size))
        try:
            found: Array = splu(matrix).solve(right)
        except RuntimeError:  # singular
            size = len(self._M)
            constraints = matrix[size:, :size].toarray()
            found = np.concatenate(saddle(self._M, constraints, right[:size], right[size:]))
        return found
