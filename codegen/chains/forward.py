"""Forward dynamics: (q_v, qd_v) integrated by DOP853, in pieces between the events of switched forces.

The work of all forces is integrated along, so that it can be held against the kinetic energy.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from codegen.chains.factor import RankLoss
from codegen.chains.mechanism import Mechanism
from codegen.chains.path import Branch, PathEnd, follow
from codegen.chains.reduced import Reduced, reduced
from codegen.chains.run import Progress, Run
from codegen.chains.state import State, generalised, loaded
from codegen.chains.stop import free_words, path_words
from codegen.chains.switches import Switch, active, switches

Array = NDArray[np.float64]

_SAME = 1e-12
"""Part of the duration: events that are closer are one after the other at the same time."""

_MOST = 20
"""Events at the same time, after which forces switch without end."""


class _Stopped(Exception):
    """The integrator cannot go on; the words say why."""


class _Motion:
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

    def value(self, switch: Switch, y: Array) -> float:
        """What changes sign at an event."""
        found = self.at(y)
        return switch.value(self.here.q[switch.coordinate], found.rates.qd[switch.coordinate])

    def state(self, t: float, y: Array) -> State:
        """The chain at an output."""
        found = self.at(y)
        qdd_v, _ = self.acceleration(found)
        return loaded(self.mechanism, t, self.here.q, found, qdd_v, self.active, is_driven=False)

    def switch(self, k: int) -> None:
        """Change a switch that an event told."""
        self.is_on = tuple(on != (place == k) for place, on in enumerate(self.is_on))
        self.events_met += 1

    def events(self) -> list[Callable[[float, Array], float]]:
        """A function for each switch, in the direction in which it changes from what it is."""
        return [self._event(switch, on) for switch, on in zip(self.switches, self.is_on, strict=True)]

    def _event(self, switch: Switch, is_on: bool) -> Callable[[float, Array], float]:
        def event(_: float, y: Array) -> float:
            return self.value(switch, y)

        event.terminal = True  # type: ignore[attr-defined]
        event.direction = -1.0 if is_on else 1.0  # type: ignore[attr-defined]
        return event


def run(
    mechanism: Mechanism,
    start: Branch,
    qd_v: Array,
    times: Array,
    tolerance: float,
    progress: Progress = lambda _: None,
) -> Run:
    """Integrate.

    Args:
        mechanism: the chain.
        start: closed at times[0].
        qd_v: [nv] at times[0].
        times: [n] s, ascending.
        tolerance: relative, and absolute in rad, characteristic lengths and their rates.
        progress: told the time reached.
    """
    forces, part = mechanism.forces, mechanism.part
    found = switches(forces.conditions, [forces.coordinate(one) for one in forces.conditions])
    motion = _Motion(mechanism, start, found)
    y = np.concatenate([start.q[part.v], qd_v, [0.0]])
    states: list[State] = []
    failure = ""
    try:
        motion.is_on = tuple(motion.value(switch, y) > 0 for switch in found)
        states.append(motion.state(float(times[0]), y))
        for t, now in _outputs(motion, y, times, tolerance):
            states.append(motion.state(t, now))
            progress(t)
    except PathEnd as end:
        failure = path_words(mechanism, end)
    except RankLoss as loss:
        failure = f"singular pose: {free_words(mechanism, loss)}"
    except _Stopped as stopped:
        failure = str(stopped)
    words = f"after t = {states[-1].t:.9g} s: {failure}" if failure and states else failure
    return Run(tuple(states), words, motion.here.iterations, motion.events_met, motion.evaluations)


def _outputs(motion: _Motion, y: Array, times: Array, tolerance: float) -> Iterator[tuple[float, Array]]:
    """Integrated variables at the output times, the first one left out.

    Raises:
        _Stopped: the integrator cannot go on, or forces switch without end.
    """
    t, end, met = float(times[0]), float(times[-1]), 0
    limits = {"method": "DOP853", "rtol": max(tolerance, 3e-14), "atol": _absolute(motion.mechanism, tolerance)}
    left = times[1:]
    while len(left):
        piece = solve_ivp(motion.rate, (t, end), y, t_eval=left, events=motion.events() or None, **limits)
        yield from ((float(at), now) for at, now in zip(piece.t, np.transpose(piece.y), strict=True))
        left = left[len(piece.t) :]
        if piece.status < 0:
            raise _Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
        if piece.status == 0:
            return
        k = next(k for k, when in enumerate(piece.t_events) if len(when))
        before, t, y = t, float(piece.t_events[k][0]), piece.y_events[k][0]
        motion.switch(k)
        met = met + 1 if t - before < _SAME * end else 0
        if met > _MOST:
            raise _Stopped(f"forces switch without end at t = {t:.9g} s; give them damping in the place of a switch")


def _absolute(mechanism: Mechanism, tolerance: float) -> Array:
    """Absolute tolerances; the work takes no part."""
    units = mechanism.part.units[mechanism.part.v]
    return np.concatenate([tolerance * units, tolerance * units, [np.inf]])
