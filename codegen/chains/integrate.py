"""Integrate a chain in motion by DOP853, in pieces between the events of switched forces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from codegen.chains.moving import Moving

Array = NDArray[np.float64]

_FIRST = 0.1
"""The first step takes this part of the largest."""

_GROWTH, _SHRINKAGE, _SAFETY = 10.0, 0.2, 0.9
"""By how much a step may be longer or shorter than the one before, and what is kept back: as SciPy has them."""

_SAME = 1e-12
"""Part of the duration: events that are closer are one after the other at the same time."""

_MOST = 20
"""Events at the same time, after which forces switch without end."""


class Stopped(Exception):
    """The integrator cannot go on; the words say why."""


def outputs(motion: Moving, y: Array, times: Array, tolerance: float) -> Iterator[tuple[float, Array]]:
    """Integrated variables at the output times, the first one left out.

    Raises:
        Stopped: the integrator cannot go on, or forces switch without end.
    """
    t, end, met = float(times[0]), float(times[-1]), 0
    limits = {"rtol": max(tolerance, 3e-14), "atol": _absolute(motion, t, y, tolerance, end)}
    left = [float(at) for at in times[1:]]
    while left:
        begun, event = t, None
        for step in _steps(motion, t, y, end, limits):
            event = _event(motion, step, limits)
            t, y = (event.t, event.y) if event else (step.t, step.y)
            while left and left[0] <= t:
                at = left.pop(0)
                yield at, y if at == t else step.between(at)
            if event:
                break
        if event:
            motion.switch(event.switch)
            met = met + 1 if t - begun < _SAME * end else 0
        if met > _MOST:
            raise Stopped(f"forces switch without end at t = {t:.9g} s; a coordinate sticks there")


@dataclass(frozen=True, slots=True, eq=False)
class _Step:
    """One step: from where to where, and what lies between."""

    begun: float
    start: Array
    t: float
    y: Array
    between: Callable[[float], Array]


@dataclass(frozen=True, slots=True, eq=False)
class _Event:
    """A switch that changes, and the place."""

    switch: int
    t: float
    y: Array


def _steps(motion: Moving, t: float, y: Array, end: float, limits: Mapping[str, Any]) -> Iterator[_Step]:
    """Take steps up to the end; the first is short, since an estimate of its error knows nothing of what comes.

    Raises:
        Stopped: no step meets the tolerance.
    """
    reach = motion.reach(t, y)
    first = min(_FIRST * reach, end - t)
    solver = _Solver(motion, t, y, end, first_step=first if np.isfinite(reach) else None, **limits)
    while solver.status == "running":
        solver.max_step = motion.reach(solver.t, solver.y)
        start = solver.y
        solver.step()
        if solver.status == "failed":
            raise Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
        yield _Step(float(solver.t_old), start, float(solver.t), solver.y, _between(solver))


class _Solver(DOP853):
    """DOP853 whose steps are compiled, as far as the motion has them."""

    def __init__(self, motion: Moving, t: float, y: Array, end: float, **limits: Any) -> None:
        self._motion = motion
        super().__init__(motion.rate, t, y, end, **limits)

    def _step_impl(self) -> tuple[bool, str | None]:
        least, most = 10 * abs(np.nextafter(self.t, np.inf) - self.t), _GROWTH
        h = min(max(self.h_abs, least), self.max_step)
        while h >= least:
            t = min(self.t + h, self.t_bound)
            h = t - self.t
            self.K[0] = self.f
            y = self._motion.step(self.t, self.y, h, self.K)
            if y is None:
                return super()._step_impl()
            size = self.atol + self.rtol * np.maximum(np.abs(self.y), np.abs(y))
            error = self._estimate_error_norm(self.K, h, size)
            change = min(most, max(_SHRINKAGE, _SAFETY * error**self.error_exponent)) if error else most
            if error < 1:
                self.h_previous, self.h_abs, self.y_old = h, h * change, self.y
                self.t, self.y, self.f = t, y, self.K[-1].copy()
                return True, None
            h, most = h * change, 1.0
        return False, self.TOO_SMALL_STEP


def _between(solver: DOP853) -> Callable[[float], Array]:
    """The interpolant of the last step, made when it is needed; it is to be made before the next step."""
    interpolant = cache(solver.dense_output)
    return lambda t: np.asarray(interpolant()(t))


def _event(motion: Moving, step: _Step, limits: Mapping[str, Any]) -> _Event | None:
    """The first change of a switch within a step.

    It is sought on the interpolant of the step; then the step is taken anew up to there, and once more after a
    correction by the rate of what changes sign, since the interpolant is less exact than the step.
    """
    found = [(_root(motion, k, step), k) for k in motion.crossed(step.t, step.y)]
    if not found:
        return None
    t, k = min(found)
    y = _taken(motion, step, t, limits)
    slope = motion.slope(k, t, y)
    corrected = t - motion.value(k, t, y) / slope if slope else t
    if step.begun < corrected < step.t and abs(corrected - t) < 0.01 * (step.t - step.begun):
        t, y = corrected, _taken(motion, step, corrected, limits)
    return _Event(k, t, y)


def _root(motion: Moving, k: int, step: _Step) -> float:
    """Where a switch changes on the interpolant; the start of the step where it does at once."""

    def value(t: float) -> float:
        return motion.value(k, t, step.between(t))

    if value(step.begun) * value(step.t) >= 0:
        return step.begun
    return float(brentq(value, step.begun, step.t, xtol=1e-15, rtol=1e-15))


def _taken(motion: Moving, step: _Step, t: float, limits: Mapping[str, Any]) -> Array:
    """The state at a time within a step, by steps of its own."""
    if t <= step.begun:
        return step.start
    solver = _Solver(motion, step.begun, step.start, t, first_step=t - step.begun, **limits)
    while solver.status == "running":
        solver.step()
    if solver.status == "failed":
        raise Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
    return np.asarray(solver.y)


def _absolute(motion: Moving, t: float, y: Array, tolerance: float, end: float) -> Array:
    """Absolute tolerances of angles, rates and work.

    The work is controlled too: one more component whose error estimate does not vanish where those of the others do.
    """
    found = motion.at(t, y)
    _, power = motion.acceleration(t, found)
    energy = max(found.kinetic_energy(), abs(power) * (end - t)) or np.inf
    return tolerance * np.concatenate([motion.units, motion.units, [energy]])
