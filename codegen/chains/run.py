"""What a run of a chain gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from codegen.chains.state import State

Progress = Callable[[float], None]
"""Told the time reached, s."""


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """States at the output times that were reached.

    Attributes:
        states: in order; the last ones are missing where the run stopped before its end.
        failure: why it stopped; empty if it did not.
        iterations: of Newton's method.
        events: of switched forces.
        evaluations: of the equation of motion, by the integrator.
        exchanges: of independent coordinates that turned back.
        steps: of the integrator.
        work: J, of all forces and efforts since the start, at the times of the states; empty without an integrator.
    """

    states: tuple[State, ...]
    failure: str
    iterations: int
    events: int = 0
    evaluations: int = 0
    exchanges: int = 0
    steps: int = 0
    work: tuple[float, ...] = ()
