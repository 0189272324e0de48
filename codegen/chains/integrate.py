"""Integrate a chain in motion by DOP853, in pieces between the events of switched forces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from codegen.chains.moving import Moving
from codegen.chains.state import State
from codegen.chains.steps import Step, Stopped, Tolerances, steps, taken

Array = NDArray[np.float64]

_SAME = 1e-12
"""Part of the duration: events that are closer are one after the other at the same time."""

_MOST = 20
"""Events at the same time, after which forces switch without end."""


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
    relative, duration = max(tolerance, 3e-14), end - t
    left = [float(at) for at in times[1:]]
    while left:
        begun, event = t, None
        tolerances = Tolerances(relative, _absolute(motion, first, tolerance, duration))
        for step in steps(motion, t, y, end, tolerances, left):
            event = _event(motion, step, tolerances)
            t, y = (event.t, event.y) if event else (step.t, step.y)
            while left and left[0] <= t:
                at = left.pop(0)
                yield at, y if at == t else step.between(at)
            other = None if event else motion.exchange(t, y)
            y = y if other is None else other
            if event or other is not None:
                break
        if event:
            motion.switch(event.switch)
            met = met + 1 if t - begun < _SAME * end else 0
        if met > _MOST:
            raise Stopped(f"forces switch without end at t = {t:.9g} s; a coordinate sticks there")


@dataclass(frozen=True, slots=True, eq=False)
class _Event:
    """A switch that changes, and the place."""

    switch: int
    t: float
    y: Array


def _event(motion: Moving, step: Step, tolerances: Tolerances) -> _Event | None:
    """The first change of a switch within a step.

    It is sought on the interpolant of the step; then the step is taken anew up to there, and once more after a
    correction by the rate of what changes sign, since the interpolant is less exact than the step.
    """
    found = [(_root(motion, k, step), k) for k in motion.crossed(step.t, step.y)]
    if not found:
        return None
    t, k = min(found)
    y = taken(motion, step, t, tolerances)
    slope = motion.slope(k, t, y)
    corrected = t - motion.value(k, t, y) / slope if slope else t
    if step.begun < corrected < step.t and abs(corrected - t) < 0.01 * (step.t - step.begun):
        t, y = corrected, taken(motion, step, corrected, tolerances)
    return _Event(k, t, y)


def _root(motion: Moving, k: int, step: Step) -> float:
    """Where a switch changes on the interpolant; the start of the step where it does at once."""

    def value(t: float) -> float:
        return motion.value(k, t, step.between(t))

    if value(step.begun) * value(step.t) >= 0:
        return step.begun
    return float(brentq(value, step.begun, step.t, xtol=1e-15, rtol=1e-15))


def _absolute(motion: Moving, first: State, tolerance: float, duration: float) -> Array:
    """Absolute tolerances of angles, rates and work.

    The work is controlled too: one more component whose error estimate does not vanish where those of the others do.
    """
    loads = first.loads
    energy = 0.0 if loads is None else max(loads.kinetic, abs(loads.power) * duration)
    return tolerance * np.concatenate([motion.units, motion.units, [energy or np.inf]])
