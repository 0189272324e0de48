"""Steps of a chain in motion by DOP853: compiled ones, and where these are refused, SciPy's."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import DOP853

from codegen.chains.moving import Moving
from codegen.chains.rate_solver import RateSolver, between

Array = NDArray[np.float64]

_FIRST = 0.1
"""The first step takes this part of the largest."""

_ROW = 100
_HARDLY = 1e-5
"""So many steps in a row that compiled code refuses, of less than this part of the run in all, lead nowhere."""


class Stopped(Exception):
    """The integrator cannot go on; the words say why."""


@dataclass(frozen=True, slots=True, eq=False)
class Tolerances:
    """Tolerances of the integrator.

    Attributes:
        rtol: relative.
        atol: absolute, of each integrated variable.
    """

    rtol: float
    atol: Array


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """One step.

    Attributes:
        begun: s, its start.
        start: what is integrated there.
        t: s, its end.
        y: what is integrated there.
        between: gives it at a time in between; to be asked before the next step.
    """

    begun: float
    start: Array
    t: float
    y: Array
    between: Callable[[float], Array]


def steps(
    motion: Moving, t: float, y: Array, end: float, tolerances: Tolerances, left: Sequence[float]
) -> Iterator[Step]:
    """Take steps up to the end; the first is short, since an estimate of its error knows nothing of what comes.

    Of compiled steps those are told that reach the first of the times that are left, or change a switch; of others all.

    Raises:
        Stopped: no step meets the tolerance, or steps become so short that they lead nowhere.
    """
    reach = motion.reach(t, y)
    h = _FIRST * reach if np.isfinite(reach) else None
    refused: list[float] = []
    while t < end:
        begun = t
        solver = None if h is None else motion.solver(t, y, end, h, tolerances.rtol, tolerances.atol)
        is_refused = solver is None
        while solver is not None and not is_refused and t < end:
            is_refused = not solver.run(left[0])
            motion.moved(solver)
            if solver.t > t:
                t, y, h = solver.t, solver.y, solver.h
                yield _compiled(motion, solver, tolerances)
        refused = [] if t > begun else refused[1 - _ROW :]
        for step, following in _careful(motion, t, y, end, h, tolerances) if is_refused else ():
            t, y, h = step.t, step.y, following
            yield step
            if motion.is_compiled:
                refused.append(step.begun)
                break
        if len(refused) == _ROW and t - refused[0] < _HARDLY * end:
            raise Stopped(motion.closeness())


def taken(motion: Moving, step: Step, t: float, tolerances: Tolerances) -> Array:
    """What is integrated at a time within a step, by steps of its own.

    Raises:
        Stopped: no step meets the tolerance.
    """
    if t <= step.begun:
        return step.start
    y = step.start
    solver = DOP853(
        motion.rate, step.begun, y, t, first_step=t - step.begun, rtol=tolerances.rtol, atol=tolerances.atol
    )
    while solver.status == "running":
        _advance(motion, solver)
    return np.asarray(solver.y)


def _careful(
    motion: Moving, t: float, y: Array, end: float, h: float | None, tolerances: Tolerances
) -> Iterator[tuple[Step, float]]:
    """Steps of SciPy, each with the length of the next."""
    first = None if h is None else min(h, end - t)
    solver = DOP853(motion.rate, t, y, end, first_step=first, rtol=tolerances.rtol, atol=tolerances.atol)
    while solver.status == "running":
        solver.max_step = motion.reach(solver.t, solver.y)
        start = solver.y
        _advance(motion, solver)
        step = Step(float(solver.t_old), start, float(solver.t), solver.y, _interpolant(solver))
        yield step, float(solver.h_abs)


def _interpolant(solver: DOP853) -> Callable[[float], Array]:
    made = cache(solver.dense_output)
    return lambda t: np.asarray(made()(t))


def _advance(motion: Moving, solver: DOP853) -> None:
    solver.step()
    if solver.status == "failed":
        raise Stopped(motion.failure or "the integrator takes no step that meets the tolerance")
    motion.steps += 1


def _compiled(motion: Moving, solver: RateSolver, tolerances: Tolerances) -> Step:
    """The last compiled step."""
    begun, start, t = solver.begun, solver.start, solver.t

    @cache
    def curve() -> Array | None:
        found = solver.curve()
        motion.moved(solver)
        return found

    def at(time: float) -> Array:
        found = curve()
        if found is None:
            return taken(motion, step, time, tolerances)
        return between(found, start, (time - begun) / (t - begun))

    step = Step(begun, start, t, solver.y, at)
    return step
