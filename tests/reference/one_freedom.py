"""Mechanisms of one degree of freedom from their closed-form geometry: generalised inertia, potential, forces.

Everything is a function of one coordinate q. Positions are written by hand; what follows from them is exact
differentiation: ``T = m(q) qd^2 / 2`` and ``m qdd + m' qd^2 / 2 + V' = Q``. Nothing here knows chains.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import sympy
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from .jets import FUNCTIONS, Jet, jet

Array = NDArray[np.float64]
q = sympy.Symbol("q", real=True)


@dataclass(frozen=True, eq=False)
class Body:
    """A rigid body that follows q.

    Attributes:
        mass: kg.
        inertia: [3, 3] about the centre of mass, body axes.
        r: [3] centre of mass, world, by q.
        A: [3, 3] body to world, by q.
    """

    mass: Any
    inertia: sympy.Matrix
    r: sympy.Matrix
    A: sympy.Matrix

    @cached_property
    def _place(self) -> Callable[[Jet], list[Any]]:
        place: Callable[[Jet], list[Any]] = sympy.lambdify(q, [*self.r, *self.A], modules=[FUNCTIONS], cse=True)
        return place

    def motion(self, at: float) -> list[Array]:
        """r, r', r'', A, A', A'' at q."""
        jets = [jet(entry) for entry in self._place(Jet(float(at), 1.0))]
        columns = [np.array([getattr(one, part) for one in jets]) for part in ("f", "d", "dd")]
        return [values[:3] for values in columns] + [values[3:].reshape(3, 3) for values in columns]

    def terms(self, at: float) -> tuple[float, float, Array, Array]:
        """Twice the kinetic energy for qd = 1 with its slope; r and r'."""
        r, dr, ddr, A, dA, ddA = self.motion(at)
        w, dw = vee(A.T @ dA), vee(A.T @ ddA + dA.T @ dA)
        inertia, mass = np.array(self.inertia, dtype=np.float64), float(self.mass)
        m = mass * float(dr @ dr) + float(w @ inertia @ w)
        return m, 2 * (mass * float(dr @ ddr) + float(w @ inertia @ dw)), r, dr


def vee(W: Array) -> Array:
    """[3] of a skew matrix."""
    return np.array([W[2, 1] - W[1, 2], W[0, 2] - W[2, 0], W[1, 0] - W[0, 1]]) / 2


def plane(angle: Any) -> sympy.Matrix:
    """A turn about z."""
    c, s = sympy.cos(angle), sympy.sin(angle)
    return sympy.Matrix([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def about_z(moment: Any) -> sympy.Matrix:
    """An inertia of which only the moment about z acts."""
    return sympy.diag(1, 1, moment)


def values(*expressions: Any) -> Callable[[Any], Any]:
    """Numbers of expressions in q, sub-expressions shared."""
    found: Callable[[Any], Any] = sympy.lambdify(q, list(expressions), modules="numpy", cse=True)
    return found


@dataclass(frozen=True, eq=False)
class OneFreedom:
    """A mechanism of one coordinate.

    Attributes:
        bodies: by their names.
        gravity: [3] m/s^2.
        outputs: further functions of q whose first and second derivative are of interest, by their names.
    """

    bodies: Mapping[str, Body]
    gravity: Sequence[Any]
    outputs: Mapping[str, Any]

    def inertia(self, at: Any) -> tuple[Any, Any, Any, Any]:
        """``m``, ``m'``, ``V`` and ``V'`` at q, or at each of several."""
        if np.ndim(at):
            m, dm, V, dV = np.array([self.inertia(one) for one in np.ravel(at)]).T
            return m, dm, V, dV
        g = np.array(self.gravity, dtype=np.float64)
        found = np.zeros(4)
        for body in self.bodies.values():
            m, dm, r, dr = body.terms(float(at))
            found += np.array([m, dm, -float(body.mass * (r @ g)), -float(body.mass * (dr @ g))])
        return tuple(map(float, found))  # type: ignore[return-value]

    @cached_property
    def _outputs(self) -> dict[str, Callable[[Any], Any]]:
        return {name: values(f, f.diff(q), f.diff(q, 2)) for name, f in self.outputs.items()}

    def output(self, name: str, at: Any, qd: Any, qdd: Any = 0.0) -> tuple[Any, Any, Any]:
        """Value, rate and acceleration of an output."""
        f, df, ddf = self._outputs[name](at)
        return f, df * qd, ddf * qd**2 + df * qdd

    def effort(self, at: Any, qd: Any, qdd: Any, generalised: Any = 0.0) -> Any:
        """What must act on q for a motion, beside gravity and a generalised force."""
        m, dm, _, dV = self.inertia(at)
        return m * qdd + dm * qd**2 / 2 + dV - generalised

    def acceleration(self, at: Any, qd: Any, generalised: Any) -> Any:
        """``qdd`` under a generalised force."""
        m, dm, _, dV = self.inertia(at)
        return (generalised - dm * qd**2 / 2 - dV) / m

    def energy(self, at: Any, qd: Any) -> Any:
        """Kinetic and potential energy, J."""
        m, _, V, _ = self.inertia(at)
        return m * qd**2 / 2 + V

    def motion(self, q0: float, qd0: float, times: Array, generalised: Callable[[float, float], float]) -> Array:
        """Integrate by DOP853 at 1e-13.

        Args:
            q0: at times[0].
            qd0: at times[0].
            times: ascending.
            generalised: force by q and qd, smooth.

        Returns:
            [n, 2] q and qd.
        """

        def rate(_: float, y: Array) -> Array:
            return np.array([y[1], self.acceleration(y[0], y[1], generalised(y[0], y[1]))])

        tight = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-13}
        found = solve_ivp(rate, (times[0], times[-1]), [q0, qd0], t_eval=times, **tight)
        assert found.success
        return np.asarray(found.y.T)

    def speed_by_energy(self, q0: float, qd0: float, at: Any, work: Any) -> Any:
        """``qd`` at q from the energy integral, for a coordinate that goes on growing.

        Args:
            q0: start.
            qd0: rate there.
            at: q.
            work: done from q0 to q beside gravity, J.
        """
        m, _, V, _ = self.inertia(at)
        return np.sqrt(2 * (self.energy(q0, qd0) + work - V) / m)
