"""Two free bodies on a revolute joint with a torque on alpha, moved by Eqs. (26), (32), (33) as printed or corrected.

Equation of motion (1): M a + phi_q^T lambda = Q, here with Q = (-w x J w, torque on alpha) and no other force.  The
position constraint is kept by the true Jacobian, so the force phi_q^T lambda alone tells the two apart.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from random import Random

import numpy as np

from tests.reference.constraints import Pose
from tests.reference.derivatives import ALPHA, PI_I, PI_J, R_I, R_J, evaluate, gamma_along_motion
from tests.reference.rotations import skew
from tests.reference.scalars import Array

from . import corrected, printed, sound, truth
from .situations import SEEDS, Situation, draw, numbers, with_alpha

MASS_I, MASS_J = 1.0, 1.5  # kg
INERTIA_I, INERTIA_J = np.diag([0.4, 0.5, 0.6]), np.diag([0.7, 0.5, 0.8])  # kg m^2, body axes
MASS_MATRIX = np.zeros((13, 13))
MASS_MATRIX[:12, :12] = np.diag([*[MASS_I] * 3, 0.4, 0.5, 0.6, *[MASS_J] * 3, 0.7, 0.5, 0.8])

TORQUE = 0.5  # N m
DURATION, STEPS = 0.5, 40  # s
NEWTON_START, NEWTON_END, NEWTON_LIMIT, NEWTON_FEW = 0.05, 1e-10, 30, 5

Form = Callable[[Situation], Array]


@dataclass(frozen=True, slots=True)
class State:
    """Situation and velocity [13]: A^T rdot, omega in body axes, alphadot."""

    s: Situation
    velocity: Array


def phi_q(eq_32: Array, s: Situation) -> Array:
    """Jacobian [6x13] of the revolute joint by Table 6, alpha by Eq. (33)."""
    return np.column_stack([np.vstack([sound.eq_26(s), eq_32]), np.concatenate([np.zeros(3), sound.eq_33(s)[:, 1]])])


def as_printed(s: Situation) -> Array:
    """With Eq. (32) as printed, its row 2 mended: what is wrong is row 3."""
    return phi_q(np.array([corrected.eq_32(s)[0], corrected.eq_32(s)[1], printed.eq_32(s)[2]]), s)


def with_row_2_as_printed(s: Situation) -> Array:
    """With Eq. (32) as printed, its row 3 mended: what is wrong is row 2."""
    return phi_q(np.array([corrected.eq_32(s)[0], printed.eq_32(s)[1], corrected.eq_32(s)[2]]), s)


def as_corrected(s: Situation) -> Array:
    """With Eq. (32) corrected."""
    return phi_q(corrected.eq_32(s), s)


def gyroscopic(velocity: Array) -> Array:
    """-w x J w in the rows of the rotations [13]."""
    force = np.zeros(13)
    for part, inertia in ((PI_I, INERTIA_I), (PI_J, INERTIA_J)):
        force[part] = -np.cross(velocity[part], inertia @ velocity[part])
    return force


def saddle(mass: Array, forces: Array, rows: Array, load: Array, gamma: Array) -> Array:
    """Acceleration of M a + forces^T lambda = load, rows a = gamma."""
    m = len(rows)
    matrix = np.block([[mass, forces.T], [rows, np.zeros((m, m))]])
    return np.linalg.solve(matrix, np.concatenate([load, gamma]))[: len(mass)]


def acceleration(state: State, torque: float, form: Form) -> Array:
    """(A_i^T r_i'', omega_i', A_j^T r_j'', omega_j', alpha'') [13] with the constraint forces of a form."""
    s, velocity = state.s, state.velocity
    load = gyroscopic(velocity)
    load[12] = torque
    gamma = np.asarray(
        gamma_along_motion("revolute", "parametric", "table4", s.pose, s.geometry, velocity), dtype=float
    )
    return saddle(MASS_MATRIX, form(s), as_corrected(s), load, gamma)


def acceleration_conventional(state: State, torque: float) -> Array:
    """Accelerations [12] of the bodies by action and reaction: -torque h_i on body i, +torque h_j on body j."""
    s, velocity = state.s, state.velocity.copy()[:12]
    load = gyroscopic(velocity)[:12]
    load[PI_I] -= torque * s.h_i
    load[PI_J] += torque * s.h_j
    world = velocity.copy()
    world[R_I], world[R_J] = s.A_i @ velocity[R_I], s.A_j @ velocity[R_J]
    geometry = np.concatenate([s.s_i, s.C_i.ravel(order="F"), s.s_j, s.C_j.ravel(order="F")])
    pose = {"r_i": s.pose.r_i, "A_i": s.A_i, "r_j": s.pose.r_j, "A_j": s.A_j, "geometry": geometry}
    inputs = pose | {"velocity": world}
    rows, gamma = (evaluate("revolute", "conventional", name, inputs) for name in ("phi_q", "gamma"))
    a = saddle(MASS_MATRIX[:12, :12], rows, rows, load, gamma)
    a[R_I], a[R_J] = s.A_i.T @ a[R_I], s.A_j.T @ a[R_J]
    return a


def start(seed: int = 1) -> State:
    """A consistent state of general frames and tangent velocity."""
    s = with_alpha(draw("revolute", seed), np.array([1.2]))
    rows, velocity = truth.phi_q(s), numbers(Random(seed), 13)
    return State(s, velocity - np.linalg.pinv(rows) @ (rows @ velocity))


def angular_momentum(state: State) -> Array:
    """Of both bodies about the origin [3], world axes; nothing from outside acts, so it must stay."""
    s, v = state.s, state.velocity
    total = np.zeros(3)
    for r, A, mass, inertia, linear, angular in (
        (s.pose.r_i, s.A_i, MASS_I, INERTIA_I, v[R_I], v[PI_I]),
        (s.pose.r_j, s.A_j, MASS_J, INERTIA_J, v[R_J], v[PI_J]),
    ):
        total += mass * np.cross(r, A @ linear) + A @ (inertia @ angular)
    return total


def turn(state: State) -> float:
    """Angle of the joint by the attitudes of its bodies, rad."""
    s = state.s
    f_j = s.A_i.T @ s.A_j @ s.f_j
    return float(np.arctan2(s.g_i @ f_j, s.f_i @ f_j))


def rate(state: State, torque: float, form: Form) -> tuple[Array, ...]:
    """Time derivatives of r_i, A_i, r_j, A_j, alpha, velocity."""
    s, v = state.s, state.velocity
    a = acceleration(state, torque, form)
    for part, angular in ((R_I, v[PI_I]), (R_J, v[PI_J])):
        a[part] = a[part] - np.cross(angular, v[part])
    A_i, A_j = s.A_i, s.A_j
    return A_i @ v[R_I], A_i @ skew(v[PI_I]), A_j @ v[R_J], A_j @ skew(v[PI_J]), v[ALPHA], a


def moved(state: State, rates: tuple[Array, ...], h: float) -> State:
    """State after a straight step."""
    p = state.s.pose
    values = [x + h * dx for x, dx in zip((p.r_i, p.A_i, p.r_j, p.A_j, p.alpha), rates, strict=False)]
    return State(replace(state.s, pose=Pose(*values)), state.velocity + h * rates[5])


@cache
def run(torque: float, form: Form) -> State:
    """State at the end of the motion, by the classical Runge-Kutta method."""
    state, h = start(), DURATION / STEPS
    for _ in range(STEPS):
        k1 = rate(state, torque, form)
        k2 = rate(moved(state, k1, h / 2), torque, form)
        k3 = rate(moved(state, k2, h / 2), torque, form)
        k4 = rate(moved(state, k3, h), torque, form)
        mean = tuple((a + 2 * b + 2 * c + d) / 6 for a, b, c, d in zip(k1, k2, k3, k4, strict=True))
        state = moved(state, mean, h)
    return state


def error_of_acceleration(torque: float, form: Form) -> float:
    """Largest deviation from the accelerations by action and reaction."""
    state = start()
    off = acceleration(state, torque, form)[:12] - acceleration_conventional(state, torque)
    return float(np.max(np.abs(off)))


def error_with_body_i_held(torque: float) -> float:
    """Largest deviation of the accelerations, printed from corrected, where body i is the ground."""
    s, free = start().s, slice(6, 13)
    load, gamma = np.zeros(13), np.zeros(6)
    load[12] = torque
    mass, rows = MASS_MATRIX[free, free], as_corrected(s)[:, free]
    a, b = (saddle(mass, form(s)[:, free], rows, load[free], gamma) for form in (as_printed, as_corrected))
    return float(np.max(np.abs(a - b)))


def error_of_angle(torque: float) -> float:
    """Angle of the joint at the end, printed from corrected, rad."""
    return abs(turn(run(torque, as_printed)) - turn(run(torque, as_corrected)))


def drift_of_angular_momentum(torque: float, form: Form) -> float:
    """Length of the change of the angular momentum during the motion."""
    return float(np.linalg.norm(angular_momentum(run(torque, form)) - angular_momentum(start())))


def rate_of_angular_momentum(torque: float, form: Form) -> Array:
    """Its time derivative [3] at the start, in the axes of body i."""
    state = start()
    s, v = state.s, state.velocity
    a = acceleration(state, torque, form) - np.linalg.pinv(MASS_MATRIX) @ gyroscopic(v)
    total = s.A_i @ (INERTIA_I @ a[PI_I]) + s.A_j @ (INERTIA_J @ a[PI_J])
    total += MASS_I * np.cross(s.pose.r_i, s.A_i @ a[R_I]) + MASS_J * np.cross(s.pose.r_j, s.A_j @ a[R_J])
    return np.asarray(s.A_i.T @ total)


def error_of_alpha_rate(form: Form) -> float:
    """Deviation of alphadot from row 3 of a form, solved for it at the velocity of the bodies, rad/s."""
    state = start()
    last = form(state.s)[5]
    return float(abs(-(last[:12] @ state.velocity[:12]) / last[12] - state.velocity[12]))


def newton_steps(form: Form) -> list[int]:
    """Steps that close the position constraint, true residual and Jacobian of a form, at most `NEWTON_LIMIT` each."""
    counts = []
    for seed in SEEDS:
        s = start(seed).s
        s = replace(s, pose=truth.turned(s.pose, NEWTON_START * numbers(Random(seed), 13), "parametric"))
        count, residual = 0, truth.parametric(s)(s.pose)
        while np.max(np.abs(residual)) > NEWTON_END and count < NEWTON_LIMIT:
            s = replace(s, pose=truth.turned(s.pose, -np.linalg.pinv(form(s)) @ residual, "parametric"))
            count, residual = count + 1, truth.parametric(s)(s.pose)
        counts.append(count)
    return counts
