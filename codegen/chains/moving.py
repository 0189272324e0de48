"""A chain in motion: its integrated variables and drives give all else, on the branch that is remembered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RankLoss
from codegen.chains.mechanism import Mechanism
from codegen.chains.motion import Drives
from codegen.chains.path import Branch, PathEnd, follow
from codegen.chains.reduced import Reduced, reduced
from codegen.chains.state import State, generalised, loaded
from codegen.chains.stop import free_words, path_words
from codegen.chains.switches import Switch, active

Array = NDArray[np.float64]

FURTHEST = 0.25
"""rad, or characteristic lengths: an independent coordinate moves by about as much in a step, at most."""


class Moving:
    """The chain by its integrated variables ``(q_f, qd_f, work)``, f the free coordinates; remembers the branch.

    Args:
        mechanism: the chain.
        start: closed pose at the start.
        found: switches of its forces.
        drives: motions of the other independent coordinates.
    """

    def __init__(self, mechanism: Mechanism, start: Branch, found: tuple[Switch, ...], drives: Drives) -> None:
        self.mechanism, self.here, self.switches, self.drives = mechanism, start, found, drives
        self.is_on: tuple[bool, ...] = ()
        self._last: tuple[Array, Reduced] | None = None
        self.failure = ""
        self.evaluations = 0
        self.events_met = 0

    @property
    def active(self) -> tuple[bool, ...]:
        """Which conditions hold."""
        return active(self.switches, self.is_on, len(self.mechanism.forces.conditions))

    @property
    def units(self) -> Array:
        """Units of the free coordinates."""
        return np.asarray(self.mechanism.part.units[self.mechanism.part.v][~self.drives.is_driven])

    def _independent(self, t: float, y: Array) -> tuple[Array, Array]:
        """``q_v`` and ``qd_v``, driven and free."""
        driven = self.drives.is_driven
        size = len(y) // 2
        q_v, qd_v = np.empty(len(driven)), np.empty(len(driven))
        q_v[~driven], qd_v[~driven] = y[:size], y[size : 2 * size]
        q_v[driven], qd_v[driven], _ = self.drives.at(t)
        return q_v, qd_v

    def at(self, t: float, y: Array) -> Reduced:
        """The chain reduced where it is; the last one is remembered.

        Raises:
            PathEnd: the branch ends before.
            RankLoss: the pose is singular.
        """
        q_v, qd_v = self._independent(t, y)
        where = np.concatenate([q_v, qd_v])
        if self._last is None or not np.array_equal(self._last[0], where):
            self.here = follow(self.mechanism.equations, self.mechanism.part, self.here, q_v)
            found = reduced(self.mechanism.equations, self.mechanism.part, self.here.q, qd_v)
            self._last = where, found
        return self._last[1]

    def acceleration(self, t: float, found: Reduced) -> tuple[Array, float]:
        """Accelerations of the independent coordinates, and the power of all forces and drives."""
        qd, driven = found.rates.qd, self.drives.is_driven
        force = generalised(self.mechanism, self.here.q, qd, self.active)
        qdd_v = found.forward(force, driven, self.drives.at(t)[2])
        power = float(qd @ (found.terms.f_G + force))
        if driven.any():
            effort = found.inverse(found.rates.acceleration(qdd_v), force)
            power += float(qd[self.mechanism.part.v][driven] @ effort[driven])
        return qdd_v, power

    def rate(self, t: float, y: Array) -> Array:
        """Right-hand side; what is no number makes the integrator take a smaller step."""
        self.evaluations += 1
        size = len(y) // 2
        try:
            qdd_v, power = self.acceleration(t, self.at(t, y))
        except PathEnd as end:
            self.failure = path_words(self.mechanism, end)
            return np.full(len(y), np.nan)
        except RankLoss as loss:
            self.failure = f"singular pose: {free_words(self.mechanism, loss)}"
            return np.full(len(y), np.nan)
        return np.concatenate([y[size : 2 * size], qdd_v[~self.drives.is_driven], [power]])

    def value(self, k: int, t: float, y: Array) -> float:
        """What is positive while a switch is on."""
        found, switch = self.at(t, y), self.switches[k]
        return switch.value(self.here.q[switch.coordinate], found.rates.qd[switch.coordinate])

    def slope(self, k: int, t: float, y: Array) -> float:
        """Its rate."""
        found, switch = self.at(t, y), self.switches[k]
        qdd = found.rates.acceleration(self.acceleration(t, found)[0])
        return switch.rate(found.rates.qd[switch.coordinate], qdd[switch.coordinate])

    def crossed(self, t: float, y: Array) -> list[int]:
        """Switches that are not as they were told to be."""
        values = [self.value(k, t, y) for k in range(len(self.is_on))]
        return [
            k for k, (on, value) in enumerate(zip(self.is_on, values, strict=True)) if (value < 0 if on else value > 0)
        ]

    def reach(self, t: float, y: Array) -> float:
        """Time in which no independent coordinate moves by more than `FURTHEST`, and no motion is overlooked."""
        part = self.mechanism.part
        fastest = float(np.max(np.abs(self._independent(t, y)[1] / part.units[part.v]), initial=0.0))
        return min(FURTHEST / fastest if fastest else np.inf, self.drives.longest)

    def state(self, t: float, y: Array) -> State:
        """The chain at an output."""
        found = self.at(t, y)
        qdd_v, _ = self.acceleration(t, found)
        return loaded(self.mechanism, t, self.here.q, found, qdd_v, self.active, self.drives.is_driven)

    def switch(self, k: int) -> None:
        """Change a switch that an event told."""
        self.is_on = tuple(on != (place == k) for place, on in enumerate(self.is_on))
        self.events_met += 1
