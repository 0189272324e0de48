"""Find the cheapest routine whose error stays within a budget, and say how sure that is.

The error is the total one, against ideal geometry: what rounding the inputs does and what the routine adds. Candidates
are judged from the fastest up; the first that suffices is the answer.

- PROVEN: the guaranteed bound over the whole domain is within the budget.
- MEASURED: twice the largest error that a search found is.
- IMPOSSIBLE: neither is, for any candidate.
"""

from __future__ import annotations

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.measure.errors import number_type
from codegen.measure.routine_builds import Build, Built, built
from codegen.trade.builds import prepared_for
from codegen.trade.cures import TIMES, Cure, cures
from codegen.trade.judgement import Judgement, judged, timing_inputs
from codegen.trade.programs import builds_folder
from codegen.trade.requests import Request
from codegen.trade.specimens import poses_over, routine_name

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Answer:
    """What `budget` found.

    Attributes:
        verdict: ``PROVEN``, ``MEASURED`` or ``IMPOSSIBLE``.
        chosen: the cheapest candidate that suffices; if none does, the one with the least error.
        losers: those that are faster and do not suffice, fastest first.
        cures: what helps where it is impossible.
    """

    verdict: str
    chosen: Judgement
    losers: tuple[Judgement, ...]
    cures: tuple[Cure, ...]


def check_error(largest: float, requests: Sequence[Request]) -> None:
    """Refuse a budget that is no positive number, and requests that cannot be met.

    Raises:
        SpecificationError: all mistakes at once.
    """
    mistakes = []
    if not 0 < largest < math.inf:
        mistakes.append(Mistake("--max-error", f"{largest:g} is no error", "give a number above 0, such as 1e-8"))
    for request in requests:
        try:
            request.cases()
        except SpecificationError as error:
            mistakes += error.mistakes
    if mistakes:
        raise SpecificationError(mistakes)


def answered(request: Request, largest: float, progress: Progress = lambda _: None) -> Answer:
    """Find the cheapest routine with errors of at most ``largest`` times the scales.

    Raises:
        SpecificationError: the request cannot be met.
    """
    losers: list[Judgement] = []
    candidates = _by_time(request)
    for one, nanoseconds in candidates:
        judgement = judged(one, nanoseconds, request.domain, largest)
        progress(f"{judgement.routine} {judgement.build}")
        if judgement.verdict != "OVER":
            return Answer(judgement.verdict, judgement, tuple(losers), ())
        losers.append(judgement)
    best = min(losers, key=lambda loser: loser.searched)
    return Answer("IMPOSSIBLE", best, tuple(losers), tuple(cures(request.domain, candidates, best)))


def _by_time(request: Request) -> list[tuple[Built, float]]:
    """All candidates and their times, fastest first; those that need other inputs are cures."""
    made = _made(request, [build for build in request.builds() if build.trigonometry in ("libm", "own")])
    timers = [one.timer(timing_inputs(one, request.domain)) for one in made]
    times = [[timer() for timer in timers] for _ in range(TIMES)][2:]
    medians = [statistics.median(line[k] for line in times) for k in range(len(made))]
    return sorted(zip(made, medians, strict=True), key=lambda pair: pair[1])


def _made(request: Request, choices: Sequence[Build]) -> list[Built]:
    """Compile the routines of a request in some builds."""
    made = []
    for case in request.cases():
        routine = case.routine()
        programs = [(prepared_for(routine, build), build) for build in choices]
        made += [built(program, build, builds_folder()) for program, build in programs if program is not None]
    return made


def worst_inputs(request: Request, judgement: Judgement) -> dict[str, list[str]]:
    """Inputs of the worst pose of a candidate, as hexadecimal numbers: argument -> entries, column-major."""
    candidates = _made(request, [build for build in request.builds() if build.name == judgement.build])
    one = next(each for each in candidates if routine_name(each.routine) == judgement.routine)
    poses = poses_over(one.routine, request.domain, np.array([judgement.point]), judgement.is_converged)
    used = [argument.name for argument in one.routine.program.used_arguments()]
    given = poses.given(number_type(one.build.real))
    return {name: [float(x).hex() for x in given[name][:, 0]] for name in used}


def document(request: Request, largest: float, answer: Answer) -> dict[str, Any]:
    """The answer as data."""
    return {
        "max_error": largest,
        "domain": asdict(request.domain),
        "request": request.asked(),
        **asdict(answer),
    }
