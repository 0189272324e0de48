"""A chain in motion: its integrated variables and drives give all else, on the branch that is remembered.

Where there is compiled code it is taken, and what it refuses is done here, step by step, so that it can be told.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from codegen.chains.exchange import bound, exchanged, steepest
from codegen.chains.factor import RankLoss, least_singular_value
from codegen.chains.mechanism import Mechanism
from codegen.chains.motion import Drives
from codegen.chains.path import Branch, PathEnd, branch, follow
from codegen.chains.position import close
from codegen.chains.rate_code import FURTHEST
from codegen.chains.rate_solver import RateSolver
from codegen.chains.reduced import Reduced, reduced
from codegen.chains.state import State, generalised, loaded
from codegen.chains.stop import free_words, path_words, short_words
from codegen.chains.switches import Switch, active

Array = NDArray[np.float64]

_BEYOND = 0.01
"""rad, or characteristic lengths."""


class Moving:
    """The chain by its integrated variables ``(q_f, qd_f, work)``, f the free coordinates; remembers the branch.

    Args:
        mechanism: the chain.
        start: closed pose at the start.
        found: switches of its forces.
        drives: motions of the other independent coordinates.
    """

    def __init__(self, mechanism: Mechanism, start: Branch, found: tuple[Switch, ...], drives: Drives) -> None:
        self.switches, self.drives = found, drives
        self.is_on: tuple[bool, ...] = (False,) * len(found)
        self._told: Callable[[], str] = str
        self.evaluations = self.steps = self.events_met = self.exchanges = 0
        self._take(mechanism, start)

    def _take(self, mechanism: Mechanism, start: Branch) -> None:
        """Go on from a pose by the independent coordinates of a mechanism."""
        drives = self.drives
        self.mechanism, self._here = mechanism, start
        self._steepest = bound(start.slope, drives.is_driven)
        self._last: tuple[Array, Reduced] | None = None
        self._code = mechanism.equations.code(mechanism.part, drives.is_driven, self.switches)
        self._has_entered = self._is_ahead = False
        self._rates: tuple[Array, Array | None] = (np.zeros(0), None)
        self._before = 0 if self._code is None else self._code.iterations
        if self._code is not None:
            self._code.drive(lambda t: np.concatenate(drives.at(t)), drives.longest)

    @property
    def is_compiled(self) -> bool:
        """Whether there is compiled code."""
        return self._code is not None

    @property
    def iterations(self) -> int:
        """Of Newton's method."""
        return self._here.iterations + (0 if self._code is None else self._code.iterations - self._before)

    @property
    def here(self) -> Branch:
        """The last pose."""
        if self._is_ahead and self._code is not None:
            found = close(self.mechanism.equations, self.mechanism.part, self._code.q)
            last, self._is_ahead = branch(self.mechanism.part, found), False
            done = self._here.iterations + last.iterations
            self._here = replace(last, orientation=self._here.orientation, iterations=done)
        return self._here

    @property
    def active(self) -> tuple[bool, ...]:
        """Which conditions hold."""
        return active(self.switches, self.is_on, len(self.mechanism.conditions.conditions))

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
            before = self.here.q
            self._here = follow(self.mechanism.equations, self.mechanism.part, self.here, q_v)
            self._has_entered = self._has_entered and np.array_equal(self._here.q, before)
            self._last = where, reduced(self.mechanism.equations, self.mechanism.part, self._here.q, qd_v)
        return self._last[1]

    def _compiled(self, t: float, y: Array) -> Array | None:
        """Rates by the compiled code, which is then where they are; None if there is none, or it refuses."""
        code = self._code
        if code is None:
            return None
        where = np.array([t, *y])
        if not np.array_equal(where, self._rates[0]):
            self._has_entered = self._has_entered or code.enter(self.here.q, self.here.factor.A, self._steepest)
            code.switch(self.is_on, self.active)
            self._rates = where, code.rate(t, y) if self._has_entered else None
            self._is_ahead = self._has_entered
        return self._rates[1]

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
        compiled = self._compiled(t, y)
        if compiled is not None:
            return compiled
        if not np.isfinite(y).all():
            return np.full(len(y), np.nan)
        size = len(y) // 2
        try:
            qdd_v, power = self.acceleration(t, self.at(t, y))
        except PathEnd as end:
            return self._failed(partial(self._end_words, t, y, end), y)
        except RankLoss as loss:
            return self._failed(partial(_singular_words, self.mechanism, loss), y)
        return np.concatenate([y[size : 2 * size], qdd_v[~self.drives.is_driven], [power]])

    @property
    def failure(self) -> str:
        """Why rates were no numbers at last; empty if they always were."""
        return self._told()

    def _failed(self, told: Callable[[], str], y: Array) -> Array:
        self._told = told
        return np.full(len(y), np.nan)

    def _end_words(self, t: float, y: Array, end: PathEnd) -> str:
        """Tell an end by a place well beyond: a hair beyond its end every path seems to go on."""
        mechanism, v = self.mechanism, self.mechanism.part.v
        way = self._independent(t, y)[1]
        size = float(np.max(np.abs(way / mechanism.part.units[v]), initial=0.0))
        try:
            follow(mechanism.equations, mechanism.part, end.reached, end.reached.q[v] + _BEYOND * way / (size or 1.0))
        except PathEnd as further:
            return path_words(mechanism, further)
        return path_words(mechanism, end)

    def closeness(self) -> str:
        """Tell a pose near which steps lead nowhere."""
        return short_words(self.mechanism, self.here.q, least_singular_value(self.here.factor.A))

    def solver(self, t: float, y: Array, end: float, h: float, relative: float, absolute: Array) -> RateSolver | None:
        """Begin to integrate by the compiled code; None if there is none, or it refuses."""
        rates = self._compiled(t, y)
        if self._code is None or rates is None:
            return None
        return RateSolver(self._code, t, y, rates, end, h, relative, absolute)

    def moved(self, solver: RateSolver) -> None:
        """Be where the compiled code went."""
        self._is_ahead, self._rates = True, (np.zeros(0), None)
        evaluations, steps = solver.counted()
        self.evaluations += evaluations
        self.steps += steps

    def value(self, k: int, t: float, y: Array) -> float:
        """What is positive while a switch is on."""
        switch = self.switches[k]
        if self._code is not None and self._compiled(t, y) is not None:
            return switch.value(self._code.q[switch.coordinate], self._code.qd[switch.coordinate])
        found = self.at(t, y)
        return switch.value(self.here.q[switch.coordinate], found.rates.qd[switch.coordinate])

    def slope(self, k: int, t: float, y: Array) -> float:
        """Its rate."""
        switch = self.switches[k]
        if self._code is not None and self._compiled(t, y) is not None:
            return switch.rate(self._code.qd[switch.coordinate], self._code.qdd[switch.coordinate])
        found = self.at(t, y)
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
        mechanism, v, code = self.mechanism, self.mechanism.part.v, self._code
        if code is not None and self._compiled(t, y) is not None:
            q, qdd_v = code.q.copy(), code.qdd[v]
            found = reduced(mechanism.equations, mechanism.part, q, code.qd[v])
        else:
            found = self.at(t, y)
            q, qdd_v = self.here.q, self.acceleration(t, found)[0]
        return loaded(mechanism, t, q, found, qdd_v, self.active, self.drives.is_driven)

    def exchange(self, t: float, y: Array) -> Array | None:
        """Take other independent coordinates where free ones turn back: what is integrated then, None if all stay."""
        if self._slope(t, y) <= self._steepest:
            return None
        qd, driven = self.at(t, y).rates.qd, self.drives.is_driven
        here = replace(self.here, iterations=self.iterations)
        try:
            found, here = exchanged(self.mechanism, here, driven, self._steepest)
        except RankLoss:
            self._steepest, self._has_entered = np.inf, False
            return None
        self._take(found, here)
        self.exchanges += 1
        v = found.part.v[~driven]
        return np.concatenate([here.q[v], qd[v], y[-1:]])

    def _slope(self, t: float, y: Array) -> float:
        """How steep the dependent coordinates are beside the free ones."""
        if self._code is not None and self._compiled(t, y) is not None:
            return steepest(self._code.slope, self.drives.is_driven)
        self.at(t, y)
        return steepest(self.here.slope, self.drives.is_driven)

    def begin(self, t: float, y: Array) -> None:
        """Set the switches as they are at the start."""
        self.is_on = tuple(self.value(k, t, y) > 0 for k in range(len(self.switches)))
        self._rates = np.zeros(0), None

    def switch(self, k: int) -> None:
        """Change a switch that an event told."""
        self.is_on = tuple(on != (place == k) for place, on in enumerate(self.is_on))
        self.events_met += 1
        self._rates = np.zeros(0), None


def _singular_words(mechanism: Mechanism, loss: RankLoss) -> str:
    return f"singular pose: {free_words(mechanism, loss)}"
