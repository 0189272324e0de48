"""A chain as numbers by 4x4 transforms and a table, in world axes: independent of what is generated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from codegen.chains.equations import Closure, Terms
from codegen.chains.partition import Partition
from codegen.chains.switches import Switch
from codegen.spec.chain import BASE, Chain, Frame, Row
from codegen.spec.chain_forces import WorldForce

Array = NDArray[np.float64]


def screw_z(angle: float, shift: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, shift], [0, 0, 0, 1.0]])


def screw_x(angle: float, shift: float) -> Array:
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0, shift], [0, c, -s, 0], [0, s, c, 0], [0, 0, 0, 1.0]])


def cross(a: Array) -> Array:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0.0]])


class Table:
    """The chain at one state: frames, and velocities and accelerations of their origins, world axes.

    Every frame has T [4, 4], D [6, n] (linear, angular), c [6] the acceleration without qdd, and its angular velocity.
    """

    def __init__(self, chain: Chain, q: Array, qd: Array) -> None:
        self.chain, self.q, self.qd, self.n = chain, q, qd, len(chain.links)
        self.frames = {BASE: (np.eye(4), np.zeros((6, self.n)), np.zeros(6))}
        for k, link in enumerate(chain.links):
            self.frames[link.name] = self._joint(self.frames[link.parent], link.row, k, link.type == "prismatic")

    def fixed(self, frame: Frame) -> tuple[Array, Array, Array]:
        T0, D0, c0 = self.frames[frame.link]
        row = frame.row
        T = T0 @ self._row(row, float(row.theta), float(row.d))
        return T, *self._carried(T0, D0, c0, T[:3, 3] - T0[:3, 3])

    def _joint(self, parent: tuple[Array, Array, Array], row: Row, k: int, is_prismatic: bool) -> tuple[Array, ...]:
        T0, D0, c0 = parent
        theta, d = (float(row.theta), self.q[k]) if is_prismatic else (self.q[k], float(row.d))
        T = T0 @ self._row(row, theta, d)
        D, c = self._carried(T0, D0, c0, T[:3, 3] - T0[:3, 3])
        z, w, rate = T[:3, 2], D0[3:] @ self.qd, self.qd[k]
        if is_prismatic:
            D[:3, k] += z
            c[:3] += 2 * np.cross(w, z * rate)
        else:
            D[3:, k] += z
            c[3:] += np.cross(w, z * rate)
        return T, D, c

    @staticmethod
    def _row(row: Row, theta: float, d: float) -> Array:
        return screw_z(float(row.psi), float(row.c)) @ screw_x(float(row.alpha), float(row.a)) @ screw_z(theta, d)

    def _carried(self, T0: Array, D0: Array, c0: Array, p: Array) -> tuple[Array, Array]:
        w = D0[3:] @ self.qd
        D, c = D0.copy(), c0.copy()
        D[:3] -= cross(p) @ D0[3:]
        c[:3] += np.cross(c0[3:], p) + np.cross(w, np.cross(w, p))
        return D, c


class TableEquations:
    """`codegen.chains.equations.Equations` of a chain by its table."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain

    def closure(self, q: Array) -> Closure:
        table = Table(self.chain, q, np.zeros(len(q)))
        found: list[list[Array]] = [[], [], [], []]
        for cut in self.chain.cuts:
            (TC, DC, _), (TR, DR, _) = table.fixed(cut.base), table.fixed(cut.far)
            RC = TC[:3, :3].T
            p = RC @ (TR[:3, 3] - TC[:3, 3])
            parts = (p, RC @ TR[:3, :3], RC @ (DR - DC)[:3] + cross(p) @ RC @ DC[3:], RC @ (DR - DC)[3:])
            for values, part in zip(found, parts, strict=True):
                values.append(part)
        n = len(q)
        shapes = ((0, 3), (0, 3, 3), (0, 3, n), (0, 3, n))
        return Closure(*(np.array(v) if v else np.zeros(s) for v, s in zip(found, shapes, strict=True)))

    def constraint(self, q: Array) -> None:
        """It is found from the closure."""

    @property
    def binding(self) -> tuple[bool, ...]:
        """Rows that move at some pose."""
        rng = np.random.default_rng(0)
        moved = [self.jacobian(rng.normal(size=len(self.chain.links))) for _ in range(3)]
        return tuple(bool(x) for x in np.max(np.abs(moved), axis=(0, 2)) > 1e-9)

    def gamma(self, q: Array, qd: Array) -> Array:
        return self.terms(q, qd).gamma

    def jacobian(self, q: Array) -> Array:
        closure = self.closure(q)
        return np.concatenate(
            [np.zeros((0, len(q))), *(part for pair in zip(closure.dp, closure.W, strict=True) for part in pair)]
        )

    def code(self, part: Partition, is_driven: NDArray[np.bool_], switches: Sequence[Switch]) -> None:
        """Nothing is compiled."""

    def terms(self, q: Array, qd: Array) -> Terms:
        n, table = len(q), Table(self.chain, q, qd)
        gamma = [np.zeros(0)]
        for cut in self.chain.cuts:
            (TC, _, cC), (_, _, cR) = table.fixed(cut.base), table.fixed(cut.far)
            gamma.append(np.kron(np.eye(2), TC[:3, :3].T) @ (cR - cC))
        M, f_C, f_G = np.zeros((n, n)), np.zeros(n), np.zeros(n)
        g = np.array([float(x) for x in self.chain.gravity])
        for k, link in enumerate(self.chain.links):
            M[k, k] += float(link.rotor)
            T, D, c = table.frames[link.name]
            R, m = T[:3, :3], float(link.mass)
            I = R @ np.array([[float(x) for x in row] for row in link.inertia]) @ R.T
            Dm, cm = table._carried(T, D, c, R @ np.array([float(x) for x in link.centre]))
            w = D[3:] @ qd
            M += m * Dm[:3].T @ Dm[:3] + D[3:].T @ I @ D[3:]
            f_C += m * Dm[:3].T @ cm[:3] + D[3:].T @ (I @ c[3:] + np.cross(w, I @ w))
            f_G += m * Dm[:3].T @ g
        return Terms(np.concatenate(gamma), M, f_C, f_G)

    def applied(self, q: Array, qd: Array, on: Array) -> tuple[Array, Array]:
        """Constants, springs and dampers of coordinates, and constants at effectors."""
        assert not (self.chain.springs or self.chain.stops)
        tau, numbers = np.zeros(len(q)), {e.name: k for k, e in enumerate(self.chain.effectors)}
        table, switches = Table(self.chain, q, qd), iter(on)
        for force in self.chain.joint_forces:
            k, share = self.chain.index(force.joint), 1.0 if force.when is None else next(switches)
            tau[k] += share * (float(force.constant) - float(force.damping) * qd[k])
            tau[k] -= share * float(force.stiffness) * (q[k] - float(force.rest))
        wrenches = np.array([[*e.force, *e.moment] for e in self.chain.effectors], dtype=np.float64).reshape(-1, 6)
        for wrench in (*self.chain.effector_forces, *self.chain.world_forces):
            k, share = numbers[wrench.effector], 1.0 if wrench.when is None else next(switches)
            frame = table.fixed(self.chain.effectors[k].frame)[0][:3, :3]
            back = frame.T if isinstance(wrench, WorldForce) else np.eye(3)
            for part, values in enumerate((wrench.force, wrench.moment)):
                wrenches[k, 3 * part : 3 * part + 3] += share * back @ np.array(values, dtype=np.float64)
        return tau, wrenches.ravel()

    def effectors(self, q: Array) -> Array:
        table = Table(self.chain, q, np.zeros(len(q)))
        rows = [np.zeros((0, len(q)))]
        for effector in self.chain.effectors:
            T, D, _ = table.fixed(effector.frame)
            rows.append(np.kron(np.eye(2), T[:3, :3].T) @ D)
        return np.concatenate(rows)
