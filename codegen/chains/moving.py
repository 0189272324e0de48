"""A chain in motion: its integrated variables (q_v, qd_v, work) give all else, on the branch that is remembered."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RankLoss
from codegen.chains.mechanism import Mechanism
from codegen.chains.path import Branch, PathEnd, follow
from codegen.chains.reduced import Reduced, reduced
from codegen.chains.state import State, generalised, loaded
from codegen.chains.stop import free_words, path_words
from codegen.chains.switches import Switch, active

Array = NDArray[np.float64]

FURTHEST = 0.25
"""rad, or characteristic lengths: an independent coordinate moves by about as much in a step, at most."""


class Moving:
    """The chain by its integrated variables; remembers the branch."""

    def __init__(self, mechanism: Mechanism, start: Branch, found: tuple[Switch, ...]) -> None:
        self.mechanism, self.here, self.switches = mechanism, start, found
        self.is_on: tuple[bool, ...] = ()
        self._last: tuple[Array, Reduced] | None = None
        self.failure = ""
        self.evaluations = 0
        self.events_met = 0

    @property
    def active(self) -> tuple[bool, ...]:
        """Which conditions hold."""
        return active(self.switches, self.is_on, len(self.mechanism.forces.conditions))

    def at(self, y: Array) -> Reduced:
        """The chain reduced where it is; the last one is remembered.

        Raises:
            PathEnd: the branch ends before.
            RankLoss: the pose is singular.
        """
        nv = len(self.mechanism.part.v)
        if self._last is None or not np.array_equal(self._last[0], y[: 2 * nv]):
            self.here = follow(self.mechanism.equations, self.mechanism.part, self.here, y[:nv])
            found = reduced(self.mechanism.equations, self.mechanism.part, self.here.q, y[nv : 2 * nv])
            self._last = y[: 2 * nv].copy(), found
        return self._last[1]

    def acceleration(self, found: Reduced) -> tuple[Array, float]:
        """Accelerations of the independent coordinates, and the power of all forces."""
        qd = found.rates.qd
        force = generalised(self.mechanism, self.here.q, qd, self.active)
        return found.forward(force), float(qd @ (found.terms.f_G + force))

    def rate(self, t: float, y: Array) -> Array:
        """Right-hand side; what is no number makes the integrator take a smaller step."""
        self.evaluations += 1
        nv = len(self.mechanism.part.v)
        try:
            qdd_v, power = self.acceleration(self.at(y))
        except PathEnd as end:
            self.failure = path_words(self.mechanism, end)
            return np.full(len(y), np.nan)
        except RankLoss as loss:
            self.failure = f"singular pose: {free_words(self.mechanism, loss)}"
            return np.full(len(y), np.nan)
        return np.concatenate([y[nv : 2 * nv], qdd_v, [power]])

    def value(self, k: int, y: Array) -> float:
        """What is positive while a switch is on."""
        found, switch = self.at(y), self.switches[k]
        return switch.value(self.here.q[switch.coordinate], found.rates.qd[switch.coordinate])

    def slope(self, k: int, y: Array) -> float:
        """Its rate."""
        found, switch = self.at(y), self.switches[k]
        qdd = found.rates.acceleration(self.acceleration(found)[0])
        return switch.rate(found.rates.qd[switch.coordinate], qdd[switch.coordinate])

    def crossed(self, y: Array) -> list[int]:
        """Switches that are not as they were told to be."""
        return [k for k, on in enumerate(self.is_on) if (self.value(k, y) < 0 if on else self.value(k, y) > 0)]

    def reach(self, y: Array) -> float:
        """Time in which no independent coordinate moves by more than `FURTHEST`."""
        nv, part = len(self.mechanism.part.v), self.mechanism.part
        fastest = float(np.max(np.abs(y[nv : 2 * nv] / part.units[part.v]), initial=0.0))
        return FURTHEST / fastest if fastest else np.inf

    def state(self, t: float, y: Array) -> State:
        """The chain at an output."""
        found = self.at(y)
        qdd_v, _ = self.acceleration(found)
        return loaded(self.mechanism, t, self.here.q, found, qdd_v, self.active, is_driven=False)

    def switch(self, k: int) -> None:
        """Change a switch that an event told."""
        self.is_on = tuple(on != (place == k) for place, on in enumerate(self.is_on))
        self.events_met += 1
