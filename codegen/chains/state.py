"""A chain at one time: motion, efforts and reactions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import least_singular_value
from codegen.chains.mechanism import Mechanism
from codegen.chains.reduced import Reduced

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Loads:
    """What acts in a chain at one time.

    Attributes:
        tau: [n] along the coordinates in all, N or N m.
        effort: [nv] of it, what the motion needs of the independent coordinates beside the forces of the file; 0 of
            those that are not prescribed.
        reaction: [6 nr] of the cuts on their frames R, axes of R, N and N m.
        wrenches: [6 ne] at the effectors, their axes, N and N m.
        kinetic: energy, J.
        power: of gravity, forces and efforts, W.
    """

    tau: Array
    effort: Array
    reaction: Array
    wrenches: Array
    kinetic: float
    power: float


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A chain at one time.

    Attributes:
        t: s.
        q: [n] m or rad.
        qd: [n] per s.
        qdd: [n] per s^2.
        least: smallest singular value of the dependent columns of the Jacobian, relative to the largest.
        loads: None in kinematics.
    """

    t: float
    q: Array
    qd: Array
    qdd: Array
    least: float
    loads: Loads | None = None


def acting(mechanism: Mechanism, q: Array, qd: Array, active: tuple[bool, ...]) -> tuple[Array, Array]:
    """Give the forces of the file on coordinates [n], and the wrenches at the effectors [6 ne], their axes."""
    return mechanism.equations.applied(q, qd, np.array(active, dtype=np.float64))


def generalised(mechanism: Mechanism, q: Array, qd: Array, active: tuple[bool, ...]) -> Array:
    """Give the forces of the file along the coordinates [n], those at effectors included."""
    return _along(mechanism, q, *acting(mechanism, q, qd, active))


def _along(mechanism: Mechanism, q: Array, tau: Array, wrenches: Array) -> Array:
    return tau + mechanism.equations.effectors(q).T @ wrenches if mechanism.chain.effectors else tau.copy()


def loaded(
    mechanism: Mechanism,
    t: float,
    q: Array,
    found: Reduced,
    qdd_v: Array,
    active: tuple[bool, ...],
    driven: NDArray[np.bool_],
) -> State:
    """Give a state with its loads.

    Args:
        mechanism: the chain.
        t: s.
        q: [n].
        found: the chain reduced there.
        qdd_v: [nv].
        active: which conditions of switched forces hold.
        driven: [nv] independent coordinates on which efforts make the accelerations what they are.
    """
    qd, qdd = found.rates.qd, found.rates.acceleration(qdd_v)
    tau, wrenches = acting(mechanism, q, qd, active)
    force = _along(mechanism, q, tau, wrenches)
    effort = np.where(driven, found.inverse(qdd, force), 0.0)
    tau[mechanism.part.v] += effort
    force[mechanism.part.v] += effort
    reaction = found.reaction(qdd, force)
    power = float(qd @ (found.terms.f_G + force))
    loads = Loads(tau, effort, reaction, wrenches, found.kinetic_energy(), power)
    return State(t, q, qd, qdd, least_singular_value(found.rates.factor.A), loads)
