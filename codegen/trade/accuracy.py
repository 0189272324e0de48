"""Measure routines: errors over the poses of a domain, times and instructions on this machine, build by build.

Errors are the same in every run on every machine with the same compiler. Times are advice: medians with their spread.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from codegen.emit.routine import Routine
from codegen.measure.compile import compiler_version
from codegen.measure.errors import Figures, figures, truth
from codegen.measure.routine_builds import Build, Built, built
from codegen.trade.builds import BASE, prepared_for
from codegen.trade.programs import builds_folder
from codegen.trade.requests import Request
from codegen.trade.specimens import blocks_of, routine_name, sample

STATES = {True: "converged", False: "mid-iteration"}
_TIMES = 31

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Candidate:
    """One routine in one build, measured.

    Attributes:
        joint: its name, or that of the scene.
        routine: symbol of the routine.
        build: name of the build.
        flags: compiler and flags.
        figures: state -> figures of each block.
        nanoseconds: median time of a pose.
        spread: half of all times lie within this part of the median.
        instructions: of a pose; None where they could not be counted.
    """

    joint: str
    routine: str
    build: str
    flags: str
    figures: dict[str, tuple[Figures, ...]]
    nanoseconds: float
    spread: float
    instructions: int | None

    @property
    def error(self) -> float:
        """Largest scene error of all blocks and states."""
        return max((f.largest for found in self.figures.values() for f in found), default=0.0)

    @property
    def eta(self) -> float:
        """Largest eta of all blocks and states."""
        return max((f.eta for found in self.figures.values() for f in found), default=0.0)


def measured(request: Request, progress: Progress = lambda _: None) -> tuple[Candidate, ...]:
    """Measure; the candidates of a joint, or of a scene, are timed in turn.

    Raises:
        SpecificationError: the request cannot be met.
    """
    chosen = request.builds()
    found: list[Candidate] = []
    cases = request.cases()
    for group in dict.fromkeys(case.group for case in cases):
        rows: list[_Row] = []
        for case in (case for case in cases if case.group == group):
            rows += list(_judged(case.routine(), request, chosen, builds_folder()))
            progress(case.name)
        found += _timed(group, rows, len(chosen) > len(BASE) and request.is_counted)
    return tuple(found)


@dataclass(frozen=True, slots=True, eq=False)
class _Row:
    built: Built
    figures: dict[str, tuple[Figures, ...]]
    inputs: Any


def _judged(routine: Routine, request: Request, chosen: Sequence[Build], folder: Path) -> Iterator[_Row]:
    """Compile a routine in every build and judge its errors."""
    groups: dict[tuple[bool, str, bool], list[Build]] = {}
    for choice in chosen:
        groups.setdefault((choice.fma, choice.real, choice.trigonometry == "given"), []).append(choice)
    for group in groups.values():
        rows = [(choice, prepared_for(routine, choice)) for choice in group]
        made = [built(program, choice, folder) for choice, program in rows if program is not None]
        if made:
            yield from _against_truth(made, request)


def _against_truth(made: Sequence[Built], request: Request) -> Iterator[_Row]:
    """Judge builds of one program in one number type."""
    routine, real = made[0].routine, made[0].build.real
    judged = blocks_of(routine)
    found: list[dict[str, tuple[Figures, ...]]] = [{} for _ in made]
    for is_converged, state in STATES.items():
        poses = sample(routine, request.domain, request.samples, is_converged)
        known = truth(routine.straight, poses, real)
        for one, states in zip(made, found, strict=True):
            states[state] = figures(known, one.values(known.inputs), judged, request.domain)
    for one, states in zip(made, found, strict=True):
        yield _Row(one, states, known.inputs)


def _timed(joint: str, rows: Sequence[_Row], is_counted: bool) -> list[Candidate]:
    """Time rows in turn, so that what else the machine does falls on all alike."""
    timers = [row.built.timer(row.inputs) for row in rows]
    times = [[timer() for timer in timers] for _ in range(_TIMES)][3:]
    found = []
    for k, row in enumerate(rows):
        first, median, third = statistics.quantiles([line[k] for line in times], n=4)
        choice = row.built.build
        found.append(
            Candidate(
                joint,
                routine_name(row.built.routine),
                choice.name,
                " ".join((choice.compiler, *choice.flags)),
                row.figures,
                median,
                (third - first) / median,
                row.built.instructions() if is_counted else None,
            )
        )
    return found


def front(candidates: Sequence[Candidate]) -> tuple[Candidate, ...]:
    """The Pareto front, fastest first: no other is both faster and more accurate."""
    best: list[Candidate] = []
    for candidate in sorted(candidates, key=lambda c: (c.nanoseconds, c.error)):
        if not best or candidate.error < best[-1].error:
            best.append(candidate)
    return tuple(best)


def document(request: Request, candidates: Sequence[Candidate]) -> dict[str, Any]:
    """What was measured, as data: errors under ``candidates``, and what depends on the machine under ``advice``."""
    keep = ("joint", "routine", "build", "flags", "figures")
    rows = [asdict(candidate) for candidate in candidates]
    fronts = {
        joint: [[c.routine, c.build] for c in front([c for c in candidates if c.joint == joint])]
        for joint in dict.fromkeys(c.joint for c in candidates)
    }
    return {
        "samples": request.samples,
        "domain": asdict(request.domain),
        "request": request.asked(),
        "output": request.output,
        "candidates": [
            {name: row[name] for name in keep} | {"error": c.error, "eta": c.eta}
            for row, c in zip(rows, candidates, strict=True)
        ],
        "advice": {
            "compiler": compiler_version(),
            "candidates": [
                {name: row[name] for name in ("routine", "build", "nanoseconds", "spread", "instructions")}
                for row in rows
            ],
            "fronts": fronts,
        },
    }
