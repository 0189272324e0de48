"""Kinematics and inverse dynamics: independent coordinates are prescribed by time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.chains.factor import RankLoss, least_singular_value
from codegen.chains.mechanism import Mechanism
from codegen.chains.motion import Motions
from codegen.chains.path import Branch, PathEnd, follow
from codegen.chains.reduced import rates, reduced
from codegen.chains.run import Progress, Run
from codegen.chains.state import State, loaded
from codegen.chains.stop import free_words, path_words

Array = NDArray[np.float64]


def run(
    mechanism: Mechanism,
    motions: Motions,
    start: Branch,
    times: Array,
    is_inverse: bool,
    progress: Progress = lambda _: None,
) -> Run:
    """Go through output times.

    Args:
        mechanism: the chain.
        motions: of its independent coordinates.
        start: closed at times[0].
        times: [n] s, ascending.
        is_inverse: whether efforts and reactions are wanted too.
        progress: told the time reached.
    """
    states: list[State] = []
    here = start
    for t in times:
        q_v, qd_v, qdd_v = motions.at(float(t))
        try:
            here = follow(mechanism.equations, mechanism.part, here, q_v)
            made = _inverse if is_inverse else _kinematic
            states.append(made(mechanism, float(t), here.q, qd_v, qdd_v))
        except PathEnd as end:
            return Run(tuple(states), f"{_between(states, float(t))}: {path_words(mechanism, end)}", here.iterations)
        except RankLoss as loss:
            words = f"at t = {t:.9g} s: singular pose: {free_words(mechanism, loss)}"
            return Run(tuple(states), words, here.iterations)
        progress(float(t))
    return Run(tuple(states), "", here.iterations)


def _between(states: list[State], t: float) -> str:
    return f"between t = {states[-1].t:.9g} s and {t:.9g} s" if states else f"at t = {t:.9g} s"


def _kinematic(mechanism: Mechanism, t: float, q: Array, qd_v: Array, qdd_v: Array) -> State:
    found = rates(mechanism.equations, mechanism.part, q, qd_v)
    least = least_singular_value(found.factor.A)
    return State(t, q, found.qd, found.acceleration(qdd_v), least)


def _inverse(mechanism: Mechanism, t: float, q: Array, qd_v: Array, qdd_v: Array) -> State:
    found = reduced(mechanism.equations, mechanism.part, q, qd_v)
    active = mechanism.conditions.active(q, found.rates.qd)
    return loaded(mechanism, t, q, found, qdd_v, active, np.ones(len(qdd_v), dtype=bool))
