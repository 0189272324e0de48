"""An independent account of a chain: 4 x 4 transforms as power series in time, multiplied out; no recursion.

The pose of every frame is a polynomial of degree 2 in t while the coordinates move as ``q + qd t + qdd t^2 / 2``; its
derivatives are read off. Coordinates may be complex, for complex-step derivatives.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from codegen.spec.chain import BASE, Chain, Link, Row

Series = np.ndarray
"""[3, 4, 4]: coefficients of 1, t, t^2."""


def product(a: Series, b: Series) -> Series:
    return np.array([a[0] @ b[0], a[0] @ b[1] + a[1] @ b[0], a[0] @ b[2] + a[1] @ b[1] + a[2] @ b[0]])


def screw_z(angle, shift) -> Series:
    """Screw(z, angle, shift) of two series of scalars."""
    (a0, a1, a2), (d0, d1, d2) = angle, shift
    c, s = np.cos(a0), np.sin(a0)
    found = np.zeros((3, 4, 4), complex)
    cosines = (c, -s * a1, -s * a2 - c * a1 * a1 / 2)
    sines = (s, c * a1, c * a2 - s * a1 * a1 / 2)
    for k in range(3):
        found[k, 0, 0] = found[k, 1, 1] = cosines[k]
        found[k, 1, 0], found[k, 0, 1] = sines[k], -sines[k]
    found[:, 2, 3] = d0, d1, d2
    found[0, 2, 2] = found[0, 3, 3] = 1
    return found


def screw_x(angle: float, shift: float) -> Series:
    c, s = math.cos(angle), math.sin(angle)
    found = np.zeros((3, 4, 4), complex)
    found[0] = [[1, 0, 0, shift], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1]]
    return found


def placed(row: Row, angle=None, shift=None) -> Series:
    """T of a row; angle or shift in the place of the constant theta or d."""
    theta = (float(row.theta), 0, 0) if angle is None else angle
    d = (float(row.d), 0, 0) if shift is None else shift
    first = screw_z((float(row.psi), 0, 0), (float(row.c), 0, 0))
    return product(product(first, screw_x(float(row.alpha), float(row.a))), screw_z(theta, d))


@dataclass
class Moving:
    """The frames of a chain in motion.

    Attributes:
        links: name -> series, with the base.
        cuts: (C, R) of each cut.
        effectors: E frames.
    """

    links: dict[str, Series]
    cuts: list[tuple[Series, Series]]
    effectors: list[Series]


def _driven(link: Link, motion) -> dict:
    """What the coordinate of a link turns and shifts."""
    if link.type != "screw":
        return {"angle" if link.type == "revolute" else "shift": motion}
    first, pitch = float(link.row.d - link.pitch * link.row.theta), float(link.pitch)
    return {"angle": motion, "shift": tuple(pitch * x + (first if k == 0 else 0) for k, x in enumerate(motion))}


def move(chain: Chain, q, qd, qdd, base: Series | None = None) -> Moving:
    still = np.zeros((3, 4, 4), complex)
    still[0] = np.eye(4)
    links = {BASE: still if base is None else base}
    for k, link in enumerate(chain.links):
        motion = q[k], qd[k], qdd[k] / 2
        hung = placed(link.row, **_driven(link, motion))
        links[link.name] = product(links[link.parent], hung)
    hang = lambda frame: product(links[frame.link], placed(frame.row))  # noqa: E731
    cuts = [(hang(cut.base), hang(cut.far)) for cut in chain.cuts]
    return Moving(links, cuts, [hang(effector.frame) for effector in chain.effectors])


def vee(matrix):
    return np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]]) / 2


def spin(series: Series):
    """Angular velocity and acceleration, world."""
    R, first, second = (series[k, :3, :3] for k in range(3))
    return vee(first @ R.T), vee(2 * second @ R.T + first @ first.T)


def twist(series: Series):
    """Velocity, angular velocity, acceleration and angular acceleration of a frame, its own axes."""
    R = series[0, :3, :3]
    w, e = spin(series)
    return np.concatenate([R.T @ x for x in (series[1, :3, 3], w, 2 * series[2, :3, 3], e)])


def relative(C: Series, R: Series) -> Series:
    """R in the frame C."""
    inverse = np.zeros_like(C)
    for k in range(3):
        inverse[k, :3, :3] = C[k, :3, :3].T
    for n in range(3):
        inverse[n, :3, 3] = -sum(C[k, :3, :3].T @ C[n - k, :3, 3] for k in range(n + 1))
    inverse[0, 3, 3] = 1
    return product(inverse, R)


def constraint(pose):
    """(p; 2e) of one relative pose, e_0 >= 0."""
    root = np.sqrt(1 + np.trace(pose[:3, :3]))
    return np.concatenate([pose[:3, 3], 2 * vee(pose[:3, :3]) / root])


class Account:
    """Every quantity of a chain in one state."""

    def __init__(self, chain: Chain, q, qd=None, qdd=None, base: Series | None = None) -> None:
        self.chain, self.size = chain, len(chain.links)
        self.q = np.asarray(q, complex)
        none = np.zeros(self.size)
        self.qd, self.qdd = (none if x is None else np.asarray(x, float) for x in (qd, qdd))
        self.base = base

    def moving(self, qd=None, qdd=None, q=None) -> Moving:
        none = np.zeros(self.size)
        qd, qdd = (none if x is None else x for x in (qd, qdd))
        return move(self.chain, self.q if q is None else q, qd, qdd, self.base)

    def frames(self):
        found = self.moving()
        series = [found.links[link.name] for link in self.chain.links]
        series += [C for C, _ in found.cuts] + [R for _, R in found.cuts] + found.effectors
        return np.concatenate([s[0, :3, :].T.ravel() for s in series]).real

    def closure(self):
        return np.concatenate([relative(C, R)[0, :3, :].T.ravel() for C, R in self.moving().cuts]).real

    def phi(self, q=None):
        return np.concatenate([constraint(relative(C, R)[0]) for C, R in self.moving(q=q).cuts])

    def phi_q(self):
        step = 1e-30
        turned = (self.phi(self.q + 1j * step * unit).imag / step for unit in np.eye(self.size))
        return np.array(list(turned)).T

    def J(self):
        """Velocity and angular velocity of R relative to C for unit rates, axes of C; the base at rest."""
        columns = []
        for unit in np.eye(self.size):
            relatives = [relative(C, R) for C, R in self._at_rest(unit).cuts]
            columns.append(np.concatenate([np.concatenate([s[1, :3, 3], spin(s)[0]]) for s in relatives]))
        return np.array(columns).T.real

    def _at_rest(self, qd, qdd=None) -> Moving:
        return move(self.chain, self.q, qd, np.zeros(self.size) if qdd is None else qdd)

    def gamma_R(self):
        """Second derivative of the relative pose while no joint accelerates."""
        relatives = [relative(C, R) for C, R in self._at_rest(self.qd).cuts]
        return np.concatenate([np.concatenate([2 * s[2, :3, 3], spin(s)[1]]) for s in relatives]).real

    def _power(self, qd, qdd, gravity):
        """d'Alembert: inertia forces and gravity of all links by the virtual velocities of each joint."""
        actual = self.moving(qd, qdd)
        virtual = [self._virtual(unit) for unit in np.eye(self.size)]
        total = np.zeros(self.size)
        for link in self.chain.links:
            m, c = float(link.mass), np.array([*map(float, link.centre), 1.0])
            s = actual.links[link.name]
            force = m * (2 * s[2] @ c)[:3] - m * np.asarray(gravity)
            torque = angular_momentum_rate(s, np.array(link.inertia, float))
            for k, moved in enumerate(virtual):
                v = moved[link.name]
                total[k] += (force @ (v[1] @ c)[:3] + torque @ spin(v)[0]).real
        return total

    def _virtual(self, unit):
        base = None
        if self.base is not None:
            base = np.zeros_like(self.base)
            base[0] = self.base[0]
        return move(self.chain, self.q, unit, np.zeros(self.size), base).links

    def M(self):
        none, still = np.zeros(self.size), Account(self.chain, self.q, base=self._held())
        return np.array([still._power(none, unit, np.zeros(3)) for unit in np.eye(self.size)]).T

    def _held(self):
        if self.base is None:
            return None
        held = np.zeros_like(self.base)
        held[0] = self.base[0]
        return held

    def f_C(self):
        return self._power(self.qd, np.zeros(self.size), np.zeros(3))

    def f_G(self):
        still = Account(self.chain, self.q, base=self._held())
        return -still._power(np.zeros(self.size), np.zeros(self.size), np.array(self.chain.gravity, float))

    def D_E(self):
        columns = [
            np.concatenate([twist(E)[:6] for E in move(self.chain, self.q, unit, 0 * unit).effectors])
            for unit in np.eye(self.size)
        ]
        return np.array(columns).T.real

    def effectors(self):
        return np.concatenate([twist(E) for E in self.moving(self.qd, self.qdd).effectors]).real

    def tau_A(self):
        """Forces and stops along the coordinates."""
        found = np.zeros(self.size)
        for force in self.chain.joint_forces:
            k = self.chain.index(force.joint)
            if force.when is None:
                found[k] += float(force.constant) - float(force.stiffness) * (self.q[k].real - float(force.rest))
                found[k] -= float(force.damping) * self.qd[k]
        for stop in self.chain.stops:
            k = self.chain.index(stop.joint)
            found[k] += stopped(stop.limit, self.q[k].real, self.qd[k])
        return found

    def f_A(self):
        """Wrenches at the effectors: constants, and springs by their lengths as power series."""
        ends, numbers = self.moving(self.qd).effectors, {e.name: k for k, e in enumerate(self.chain.effectors)}
        found = np.array([[*e.force, *e.moment] for e in self.chain.effectors], float)
        for force in (one for one in self.chain.effector_forces if one.when is None):
            found[numbers[force.effector]] += np.array([*force.force, *force.moment], float)
        for force in self.chain.world_forces:
            back = ends[numbers[force.effector]][0, :3, :3].T.real
            turned = [back @ np.array(part, float) for part in (force.force, force.moment)]
            found[numbers[force.effector]] += np.concatenate(turned)
        for spring in self.chain.springs:
            i, j = (numbers[name] for name in spring.effectors)
            gap, rate = ((ends[j] - ends[i])[k, :3, 3].real for k in (0, 1))
            length = np.linalg.norm(gap)
            tension = float(spring.stiffness) * (length - float(spring.length))
            tension += float(spring.damping) * (rate @ gap / length)
            found[i, :3] += ends[i][0, :3, :3].T.real @ gap * tension / length
            found[j, :3] -= ends[j][0, :3, :3].T.real @ gap * tension / length
        return found.ravel()


def stopped(limit, q, qd):
    """What a soft stop gives: ``k (x + rho) / 2`` against the way beyond it, and its share of the damper."""
    force = 0.0
    for bound, sense in ((limit.upper, 1), (limit.lower, -1)):
        if bound is not None:
            x = sense * (q - float(bound))
            rho = np.hypot(x, 1e-4)
            force -= sense * float(limit.stiffness) * (x + rho) / 2
            force -= float(limit.damping) * (1 + x / rho) / 2 * qd
    return force


def angular_momentum_rate(series: Series, inertia):
    """d/dt of ``R I R^T w``, world."""
    R, first = series[0, :3, :3], series[1, :3, :3]
    w, e = spin(series)
    world, rate = R @ inertia @ R.T, first @ inertia @ R.T + R @ inertia @ first.T
    return world @ e + rate @ w
