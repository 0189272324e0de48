"""Judge one compiled routine over a domain by its total error: bound, floor of the inputs, search."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from codegen.measure.adversary import searched
from codegen.measure.bounds import ARITHMETICS, rounding_bounds
from codegen.measure.double_double import DoubleDouble
from codegen.measure.draw import Points, sobol_points
from codegen.measure.errors import number_type
from codegen.measure.judge import block_errors, true_values
from codegen.measure.pose_domain import Block, PoseDomain
from codegen.measure.poses import exactly
from codegen.measure.routine_builds import Built
from codegen.trade.specimens import blocks_of, box_over, columns_of, poses_over, routine_name, sample

SAMPLES = 256
SEARCH_ROUNDS = 4
SAFETY = 2.0
"""Of a searched error that is not proven."""


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


def timing_inputs(one: Built, domain: PoseDomain) -> Any:
    """Inputs of a few poses, for timers."""
    return sample(one.routine, domain, 8, True).given(number_type(one.build.real))


def judged(one: Built, nanoseconds: float, domain: PoseDomain, largest: float) -> Judgement:
    """Judge one candidate: bound first, then search."""
    judged_blocks = blocks_of(one.routine)
    scales = np.array([domain.scale(block.output, block.is_rotation) for block in judged_blocks])
    start = sobol_points(SAMPLES, columns_of(one.routine))
    floor = max(float(np.max(_floor(one, domain, start, state) / scales)) for state in (True, False))
    bound = _bound(one, domain, judged_blocks, scales)
    judges = [partial(_total, one, domain, scales, state) for state in (True, False)]
    found = [searched(judge, start, SEARCH_ROUNDS) for judge in judges]
    worst = max(found, key=lambda each: float(np.max(each.searched)))
    block = int(np.argmax(worst.searched))
    most = float(worst.searched[block])
    verdict = "PROVEN" if bound <= largest else "MEASURED" if SAFETY * most <= largest else "OVER"
    return Judgement(
        routine_name(one.routine),
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
    if one.build.real not in ARITHMETICS:
        return float("inf")
    program = one.routine.straight
    box = box_over(one.routine, domain, one.build.real)
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
    poses = poses_over(one.routine, domain, points, is_converged)
    found = one.values(poses.given(number_type(one.build.real)))
    truth = true_values(one.routine.straight, poses.ideal)
    rows = {name: list(values) for name, values in found.items()}
    return block_errors(rows, truth, blocks_of(one.routine), len(points)) / scales[:, None]


def _floor(one: Built, domain: PoseDomain, points: Points, is_converged: bool) -> Any:
    """What rounded inputs alone do to each block, at most: [blocks]."""
    poses = poses_over(one.routine, domain, points, is_converged)
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
