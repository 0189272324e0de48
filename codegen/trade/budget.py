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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from codegen.errors import Mistake, SpecificationError
from codegen.measure.adversary import searched
from codegen.measure.bounds import ARITHMETICS, rounding_bounds
from codegen.measure.double_double import DoubleDouble
from codegen.measure.draw import Points, sobol_points
from codegen.measure.errors import number_type
from codegen.measure.judge import block_errors, true_values
from codegen.measure.pose_boxes import pose_box
from codegen.measure.pose_domain import Block, PoseDomain
from codegen.measure.poses import Poses, exactly, poses_at
from codegen.measure.routine_builds import Build, Built, built
from codegen.spec.request import Options
from codegen.trade.accuracy import AccuracyRequest, blocks_of, joint_subject
from codegen.trade.builds import builds, prepared_for
from codegen.trade.programs import builds_folder, routines

_SAMPLES = 256
_SEARCH_ROUNDS = 4
_TIMES = 15
SAFETY = 2.0
"""Of a searched error that is not proven."""

Progress = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Judgement:
    """One routine in one build, judged over a domain; all errors over the scales of their blocks, the worst block.

    Attributes:
        routine: symbol.
        build: name of the build.
        flags: compiler and flags.
        nanoseconds: median time of a pose, advice.
        verdict: ``PROVEN``, ``MEASURED``, or ``OVER`` the budget.
        block: the block with the worst searched error.
        sampled: largest total error of the sampled poses.
        searched: largest total error that was found.
        guaranteed: bound of the total error; infinite where there is none.
        floor: largest error that rounded inputs alone make, of the sampled poses.
        is_converged: whether that was on the constraint.
        point: of the unit cube, where the worst error was found.
    """

    routine: str
    build: str
    flags: str
    nanoseconds: float
    verdict: str
    block: str
    sampled: float
    searched: float
    guaranteed: float
    floor: float
    is_converged: bool
    point: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Cure:
    """A change of the inputs that lowers the floor: what, the largest error that is left with it, and its time."""

    name: str
    searched: float
    nanoseconds: float


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


def check_error(largest: float, requests: Sequence[AccuracyRequest]) -> None:
    """Refuse a budget that is no positive number, and requests that cannot be met.

    Raises:
        SpecificationError: all mistakes at once.
    """
    mistakes = []
    if not 0 < largest < math.inf:
        mistakes.append(Mistake("--max-error", f"{largest:g} is no error", "give a number above 0, such as 1e-8"))
    for request in requests:
        try:
            request.variants()
        except SpecificationError as error:
            mistakes += error.mistakes
    if mistakes:
        raise SpecificationError(mistakes)


def answered(request: AccuracyRequest, largest: float, progress: Progress = lambda _: None) -> Answer:
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
    return Answer("IMPOSSIBLE", best, tuple(losers), tuple(_cures(request.domain, candidates, best)))


def _by_time(request: AccuracyRequest) -> list[tuple[Built, float]]:
    """All candidates and their times, fastest first; those that need other inputs are cures."""
    made = _made(request, [build for build in builds(is_full=True) if build.trigonometry in ("libm", "own")])
    timers = [one.timer(_inputs(one, request.domain)) for one in made]
    times = [[timer() for timer in timers] for _ in range(_TIMES)][2:]
    medians = [statistics.median(line[k] for line in times) for k in range(len(made))]
    return sorted(zip(made, medians, strict=True), key=lambda pair: pair[1])


def _made(request: AccuracyRequest, choices: Sequence[Build]) -> list[Built]:
    """Compile the routines of a request in some builds."""
    made = []
    for variant in request.variants():
        routine = next(r for r in routines(variant) if r.output == request.output)
        programs = [(prepared_for(routine, build), build) for build in choices]
        made += [built(program, build, builds_folder()) for program, build in programs if program is not None]
    return made


def _inputs(one: Built, domain: PoseDomain) -> Any:
    return _poses(one, domain, sobol_points(8), True).given(number_type(one.build.real))


def _poses(one: Built, domain: PoseDomain, points: Points, is_converged: bool) -> Poses:
    subject = joint_subject(one.routine)
    return poses_at(subject.joint, subject.variant, one.routine.program.arguments, domain, points, is_converged)


def judged(one: Built, nanoseconds: float, domain: PoseDomain, largest: float) -> Judgement:
    """Judge one candidate: bound first, then search."""
    judged_blocks = blocks_of(one.routine)
    scales = np.array([domain.scale(block.output, block.is_rotation) for block in judged_blocks])
    sample = sobol_points(_SAMPLES)
    floor = max(float(np.max(_floor(one, domain, sample, state) / scales)) for state in (True, False))
    bound = _bound(one, domain, judged_blocks, scales)
    judges = [partial(_total, one, domain, scales, state) for state in (True, False)]
    found = [searched(judge, sample, _SEARCH_ROUNDS) for judge in judges]
    worst = max(found, key=lambda each: float(np.max(each.searched)))
    block = int(np.argmax(worst.searched))
    most = float(worst.searched[block])
    verdict = "PROVEN" if bound <= largest else "MEASURED" if SAFETY * most <= largest else "OVER"
    return Judgement(
        one.routine.symbol,
        one.build.name,
        " ".join((one.build.compiler, *one.build.flags)),
        nanoseconds,
        verdict,
        judged_blocks[block].name,
        max(float(np.max(each.sampled)) for each in found),
        most,
        bound,
        floor,
        worst is found[0],
        tuple(float(x) for x in worst.points[block]),
    )


def _bound(one: Built, domain: PoseDomain, blocks: Sequence[Block], scales: Any) -> float:
    """Guaranteed total error over the scales; infinite for number types without a bound."""
    subject = joint_subject(one.routine)
    if one.build.real not in ARITHMETICS:
        return float("inf")
    program = one.routine.straight
    box = pose_box(program, subject.joint, subject.variant, domain, one.build.real)
    bounds = rounding_bounds(program, box, one.build.real, are_inputs_rounded=True)
    return max(
        (
            max(bounds[block.output][k] for k in block.entries) / scale
            for block, scale in zip(blocks, scales, strict=True)
        ),
        default=0.0,
    )


def _total(one: Built, domain: PoseDomain, scales: Any, is_converged: bool, points: Points) -> Any:
    """Error against ideal geometry over the scales: [blocks, points]."""
    poses = _poses(one, domain, points, is_converged)
    found = one.values(poses.given(number_type(one.build.real)))
    truth = true_values(one.routine.straight, poses.ideal)
    rows = {name: list(values) for name, values in found.items()}
    return block_errors(rows, truth, blocks_of(one.routine), len(points)) / scales[:, None]


def _floor(one: Built, domain: PoseDomain, points: Points, is_converged: bool) -> Any:
    """What rounded inputs alone do to each block, at most: [blocks]."""
    poses = _poses(one, domain, points, is_converged)
    program = one.routine.straight
    given = true_values(program, exactly(poses.given(number_type(one.build.real))))
    ideal = true_values(program, poses.ideal)
    lines = []
    for block in blocks_of(one.routine):
        apart = [_apart(given[block.output][k], ideal[block.output][k]) for k in block.entries]
        lines.append(max(apart))
    return np.array(lines)


def _apart(a: DoubleDouble, b: DoubleDouble) -> float:
    return float(np.max(np.abs((a - b).high)))


def _cures(domain: PoseDomain, candidates: Sequence[tuple[Built, float]], best: Judgement) -> Iterator[Cure]:
    """Changes of the inputs, each measured with the most accurate candidate."""
    one = next(
        built for built, _ in candidates if (built.routine.symbol, built.build.name) == (best.routine, best.build)
    )
    given = prepared_for(one.routine, replace(one.build, trigonometry="given")) if one.build.lanes == 1 else None
    tries: list[tuple[str, Built, PoseDomain]] = [
        ("give the relative position: r_j - r_i for r_j, 0 for r_i", one, replace(domain, r=0.0, distance=0.0)),
        (
            "keep angles as revolutions and an angle in [-pi, pi]",
            one,
            replace(domain, angle=min(domain.angle, math.pi)),
        ),
        ("orthonormalise A_i and A_j", one, replace(domain, drift=0.0)),
    ]
    if given is not None:
        tries.append(("give sines and cosines", built(given, one.build, builds_folder()), domain))
    for name, changed, where in tries:
        if changed is not one or where != domain:
            found = judged(changed, best.nanoseconds, where, 0.0)
            time = statistics.median(changed.timer(_inputs(changed, domain))() for _ in range(_TIMES))
            if found.searched < best.searched / SAFETY:
                yield Cure(name, found.searched, time)


def worst_inputs(request: AccuracyRequest, judgement: Judgement) -> dict[str, list[str]]:
    """Inputs of the worst pose of a candidate, as hexadecimal numbers: argument -> entries, column-major."""
    candidates = _made(request, [build for build in builds(is_full=True) if build.name == judgement.build])
    one = next(built for built in candidates if built.routine.symbol == judgement.routine)
    poses = _poses(one, request.domain, np.array([judgement.point]), judgement.is_converged)
    used = [argument.name for argument in one.routine.program.used_arguments()]
    given = poses.given(number_type(one.build.real))
    return {name: [float(x).hex() for x in given[name][:, 0]] for name in used}


def package_options(request: AccuracyRequest, judgement: Judgement) -> Options:
    """The request that generates the package of a candidate."""
    choice = next(build for build in builds(is_full=True) if build.name == judgement.build)
    found = (v for v in request.variants() if judgement.routine.startswith(v.routine_stem(request.output)))
    variant = max(found, key=lambda variant: len(variant.stem))
    return Options(
        (variant.joint,),
        variant.form,
        variant.rows,
        variant.derivative,
        variant.variation,
        real=choice.real,
        outputs=(request.output,),
        batch=choice.lanes if choice.lanes > 1 else None,
        fma=choice.fma,
    )


def document(request: AccuracyRequest, largest: float, answer: Answer) -> dict[str, Any]:
    """The answer as data."""
    keys = ("joints", "form", "rows", "derivative", "output")
    return {
        "max_error": largest,
        "domain": asdict(request.domain),
        "request": {key: getattr(request, key) for key in keys},
        **asdict(answer),
    }
