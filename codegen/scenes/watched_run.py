"""Integrate a scene and watch it: a run ends at a singular configuration, or goes on through it when asked.

Between outputs the run is looked at often enough that no body turns by more than `TURN` in between.
"""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import astuple, dataclass, field

import numpy as np

from codegen.measure.constraints import Array
from codegen.scenes.continuation import Prediction, continued
from codegen.scenes.run import Prepared, Progress, Run, Settings, integrator
from codegen.scenes.verdicts import Looked, Stop, Verdicts
from codegen.scenes.watch import SINGULAR, Watch
from codegen.simulate.ida import FAILURES, Ida, Statistics

TURN = 0.05
"""rad, largest turn of a body between two states that are looked at."""

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
        self._verdicts = Verdicts(self._watch, prepared.layout, settings.tolerance)
        self._times = np.linspace(0.0, settings.duration, settings.outputs + 1)
        self._outputs = [Looked(0.0, prepared.y, prepared.ydot, 0)]
        self._told = 0
        least, _ = self._watch.conditions(np.zeros(1), prepared.y[None])
        self._seen = _Seen(least[0])

    def watched(self) -> Watched:
        """Run from start to end, or to where it stops."""
        failure = self._singular_start()
        start: Looked | None = None if failure else self._outputs[0]
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
        has_table4 = "table4" in {variant.rows for variant in self._prepared.judged.assembly.forms.values()}
        return f"{words}; start from another pose" + (', or take rows = "regular"' if has_table4 else "")

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

    def _segment(self, start: Looked) -> tuple[list[Looked], Stop | None]:
        """Integrate to the end or to a stop; the last good states, and the stop."""
        recent = [start]
        settings = self._settings
        with integrator(self._prepared, settings, start.t, start.y, start.ydot) as ida:
            for batch, code in self._batches(ida, start):
                looked = recent + batch
                stop = self._judged(looked)
                if stop is None and code:
                    stop = self._verdicts.failed(looked, f"the integrator {FAILURES.get(code, f'stopped with {code}')}")
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

    def _batches(self, ida: Ida, start: Looked) -> Iterator[tuple[list[Looked], int]]:
        """States that are looked at, and the code of a failure behind the last of them."""
        batch: list[Looked] = []
        began = time.perf_counter()
        for t, output in self._looks(ida, start):
            now, code = ida.advance(t)
            if not code:
                batch.append(Looked(now, ida.y.copy(), ida.ydot.copy(), output))
                self._tell(batch[-1])
            if code or len(batch) == _BATCH:
                self._seen.wall_time += time.perf_counter() - began
                yield batch, code
                batch, began = [], time.perf_counter()
            if code:
                return
        self._seen.wall_time += time.perf_counter() - began
        yield batch, 0

    def _looks(self, ida: Ida, start: Looked) -> Iterator[tuple[float, int]]:
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

    def _tell(self, state: Looked) -> None:
        if state.output > self._told:
            self._told = state.output
            self._progress(state.t)

    # --- verdicts

    def _judged(self, looked: list[Looked]) -> Stop | None:
        """The first of the states looked at where the run has to stop."""
        t, y = np.array([s.t for s in looked]), np.array([s.y for s in looked])
        least, dropped = self._watch.conditions(t, y)
        seen = self._seen
        seen.largest = np.maximum(seen.largest, least.max(axis=0))
        stop = self._verdicts.stop(looked, least, dropped, seen.largest)
        good = t < (stop.t if stop else math.inf)
        seen.least = min(seen.least, float(np.min(least[good], initial=math.inf)))
        seen.dropped = max(seen.dropped, float(np.max(np.abs(dropped[good]), initial=0.0)))
        return stop

    # --- going on

    def _passed(self, states: list[Looked], stop: Stop) -> Looked | None:
        """Go on behind a singular configuration; None where there is nothing to predict from, or nothing left to do."""
        while states and self._verdicts.least(states[-1].t, states[-1].y, stop.part) < APART:
            states = states[:-1]
        if len(states) < _ENOUGH:
            return None
        predicted = self._verdicts.predicted(states)
        behind = 2 * stop.t - states[-1].t
        while self._verdicts.least(behind, predicted.state(behind), stop.part) < APART:
            behind += stop.t - states[-1].t
        self._fill(predicted, behind)
        y, ydot, moved = continued(self._prepared, self._watch, behind, predicted)
        self._seen.passages.append(Passage(stop.words, states[-1].t, behind, moved))
        return None if self._is_complete else Looked(behind, y, ydot, self._outputs[-1].output)

    def _fill(self, predicted: Prediction, behind: float) -> None:
        """Outputs within the neighbourhood."""
        for number in range(self._outputs[-1].output + 1, len(self._times)):
            t = float(self._times[number])
            if t > behind:
                return
            y, ydot, _ = continued(self._prepared, self._watch, t, predicted)
            self._outputs.append(Looked(t, y, ydot, number))
            self._tell(self._outputs[-1])
