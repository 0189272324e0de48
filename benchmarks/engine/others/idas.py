"""CasADi's idas on equations that CasADi derives: its own differentiation, its own interpreter.

The engine in absolute coordinates, index 2 after Gear, Gupta and Leimkuhler, as our conventional form; redundant rows
are left out by hand.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import casadi as ca
import numpy as np

from codegen.measure.constraints import Array
from codegen.spec.scene import Scene

SETTINGS = tuple(10.0 ** -(k / 4) for k in range(16, 41))
"""Relative and absolute tolerances, from loose to tight."""

_SCALE = 1e8
"""Of the multipliers: the one absolute tolerance that idas takes must not bind them."""

_AXIS = [0.0, 0.0, 1.0]


def ready(scene: Scene, sets: int, outputs: int) -> Callable[[float], Array]:
    """Prepare a run of 1 s."""
    dae, x0, z0 = _equations(scene, sets)
    rates = np.array(ca.Function("rates", [dae["x"], dae["z"]], [dae["ode"]])(x0, z0))[:, 0]
    times = np.linspace(0.0, 1.0, outputs + 1)

    @cache
    def integrator(tolerance: float) -> Any:
        options = {"abstol": tolerance, "reltol": tolerance, "suppress_algebraic": True, "calc_ic": False}
        options["init_xdot"] = rates.tolist()
        options["max_num_steps"] = 1_000_000
        return ca.integrator("engine", "idas", dae, 0.0, times[1:], options)

    def run(tolerance: float) -> Array:
        found = np.array(integrator(tolerance)(x0=x0, z0=z0)["xf"]).T
        states = np.vstack([x0[None], found])
        return np.stack([states[:, 13 * k : 13 * k + 2] for k in range(3)], axis=1)

    return run


def _equations(scene: Scene, sets: int) -> tuple[dict[str, Any], Array, Array]:
    """One engine, repeated; states body by body: r, p, v, omega."""
    states, odes, algebraic, zeros = [], [], [], []
    first = np.concatenate(
        [
            np.array([*b.position, *b.quaternion, *b.velocity, *b.angular_velocity], dtype=np.float64)
            for b in scene.bodies
        ]
    )
    for number in range(sets):
        x = ca.SX.sym(f"x{number}", 39)
        ode, alg, z = _engine(scene, x, number)
        states.append(x)
        odes.append(ode)
        algebraic.append(z)
        zeros.append(alg)
    start = _multipliers(states[0], odes[0], zeros[0], algebraic[0], first)
    dae = {"x": ca.vertcat(*states), "z": ca.vertcat(*algebraic), "ode": ca.vertcat(*odes), "alg": ca.vertcat(*zeros)}
    return dae, np.tile(first, sets), np.tile(start, sets)


def _multipliers(x: Any, ode: Any, alg: Any, z: Any, first: Array) -> Array:
    """Those with which velocities stay on the constraints, and mu = 0: idas does not find them itself at index 2."""
    rows = z.numel() // 2
    leaving = ca.jtimes(alg[rows:], x, ode)
    at = ca.Function("at", [x, z], [leaving, ca.jacobian(leaving, z)[:, :rows]])
    rest, slope = at(first, 0)
    found: Array = np.concatenate([np.linalg.solve(np.array(slope), -np.array(rest))[:, 0], np.zeros(rows)])
    return found


def _engine(scene: Scene, x: Any, number: int) -> tuple[Any, Any, Any]:
    r, p, v, w = ([x[13 * k + a : 13 * k + b] for k in range(3)] for a, b in ((0, 3), (3, 7), (7, 10), (10, 13)))
    shifted = [ca.SX.sym(f"d{k}", 3) for k in range(3)]
    turned = [ca.SX.sym(f"u{k}", 3) for k in range(3)]
    frames = [_rotation(p[k]) @ (ca.SX.eye(3) + ca.skew(turned[k])) for k in range(3)]
    phi = _constraints([r[k] + shifted[k] for k in range(3)], frames)
    displacement = ca.vertcat(*(ca.vertcat(shifted[k], turned[k]) for k in range(3)))
    at = [displacement, ca.SX.zeros(18)]
    jacobian = ca.substitute(ca.jacobian(phi, displacement), *at)
    phi = ca.substitute(phi, *at)
    rows = phi.numel()
    lambdas, mus = ca.SX.sym(f"lambda{number}", rows), ca.SX.sym(f"mu{number}", rows)
    force, correction = -_SCALE * jacobian.T @ lambdas, _SCALE * jacobian.T @ mus
    gravity = ca.DM([float(g) for g in scene.gravity])
    parts = []
    for k, body in enumerate(scene.bodies):
        own = slice(6 * k, 6 * k + 3), slice(6 * k + 3, 6 * k + 6)
        J = ca.DM(np.array(body.inertia, dtype=np.float64))
        turning = w[k] + correction[own[1]]
        norm = 1 - ca.dot(p[k], p[k])
        parts += [
            v[k] + correction[own[0]],
            _rate_map(p[k]).T @ turning / 2 + norm * p[k],
            force[own[0]] / float(body.mass) + gravity,
            ca.solve(J, force[own[1]] - ca.cross(w[k], J @ w[k])),
        ]
    velocity = ca.vertcat(*(ca.vertcat(v[k], w[k]) for k in range(3)))
    return ca.vertcat(*parts), ca.vertcat(phi, jacobian @ velocity), ca.vertcat(lambdas, mus)


def _constraints(r: list[Any], A: list[Any]) -> Any:
    """Main bearing, crank pin, piston pin (in the plane), cylinder."""

    def at(k: int, point: list[float]) -> Any:
        return r[k] + A[k] @ ca.DM(point)

    h = [frame @ ca.DM(_AXIS) for frame in A]
    return ca.vertcat(
        at(0, [-0.05, 0.0, 0.0]),
        h[0][:2],
        at(1, [-0.15, 0.0, 0.0]) - at(0, [0.05, 0.0, 0.0]),
        A[0][:, :2].T @ h[1],
        (r[2] - at(1, [0.15, 0.0, 0.0]))[:2],
        r[2][1:],
        h[2][:2],
        A[2][1, 0],
    )


def _rotation(p: Any) -> Any:
    w, x, y, z = ca.vertsplit(p)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return ca.vertcat(*(ca.horzcat(*row) for row in rows))


def _rate_map(p: Any) -> Any:
    w, x, y, z = ca.vertsplit(p)
    return ca.vertcat(ca.horzcat(-x, w, z, -y), ca.horzcat(-y, -z, w, x), ca.horzcat(-z, y, -x, w))
