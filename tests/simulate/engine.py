"""The in-line engine of ``examples/in_line_engine.toml`` as one degree of freedom, from its geometry alone.

Crank angle theta, rod angle psi with ``a sin theta + b sin psi = 0``. With ``c_k(theta)`` the centres of mass and
``phi_k(theta)`` the angles, ``m(theta) = sum m_k c_k'.c_k' + J_k phi_k'^2`` and ``V = -sum m_k g.c_k``:
``m theta'' + m' theta'^2 / 2 + V' = 0``.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]

A, B = 0.1, 0.3
MASSES = np.array([1.2, 0.8, 0.5])
INERTIAS = np.array([0.0211, 0.0061, 0.0003])
GRAVITY = np.array([0.0, -9.81])
SPEED = 15.0
"""rad/s at t = 0, where theta is 0."""


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """At [n] times; crank, rod, piston.

    Attributes:
        r: [n, 3, 2] m.
        v: [n, 3, 2] m/s.
        a: [n, 3, 2] m/s^2.
        angle: [n, 3] rad.
        omega: [n, 3] rad/s.
        omegadot: [n, 3] rad/s^2.
        energy: [n] J.
    """

    r: Array
    v: Array
    a: Array
    angle: Array
    omega: Array
    omegadot: Array
    energy: Array


def geometry(theta: Array) -> tuple[list[Array], list[Array]]:
    """Centres of mass [..., 3, 2] and angles [..., 3], with their first and second derivatives by theta."""
    s, c, o = np.sin(theta), np.cos(theta), np.zeros_like(theta)
    psi = -np.arcsin(A / B * s)
    turn = -A * c / (B * np.cos(psi))
    turn_slope = (A * s + B * np.sin(psi) * turn**2) / (B * np.cos(psi))
    angles = [np.stack(columns, -1) for columns in ((theta, psi, o), (o + 1.0, turn, o), (o, turn_slope, o))]
    arms = [A * np.stack(pair, -1) for pair in ((c, s), (-s, c), (-c, -s))]
    along, across = (np.stack(pair, -1) for pair in ((np.cos(psi), np.sin(psi)), (-np.sin(psi), np.cos(psi))))
    rods = [
        B * along,
        B * turn[..., None] * across,
        B * (turn_slope[..., None] * across - turn[..., None] ** 2 * along),
    ]
    centres = [np.stack((arm / 2, arm + rod / 2, arm + rod), -2) for arm, rod in zip(arms, rods, strict=True)]
    return centres, angles


def _acceleration(theta: Array, speed: Array) -> Array:
    (_, slope, _), (_, turn, _) = geometry(theta)
    inertia = np.sum(MASSES[:, None] * slope**2, (-2, -1)) + np.sum(INERTIAS * turn**2, -1)
    found: Array = -holding_torque(theta, speed) / inertia
    return found


def holding_torque(theta: Array, speed: Array) -> Array:
    """N m on the crank that keeps its speed: ``m' theta'^2 / 2 + V'``."""
    (_, slope, bend), (_, turn, turn_slope) = geometry(theta)
    half = np.sum(MASSES[:, None] * slope * bend, (-2, -1)) + np.sum(INERTIAS * turn * turn_slope, -1)
    push = np.sum(MASSES[:, None] * slope * GRAVITY, (-2, -1))
    found: Array = half * speed**2 - push
    return found


def truth(t: Array) -> Motion:
    """Integrate by DOP853 with a relative tolerance of 1e-13."""

    def rates(_: float, state: Array) -> Array:
        return np.array([state[1], _acceleration(state[0], state[1])])

    found = solve_ivp(rates, (0.0, t[-1]), [0.0, SPEED], "DOP853", t, rtol=1e-13, atol=1e-13)
    return motion(found.y[0], found.y[1])


def motion(theta: Array, speed: Array) -> Motion:
    """The motion at given angles and speeds of the crank."""
    (r, slope, bend), (angle, turn, turn_slope) = geometry(theta)
    second, w = _acceleration(theta, speed)[:, None], speed[:, None]
    v, omega = slope * w[..., None], turn * w
    kinetic = np.sum(MASSES[:, None] * v**2, (1, 2)) / 2 + np.sum(INERTIAS * omega**2, 1) / 2
    return Motion(
        r,
        v,
        slope * second[..., None] + bend * (w**2)[..., None],
        angle,
        omega,
        turn * second + turn_slope * w**2,
        kinetic - np.sum(MASSES[:, None] * r * GRAVITY, (1, 2)),
    )


def reactions(now: Motion) -> dict[str, Array]:
    """Forces [n, 2] N at each joint on its second body, by Newton's and Euler's laws from the piston inwards."""
    crank, rod, piston = (MASSES[k] * (now.a[:, k] - GRAVITY) for k in range(3))
    pin = 2 * now.r[:, 0]
    wrist = now.r[:, 2] - pin
    x = piston[:, 0]
    moment = INERTIAS[1] * now.omegadot[:, 1] + _cross(now.r[:, 1] - pin, rod)
    # About the crank pin: the piston pin acts on the rod with minus its force on the piston.
    y = (wrist[:, 1] * x - moment) / wrist[:, 0]
    on_piston = np.stack((x, y), -1)
    on_rod = rod + on_piston
    return {
        "piston pin": on_piston,
        "cylinder": piston - on_piston,
        "crank pin": on_rod,
        "main bearing": crank + on_rod,
    }


def _cross(arm: Array, force: Array) -> Array:
    found: Array = arm[:, 0] * force[:, 1] - arm[:, 1] * force[:, 0]
    return found
