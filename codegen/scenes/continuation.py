"""Go on through a singular configuration: along the motion there was, then back onto the constraints.

At a singular pose branches of the motion meet. The smooth one is that which the motion before it predicts: positions
are extrapolated from states before, by the polynomial that has their values and rates.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.interpolate import KroghInterpolator

from codegen.dynamics.layout import Layout
from codegen.measure.constraints import Array, Pose
from codegen.mechanics.system import System
from codegen.scenes.run import Prepared, consistent_state
from codegen.scenes.state import bodies_of, rate_matrix
from codegen.scenes.watch import SINGULAR, Watch

STATES = 3
"""States before that predict."""

_ITERATIONS = 5


@dataclass(frozen=True, slots=True, eq=False)
class Prediction:
    """Positions of a state as a polynomial of time.

    Attributes:
        origin: s, time of the last state.
        last: [size] that state.
        polynomial: of its positions.
    """

    origin: float
    last: Array
    polynomial: KroghInterpolator

    def state(self, t: float) -> Array:
        """State [size] whose positions are those at a time; the rest is as in the last state."""
        found = self.last.copy()
        found[: self.polynomial.yi.shape[1]] = self.polynomial(t - self.origin)
        return found

    def rates(self, t: float) -> Array:
        """Rates of the positions at a time."""
        found: Array = self.polynomial.derivative(t - self.origin, 1)
        return found


def prediction(layout: Layout, t: Array, y: Array, ydot: Array) -> Prediction:
    """Predict positions from states one after the other; the last `STATES` count.

    Args:
        layout: of the state.
        t: [n] s.
        y: [n, size].
        ydot: [n, size].
    """
    count = layout.positions.stop
    times, values, rates = (part[-STATES:] for part in (t, y[:, :count], ydot[:, :count]))
    nodes = np.repeat(times - times[-1], 2)
    data = np.stack([values, rates], axis=1).reshape(len(nodes), count)
    return Prediction(float(times[-1]), y[-1], KroghInterpolator(nodes, data))


def continued(prepared: Prepared, watch: Watch, t: float, predicted: Prediction) -> tuple[Array, Array, float]:
    """Give the state at a time behind a singular pose.

    Args:
        prepared: the scene.
        watch: of its constraints.
        t: s.
        predicted: from states before.

    Returns:
        State, its rate, and how far the positions were moved onto the constraints (largest, without dimension).
    """
    layout, system = prepared.layout, prepared.system
    y = predicted.state(t)
    velocity = _velocity(system, layout, y, predicted.rates(t))
    y, moved = _projected(watch, system, layout, t, y)
    bodies = bodies_of(system, layout, y[None], np.zeros((1, layout.size)))
    pose = Pose(bodies.r[0], bodies.A[0], bodies.alpha[0])
    state, rates = consistent_state(prepared, pose, velocity, t)
    return state, rates, moved


def _velocity(system: System, layout: Layout, y: Array, rates: Array) -> Array:
    """Velocities as the state has them, of rates of its positions."""
    arrays, found = system.assembly.arrays, np.zeros(len(system.assembly.columns))
    count = len(system.assembly.scene.bodies)
    stride = 3 if arrays.is_planar else 7
    for k in range(count):
        own, first = rates[stride * k : stride * (k + 1)], arrays.displacements * k
        turn = own[2:] if arrays.is_planar else 2 * rate_matrix(y[stride * k + 3 : stride * (k + 1)]) @ own[3:]
        found[first : first + arrays.displacements] = [*own[: arrays.position], *turn]
    found[arrays.displacements * count :] = rates[stride * count :]
    return found


def _projected(watch: Watch, system: System, layout: Layout, t: float, y: Array) -> tuple[Array, float]:
    """Move positions onto all constraints by the least change, without dimension."""
    total = np.zeros(len(watch.column_units))
    for _ in range(_ITERATIONS):
        phi, phi_q = watch.values(np.array([t]), y[None])
        step = -scipy.linalg.lstsq(phi_q[0], phi[0], cond=SINGULAR)[0]
        y, total = _displaced(system, layout, y, step * watch.column_units), total + step
    return y, float(np.max(np.abs(total)))


def _displaced(system: System, layout: Layout, y: Array, step: Array) -> Array:
    arrays, found = system.assembly.arrays, y.copy()
    count, size = len(system.assembly.scene.bodies), arrays.position
    stride = 3 if arrays.is_planar else 7
    attitudes = bodies_of(system, layout, y[None], np.zeros((1, layout.size))).A[0]
    for k in range(count):
        own = step[arrays.displacements * k : arrays.displacements * (k + 1)]
        in_body = system.assembly.translations == "body"
        found[stride * k : stride * k + size] += attitudes[k][:size, :size] @ own[:size] if in_body else own[:size]
        p = found[stride * k + size : stride * (k + 1)]
        p += own[size:] if arrays.is_planar else 0.5 * rate_matrix(p).T @ own[size:]
    found[stride * count : layout.positions.stop] += step[arrays.displacements * count :]
    return found
