"""Forward dynamics: free coordinates and rates integrated, with the work of all forces, between events of switches."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RankLoss
from codegen.chains.integrate import outputs
from codegen.chains.mechanism import Mechanism
from codegen.chains.motion import Drives
from codegen.chains.moving import Moving
from codegen.chains.path import Branch, PathEnd
from codegen.chains.reduced import NoInertia
from codegen.chains.run import Progress, Run
from codegen.chains.state import State
from codegen.chains.steps import Stopped
from codegen.chains.stop import free_words, inertia_words, path_words
from codegen.chains.switches import switches

Array = NDArray[np.float64]


def run(
    mechanism: Mechanism,
    start: Branch,
    qd_v: Array,
    drives: Drives,
    times: Array,
    tolerance: float,
    progress: Progress = lambda _: None,
) -> Run:
    """Integrate.

    Args:
        mechanism: the chain.
        start: closed at times[0].
        qd_v: [nv] at times[0].
        drives: of independent coordinates that do not move freely.
        times: [n] s, ascending.
        tolerance: relative, and absolute in rad, characteristic lengths and their rates.
        progress: told the time reached.
    """
    part = mechanism.part
    found = switches(mechanism.conditions.conditions, mechanism.conditions.coordinates)
    motion, free = Moving(mechanism, start, found, drives), ~drives.is_driven
    y = np.concatenate([start.q[part.v][free], qd_v[free], [0.0]])
    states: list[State] = []
    work = [0.0]
    failure = ""
    try:
        motion.begin(float(times[0]), y)
        states.append(motion.state(float(times[0]), y))
        for t, now in outputs(motion, y, states[0], times, tolerance):
            states.append(motion.state(t, now))
            work.append(float(now[-1]))
            progress(t)
    except PathEnd as end:
        failure = path_words(mechanism, end)
    except RankLoss as loss:
        failure = f"singular pose: {free_words(mechanism, loss)}"
    except NoInertia as lack:
        failure = inertia_words(mechanism, lack)
    except Stopped as stopped:
        failure = str(stopped)
    words = f"after t = {states[-1].t:.9g} s: {failure}" if failure and states else failure
    counts = motion.iterations, motion.events_met, motion.evaluations, motion.exchanges, motion.steps
    return Run(tuple(states), words, *counts, tuple(work))
