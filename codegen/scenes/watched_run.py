"""Integrate a scene and watch it: a run ends at a singular configuration, or goes on through it when asked.

Between outputs the run is looked at often enough that no body turns by more than `TURN` in between.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import astuple, dataclass, field

import numpy as np
from scipy.optimize import minimize_scalar

from codegen.measure.constraints import Array
from codegen.scenes.continuation import Prediction, continued, prediction
from codegen.scenes.run import Prepared, Progress, Run, Settings, integrator
from codegen.scenes.watch import DROPPED, PER_TOLERANCE, SINGULAR, Watch
from codegen.simulate.ida import FAILURES, Ida, Statistics

TURN = 0.05
"""rad, largest turn of a body between two states that are looked at."""

NEAR = 0.3
"""A least singular value that passes a minimum below this part of the largest it had is looked at closely."""

_LOOKS = 1000
"""Most states between two outputs."""

_BATCH = 200
"""States that are looked at together."""

_BACK = 4
"""States of the batch before that are kept: those that predict, and one."""

APART = 10 * SINGULAR
"""The integrator goes on where the smallest singular value is above this part of the largest."""

_ENOUGH = 2
"""States that are needed to predict."""

_AHEAD = 3.0
"""Where the integrator fails, a singular configuration is looked for within this many times the last distance."""


@dataclass(frozen=True, slots=True)
class Passage:
    """A singular configuration that a run went through.

    Attributes:
        words: what is singular.
        left: s, time of the last state before.
        entered: s, time from which the integrator went on.
        moved: how far the predicted positions were moved onto the constraints, without dimension.
    """

    words: str
    left: float
    entered: float
    moved: float


@dataclass(frozen=True, slots=True, eq=False)
class Watched:
    """A run and what was seen.

    Attributes:
        run: states at the output times that were reached.
        least: smallest singular value over the largest, the worst part at the worst time; None without loops.
        dropped: largest ``phi`` of rows that were left out, without dimension; None where there are none.
        passages: singular configurations that were gone through.
    """

    run: Run
    least: float | None
    dropped: float | None
    passages: tuple[Passage, ...]


@dataclass(frozen=True, slots=True, eq=False)
class _Looked:
    """A state that was looked at; ``output`` is the number of the output time, or -1."""

    t: float
    y: Array
    ydot: Array
    output: int


@dataclass(frozen=True, slots=True, eq=False)
class _Stop:
    """Where a run has to stop: states before ``t`` are good. Where it is singular, the part that is."""

    words: str
    t: float
    part: int = -1


@dataclass(slots=True, eq=False)
class _Seen:
    """What was seen so far."""

    largest: Array
    least: float = math.inf
    dropped: float = 0.0
    passages: list[Passage] = field(default_factory=list)
    counters: list[tuple[int, ...]] = field(default_factory=list)
    wall_time: float = 0.0


def watched_run(prepared: Prepared, settings: Settings, progress: Progress = lambda _: None) -> Watched:
    """Integrate and watch.

    Args:
        prepared: the scene.
        settings: duration, outputs, tolerance, and whether to go on through singular configurations.
        progress: told the time reached, once for each output.
    """
    return _Watcher(prepared, settings, progress).watched()


class _Watcher:
    def __init__(self, prepared: Prepared, settings: Settings, progress: Progress) -> None:
        self._prepared, self._settings, self._progress = prepared, settings, progress
        self._layout = prepared.layout
        self._watch = Watch(prepared.judged, prepared.layout)
        self._times = np.linspace(0.0, settings.duration, settings.outputs + 1)
        self._outputs = [_Looked(0.0, prepared.y, prepared.ydot, 0)]
        self._told = 0
        least, _ = self._watch.conditions(np.zeros(1), prepared.y[None])
        self._seen = _Seen(least[0])

    def watched(self) -> Watched:
        """Run from start to end, or to where it stops."""
        failure = self._singular_start()
        start: _Looked | None = None if failure else self._outputs[0]
        while start is not None:
            states, stop = self._segment(start)
            start = None
            if stop is not None and stop.part >= 0 and self._settings.through_singular:
                start = self._passed(states, stop)
            if stop is not None and start is None and not self._is_complete:
                failure = stop.words
        return self._result(failure)

    @property
    def _is_complete(self) -> bool:
        return self._outputs[-1].output == self._settings.outputs

    def _singular_start(self) -> str:
        bad = np.flatnonzero(self._seen.largest < SINGULAR)
        if not len(bad):
            return ""
        words = self._watch.singular_words(0.0, self._prepared.y, int(bad[0]))
        return f"{words}; start from another pose"

    def _result(self, failure: str) -> Watched:
        t, y, ydot = (np.array([getattr(s, name) for s in self._outputs]) for name in ("t", "y", "ydot"))
        seen = self._seen
        statistics = Statistics(
            *(sum(counts) for counts in zip(*seen.counters, strict=True)) if seen.counters else [0] * 6
        )
        return Watched(
            Run(t, y, ydot, statistics, seen.wall_time, failure),
            min(seen.least, float(np.min(seen.largest))) if len(seen.largest) else None,
            seen.dropped if len(self._watch.dropped) else None,
            tuple(seen.passages),
        )

    # --- integration

    def _segment(self, start: _Looked) -> tuple[list[_Looked], _Stop | None]:
        """Integrate to the end or to a stop; the last good states, and the stop."""
        recent = [start]
        settings = self._settings
        with integrator(self._prepared, settings, start.t, start.y, start.ydot) as ida:
            for batch, code in self._batches(ida, start):
                looked = recent + batch
                stop = self._judged(looked)
                if stop is None and code:
                    stop = self._failed(looked, f"the integrator {FAILURES.get(code, f'stopped with {code}')}")
                limit = math.inf if stop is None else stop.t
                self._outputs += [s for s in batch if s.output >= 0]
                self._outputs = [s for s in self._outputs if s.t < limit or not s.output]
                recent = [s for s in looked if s.t < limit][-_BACK:]
                if stop is not None:
                    break
            else:
                stop = None
            self._seen.counters.append(astuple(ida.statistics()))
        return recent, stop

    def _batches(self, ida: Ida, start: _Looked) -> Iterator[tuple[list[_Looked], int]]:
        """States that are looked at, and the code of a failure behind the last of them."""
        batch: list[_Looked] = []
        began = time.perf_counter()
        for t, output in self._looks(ida, start):
            now, code = ida.advance(t)
            if not code:
                batch.append(_Looked(now, ida.y.copy(), ida.ydot.copy(), output))
                self._tell(batch[-1])
            if code or len(batch) == _BATCH:
                self._seen.wall_time += time.perf_counter() - began
                yield batch, code
                batch, began = [], time.perf_counter()
            if code:
                return
        self._seen.wall_time += time.perf_counter() - began
        yield batch, 0

    def _looks(self, ida: Ida, start: _Looked) -> Iterator[tuple[float, int]]:
        """Times to look at, with the number of the output or -1; those between outputs follow from the speed."""
        previous = start.t
        for number, t in enumerate(self._times.tolist()):
            if t <= start.t or number <= start.output:
                continue
            speed = float(np.max(np.abs(ida.y[self._turning]), initial=0.0))
            count = min(_LOOKS, max(1, math.ceil(speed * (t - previous) / TURN))) if self._watch.parts else 1
            for k in range(1, count):
                yield previous + (t - previous) * k / count, -1
            yield t, number
            previous = t

    @property
    def _turning(self) -> list[int]:
        """Places of the angular velocities."""
        arrays, first = self._prepared.system.assembly.arrays, self._layout.velocities.start
        bodies = range(len(self._prepared.scene.bodies))
        own = range(arrays.position, arrays.displacements)
        return [first + arrays.displacements * body + k for body in bodies for k in own]

    def _tell(self, state: _Looked) -> None:
        if state.output > self._told:
            self._told = state.output
            self._progress(state.t)

    # --- verdicts

    def _judged(self, looked: list[_Looked]) -> _Stop | None:
        """The first of the states looked at where the run has to stop."""
        t, y = np.array([s.t for s in looked]), np.array([s.y for s in looked])
        least, dropped = self._watch.conditions(t, y)
        seen = self._seen
        seen.largest = np.maximum(seen.largest, least.max(axis=0))
        stops = [*self._singular(looked, least), *self._left_out(t, dropped)]
        stop = min(stops, key=lambda found: found.t, default=None)
        good = t < (stop.t if stop else math.inf)
        seen.least = min(seen.least, float(np.min(least[good], initial=math.inf)))
        seen.dropped = max(seen.dropped, float(np.max(np.abs(dropped[good]), initial=0.0)))
        return stop

    def _singular(self, looked: list[_Looked], least: Array) -> Iterator[_Stop]:
        for part in range(least.shape[1]):
            values = least[:, part]
            for k in range(1, len(looked)):
                is_minimum = values[k] <= values[k - 1] and k + 1 < len(looked) and values[k] <= values[k + 1]
                if values[k] < SINGULAR or (is_minimum and values[k] < NEAR * self._seen.largest[part]):
                    stop = self._nearest(looked, k, part)
                    if stop is not None:
                        yield stop
                        break

    def _nearest(self, looked: list[_Looked], k: int, part: int) -> _Stop | None:
        """The singular configuration beside a state, if there is one; predicted from the states before."""
        found = []
        for last in (k - 1, k) if k + 1 < len(looked) else (k - 1,):
            predicted = self._predicted(looked[: last + 1])
            found.append(self._minimum(predicted, looked[last].t, looked[last + 1].t, part))
        least, t, y = min(found, key=lambda values: values[0])
        return _Stop(self._watch.singular_words(t, y, part), t, part) if least < SINGULAR else None

    def _minimum(self, predicted: Prediction, start: float, end: float, part: int) -> tuple[float, float, Array]:
        """Least singular value between two times, and where."""

        def value(x: float) -> float:
            t = start + (end - start) * x
            return float(self._watch.conditions(np.array([t]), predicted.state(t)[None])[0][0, part])

        found = minimize_scalar(value, bounds=(0.0, 1.0), method="bounded", options={"xatol": 1e-9, "maxiter": 60})
        t = start + (end - start) * float(found.x)
        return float(found.fun), t, predicted.state(t)

    def _left_out(self, t: Array, dropped: Array) -> Iterator[_Stop]:
        limit = max(DROPPED, PER_TOLERANCE * self._settings.tolerance)
        for k in np.flatnonzero(np.max(np.abs(dropped), axis=1, initial=0.0) > limit)[:1].tolist():
            words = f"{self._watch.dropped_words(t[k], dropped[k])}; the limit is {limit:.0e}"
            yield _Stop(words, float(t[k]))

    def _failed(self, looked: list[_Looked], words: str) -> _Stop:
        """Why the integrator may have failed: a singular configuration ahead."""
        told = f"behind t = {looked[-1].t:.9g} s {words}"
        if len(looked) > 1:
            start = looked[-1].t
            ahead = _AHEAD * max(start - looked[-2].t, 1e-9)
            predicted = self._predicted(looked)
            for part in range(len(self._watch.parts)):
                least, t, y = self._minimum(predicted, start, start + ahead, part)
                if least < SINGULAR:
                    return _Stop(f"{self._watch.singular_words(t, y, part)}; {told}", t, part)
        return _Stop(told, math.inf)

    def _predicted(self, states: list[_Looked]) -> Prediction:
        t, y, ydot = (np.array([getattr(s, name) for s in states[-_BACK:]]) for name in ("t", "y", "ydot"))
        return prediction(self._layout, t, y, ydot)

    # --- going on

    def _passed(self, states: list[_Looked], stop: _Stop) -> _Looked | None:
        """Go on behind a singular configuration; None where there is nothing to predict from, or nothing left to do."""
        while states and self._least(states[-1].t, states[-1].y, stop.part) < APART:
            states = states[:-1]
        if len(states) < _ENOUGH:
            return None
        predicted = self._predicted(states)
        behind = 2 * stop.t - states[-1].t
        while self._least(behind, predicted.state(behind), stop.part) < APART:
            behind += stop.t - states[-1].t
        self._fill(predicted, behind)
        y, ydot, moved = continued(self._prepared, self._watch, behind, predicted)
        self._seen.passages.append(Passage(stop.words, states[-1].t, behind, moved))
        return None if self._is_complete else _Looked(behind, y, ydot, self._outputs[-1].output)

    def _fill(self, predicted: Prediction, behind: float) -> None:
        """Outputs within the neighbourhood."""
        for number in range(self._outputs[-1].output + 1, len(self._times)):
            t = float(self._times[number])
            if t > behind:
                return
            y, ydot, _ = continued(self._prepared, self._watch, t, predicted)
            self._outputs.append(_Looked(t, y, ydot, number))
            self._tell(self._outputs[-1])

    def _least(self, t: float, y: Array, part: int) -> float:
        return float(self._watch.conditions(np.array([t]), y[None])[0][0, part])
