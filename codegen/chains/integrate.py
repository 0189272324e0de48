"""Integrate a chain in motion by DOP853, in pieces between the events of switched forces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853
from scipy.optimize import brentq

from codegen.chains.moving import Moving
from codegen.chains.rate_solver import RateSolver, between
from codegen.chains.state import State

Array = NDArray[np.float64]

_FIRST = 0.1
"""The first step takes this part of the largest."""

_SAME = 1e-12
"""Part of the duration: events that are closer are one after the other at the same time."""

_MOST = 20
"""Events at the same time, after which forces switch without end."""


class Stopped(Exception):
    """The integrator cannot go on; the words say why."""


def outputs(motion: Moving, y: Array, first: State, times: Array, tolerance: float) -> Iterator[tuple[float, Array]]:
    """Integrated variables at the output times, the first one left out.

    Args:
        motion: the chain.
        y: integrated variables at times[0].
        first: the state there.
        times: [n] s, ascending.
        tolerance: relative, and absolute in rad, characteristic lengths and their rates.

    Raises:
        Stopped: the integrator cannot go on, or forces switch without end.
    """
    t, end, met = float(times[0]), float(times[-1]), 0
    limits = {"rtol": max(tolerance, 3e-14), "atol": _absolute(motion, first, tolerance, end - t)}
    left = [float(at) for at in times[1:]]
    while left:
        begun, event = t, None
        for step in _steps(motion, t, y, end, limits, left):
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


def _steps(
    motion: Moving, t: float, y: Array, end: float, limits: Mapping[str, Any], left: Sequence[float]
) -> Iterator[_Step]:
    """Take steps up to the end; the first is short, since an estimate of its error knows nothing of what comes.

    Compiled ones are told where the first of the times that are left is reached, or a switch changes. One that is refused
    is taken with care.

    Raises:
        Stopped: no step meets the tolerance.
    """
    reach = motion.reach(t, y)
    h = _FIRST * reach if np.isfinite(reach) else None
    while t < end:
        solver = None if h is None else motion.solver(t, y, end, h, limits["rtol"], limits["atol"])
        while solver is not None and t < end:
            is_taken = solver.run(left[0])
            motion.moved(solver)
            if solver.t > t:
                t, y, h = solver.t, solver.y, solver.h
                yield _compiled(motion, solver, limits)
            if not is_taken:
                break
        for step, h in _careful(motion, t, y, end, h, limits):
            t, y = step.t, step.y
            yield step
            if motion.is_compiled:
                break


def _careful(
    motion: Moving, t: float, y: Array, end: float, h: float | None, limits: Mapping[str, Any]
) -> Iterator[tuple[_Step, float]]:
    """Steps that are not compiled, with the length of the next one."""
    if t >= end:
        return
    solver = DOP853(motion.rate, t, y, end, first_step=None if h is None else min(h, end - t), **limits)
    while solver.status == "running":
        solver.max_step = motion.reach(solver.t, solver.y)
        start = solver.y
        solver.step()
        if solver.status == "failed":
            raise Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
        yield _Step(float(solver.t_old), start, float(solver.t), solver.y, _between(solver)), float(solver.h_abs)


def _compiled(motion: Moving, solver: RateSolver, limits: Mapping[str, Any]) -> _Step:
    """The last step of compiled ones; its curve is made when it is needed, and is to be before the next step."""
    begun, start, t = solver.begun, solver.start, solver.t

    @cache
    def curve() -> Array | None:
        found = solver.curve()
        motion.moved(solver)
        return found

    def at(time: float) -> Array:
        found = curve()
        if found is None:
            return _taken(motion, step, time, limits)
        return between(found, start, (time - begun) / (t - begun))

    step = _Step(begun, start, t, solver.y, at)
    return step


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
    solver = DOP853(motion.rate, step.begun, step.start, t, first_step=t - step.begun, **limits)
    while solver.status == "running":
        solver.step()
    if solver.status == "failed":
        raise Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
    return np.asarray(solver.y)


def _absolute(motion: Moving, first: State, tolerance: float, duration: float) -> Array:
    """Absolute tolerances of angles, rates and work.

    The work is controlled too: one more component whose error estimate does not vanish where those of the others do.
    """
    loads = first.loads
    energy = 0.0 if loads is None else max(loads.kinetic, abs(loads.power) * duration)
    return tolerance * np.concatenate([motion.units, motion.units, [energy or np.inf]])
