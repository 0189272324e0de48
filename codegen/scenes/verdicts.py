"""Where a run has to stop: singular configurations at or between its states, and rows left out that do not hold.

A singular configuration is looked for where the smallest singular value passes a minimum. Between states positions are
extrapolated from states before: those behind may already be on another branch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from codegen.dynamics.layout import Layout
from codegen.measure.constraints import Array
from codegen.scenes.continuation import STATES, Prediction, prediction
from codegen.scenes.watch import DROPPED, PER_TOLERANCE, SINGULAR, Watch

NEAR = 0.3
"""A least singular value that passes a minimum below this part of the largest it had is looked at closely."""

_AHEAD = 3.0
"""Where the integrator fails, a singular configuration is looked for within this many times the last distance."""


@dataclass(frozen=True, slots=True, eq=False)
class Looked:
    """A state that was looked at; ``output`` is the number of the output time, or -1."""

    t: float
    y: Array
    ydot: Array
    output: int


@dataclass(frozen=True, slots=True, eq=False)
class Stop:
    """Where a run has to stop: states before ``t`` are good. Where it is singular, the part that is."""

    words: str
    t: float
    part: int = -1


class Verdicts:
    """Verdicts on the states of a run.

    Args:
        watch: of the constraints.
        layout: of the state.
        tolerance: of the run.
    """

    def __init__(self, watch: Watch, layout: Layout, tolerance: float) -> None:
        self._watch, self._layout = watch, layout
        self._limit = max(DROPPED, PER_TOLERANCE * tolerance)

    def stop(self, looked: list[Looked], least: Array, dropped: Array, largest: Array) -> Stop | None:
        """The first place where the run has to stop.

        Args:
            looked: states one after the other.
            least: [n, parts] of `Watch.conditions`.
            dropped: [n, d] of the same.
            largest: [parts] the largest that ``least`` was in the run.
        """
        stops = [*self._singular(looked, least, largest), *self._left_out(looked, dropped)]
        return min(stops, key=lambda found: found.t, default=None)

    def _singular(self, looked: list[Looked], least: Array, largest: Array) -> Iterator[Stop]:
        for part in range(least.shape[1]):
            values = least[:, part]
            for k in range(1, len(looked)):
                is_minimum = values[k] <= values[k - 1] and k + 1 < len(looked) and values[k] <= values[k + 1]
                if values[k] < SINGULAR or (is_minimum and values[k] < NEAR * largest[part]):
                    stop = self._nearest(looked, k, part)
                    if stop is not None:
                        yield stop
                        break

    def _nearest(self, looked: list[Looked], k: int, part: int) -> Stop | None:
        """The singular configuration beside a state, if there is one; predicted from the states before."""
        found = []
        for last in (k - 1, k) if k + 1 < len(looked) else (k - 1,):
            predicted = self.predicted(looked[: last + 1])
            found.append(self._minimum(predicted, looked[last].t, looked[last + 1].t, part))
        least, t, y = min(found, key=lambda values: values[0])
        return Stop(self._watch.singular_words(t, y, part), t, part) if least < SINGULAR else None

    def _minimum(self, predicted: Prediction, start: float, end: float, part: int) -> tuple[float, float, Array]:
        """Least singular value between two times, and where."""

        def value(x: float) -> float:
            t = start + (end - start) * x
            return float(self._watch.conditions(np.array([t]), predicted.state(t)[None])[0][0, part])

        found = minimize_scalar(value, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-9, "maxiter": 60})
        t = start + (end - start) * float(found.x)
        return float(found.fun), t, predicted.state(t)

    def _left_out(self, looked: list[Looked], dropped: Array) -> Iterator[Stop]:
        for k in np.flatnonzero(np.max(np.abs(dropped), axis=1, initial=0.0) > self._limit)[:1].tolist():
            words = self._watch.dropped_words(looked[k].t, dropped[k])
            yield Stop(f"{words}; the limit is {self._limit:.0e}", looked[k].t)

    def failed(self, looked: list[Looked], words: str) -> Stop:
        """Why the integrator may have failed: a singular configuration ahead."""
        told = f"behind t = {looked[-1].t:.9g} s {words}"
        if len(looked) > 1:
            start = looked[-1].t
            ahead = _AHEAD * max(start - looked[-2].t, 1e-9)
            predicted = self.predicted(looked)
            for part in range(len(self._watch.parts)):
                least, t, y = self._minimum(predicted, start, start + ahead, part)
                if least < SINGULAR:
                    return Stop(f"{self._watch.singular_words(t, y, part)}; {told}", t, part)
        return Stop(told, math.inf)

    def predicted(self, states: list[Looked]) -> Prediction:
        """Predict positions from states one after the other."""
        t, y, ydot = (np.array([getattr(s, name) for s in states[-STATES:]]) for name in ("t", "y", "ydot"))
        return prediction(self._layout, t, y, ydot)

    def least(self, t: float, y: Array, part: int) -> float:
        """Smallest singular value over the largest of a part in a state."""
        return float(self._watch.conditions(np.array([t]), y[None])[0][0, part])
