"""What lowers the floor of the inputs where a budget cannot be met: changes of the inputs, each measured."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from codegen.emit.joint_subject import JointSubject
from codegen.measure.pose_domain import PoseDomain
from codegen.measure.routine_builds import Built, built
from codegen.trade.builds import prepared_for
from codegen.trade.judgement import SAFETY, Judgement, judged, timing_inputs
from codegen.trade.programs import builds_folder
from codegen.trade.specimens import routine_name

TIMES = 15
"""Rounds of a timer."""


@dataclass(frozen=True, slots=True)
class Cure:
    """A change of the inputs that lowers the floor: what, the largest error that is left with it, and its time."""

    name: str
    searched: float
    nanoseconds: float


def cures(domain: PoseDomain, candidates: Sequence[tuple[Built, float]], best: Judgement) -> Iterator[Cure]:
    """Changes of the inputs, each measured with the most accurate candidate."""
    one = next(
        each for each, _ in candidates if (routine_name(each.routine), each.build.name) == (best.routine, best.build)
    )
    given = prepared_for(one.routine, replace(one.build, trigonometry="given")) if one.build.lanes == 1 else None
    tries: list[tuple[str, Built, PoseDomain]] = [
        ("orthonormalise the attitudes", one, replace(domain, drift=0.0)),
    ]
    if isinstance(one.routine.subject, JointSubject):
        relative = replace(domain, r=0.0, distance=0.0)
        tries.insert(0, ("give the relative position: r_j - r_i for r_j, 0 for r_i", one, relative))
        within = replace(domain, angle=min(domain.angle, math.pi))
        tries.insert(1, ("keep angles as revolutions and an angle in [-pi, pi]", one, within))
    if given is not None:
        tries.append(("give sines and cosines", built(given, one.build, builds_folder()), domain))
    for name, changed, where in tries:
        if changed is not one or where != domain:
            found = judged(changed, best.nanoseconds, where, 0.0)
            time = statistics.median(changed.timer(timing_inputs(changed, domain))() for _ in range(TIMES))
            if found.searched < best.searched / SAFETY:
                yield Cure(name, found.searched, time)
