"""Measure routines: errors over the poses of a domain, times and instructions on this machine, build by build.

Errors are the same in every run on every machine with the same compiler. Times are advice: medians with their spread.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from codegen import build
from codegen.emit.joint_subject import JointSubject
from codegen.emit.routine import Routine
from codegen.errors import InternalError, Mistake, SpecificationError, nearest
from codegen.measure.compile import compiler_version
from codegen.measure.errors import Figures, figures, truth
from codegen.measure.pose_domain import Block, PoseDomain, blocks
from codegen.measure.poses import sample_poses
from codegen.measure.routine_builds import Build, Built, built
from codegen.measure.row_names import conventional_rows, parametric_rows
from codegen.spec.request import OUTPUTS, Options, Variant
from codegen.trade.builds import builds, prepared_for
from codegen.trade.programs import builds_folder, routines

SAMPLES = 4096
STATES = {True: "converged", False: "mid-iteration"}
_TIMES = 31

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class AccuracyRequest:
    """What is measured.

    Attributes:
        joints: names in the catalogue; none: every routine of the library, in its plain builds.
        form: see `codegen.spec.request.Variant`; None means both.
        rows: see there.
        derivative: see there.
        output: of the routines that are measured.
        samples: poses on the constraint, and as many in mid-iteration.
        is_counted: whether instructions are counted too, where valgrind is installed.
        domain: bounds of the poses.
    """

    joints: tuple[str, ...] = ()
    form: str | None = None
    rows: str | None = None
    derivative: str | None = None
    output: str = "all"
    samples: int = SAMPLES
    is_counted: bool = True
    domain: PoseDomain = field(default_factory=PoseDomain)

    @property
    def is_full(self) -> bool:
        """Whether all builds are measured."""
        return bool(self.joints)

    def variants(self) -> tuple[Variant, ...]:
        """Choose the variants.

        Raises:
            SpecificationError: unknown names or options that do not go together; all mistakes at once.
        """
        mistakes = []
        if self.output not in OUTPUTS:
            mistakes.append(Mistake("--output", f'there is no "{self.output}"', nearest(self.output, OUTPUTS)))
        if self.samples < 1:
            mistakes.append(Mistake("--samples", f"{self.samples} is no number of poses", "give 1 or more"))
        try:
            chosen = build.variants(Options(self.joints, self.form, self.rows, self.derivative))
        except SpecificationError as error:
            mistakes += error.mistakes
        if mistakes:
            raise SpecificationError(mistakes)
        return chosen


@dataclass(frozen=True, slots=True)
class Candidate:
    """One routine in one build, measured.

    Attributes:
        joint: its name.
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


def measured(request: AccuracyRequest, progress: Progress = lambda _: None) -> tuple[Candidate, ...]:
    """Measure; the candidates of a joint are timed in turn.

    Raises:
        SpecificationError: the request cannot be met.
    """
    chosen = builds(request.is_full)
    found: list[Candidate] = []
    variants = request.variants()
    for joint in dict.fromkeys(variant.joint for variant in variants):
        rows = []
        for variant in (v for v in variants if v.joint == joint):
            rows += list(_judged(variant, request, chosen, builds_folder()))
            progress(variant.file_stem)
        found += _timed(joint, rows, request.is_full and request.is_counted)
    return tuple(found)


@dataclass(frozen=True, slots=True, eq=False)
class _Row:
    built: Built
    figures: dict[str, tuple[Figures, ...]]
    inputs: Any


def _judged(variant: Variant, request: AccuracyRequest, chosen: Sequence[Build], folder: Path) -> Iterator[_Row]:
    """Compile the routine of a variant in every build and judge its errors."""
    routine = next(r for r in routines(variant) if r.output == request.output)
    groups: dict[tuple[bool, str, bool], list[Build]] = {}
    for choice in chosen:
        groups.setdefault((choice.fma, choice.real, choice.trigonometry == "given"), []).append(choice)
    for group in groups.values():
        rows = [(choice, prepared_for(routine, choice)) for choice in group]
        made = [built(program, choice, folder) for choice, program in rows if program is not None]
        if made:
            yield from _against_truth(made, request)


def _against_truth(made: Sequence[Built], request: AccuracyRequest) -> Iterator[_Row]:
    """Judge builds of one program in one number type."""
    routine, real = made[0].routine, made[0].build.real
    subject = joint_subject(routine)
    judged = blocks_of(routine)
    found: list[dict[str, tuple[Figures, ...]]] = [{} for _ in made]
    for is_converged, state in STATES.items():
        arguments = routine.program.arguments
        poses = sample_poses(subject.joint, subject.variant, arguments, request.domain, request.samples, is_converged)
        known = truth(routine.straight, poses, real)
        for one, states in zip(made, found, strict=True):
            states[state] = figures(known, one.values(known.inputs), judged, request.domain)
    for one, states in zip(made, found, strict=True):
        yield _Row(one, states, known.inputs)


def joint_subject(routine: Routine) -> JointSubject:
    """The joint that a routine is of."""
    if not isinstance(routine.subject, JointSubject):
        raise InternalError(f"{routine.symbol} is not of a joint")
    return routine.subject


def blocks_of(routine: Routine) -> tuple[Block, ...]:
    """The blocks of a routine's outputs."""
    subject = joint_subject(routine)
    variant = subject.variant
    is_conventional = variant.form == "conventional"
    rows = conventional_rows(subject.joint) if is_conventional else parametric_rows(subject.joint, variant.rows or "")
    return tuple(block for output in routine.straight.outputs for block in blocks(output, rows))


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
                row.built.routine.symbol,
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


def document(request: AccuracyRequest, candidates: Sequence[Candidate]) -> dict[str, Any]:
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
