"""The domain of a budget as conditions on the inputs of a routine: of joints and of scenes."""

from __future__ import annotations

from dataclasses import replace

from codegen.emit.routine import Routine
from codegen.emit.scene_subject import SceneSubject
from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.measure.bounds import ARITHMETICS
from codegen.measure.constraints import Pose
from codegen.measure.domain_check import Conditions, domain_check
from codegen.measure.named_ranges import gap_length
from codegen.measure.pose_domain import PoseDomain
from codegen.passes.unroll import unroll
from codegen.trade.specimens import SampledScene, box_over, joint_subject

_ROUNDINGS = 32
"""How many times what entries of an attitude may be off the norm may be, with the roundings of the check."""


def joint_check(domain: PoseDomain, real: str, routine: Routine) -> Program:
    """The conditions on a joint's inputs: intervals, rotations, lengths of attachments, positions near each other."""
    joint = joint_subject(routine).joint
    conditions = Conditions(
        [((name, first), 3) for name, first in (("A_i", 0), ("A_j", 0), ("geometry", 3), ("geometry", 15))],
        _tolerance(domain, real),
        [(("geometry", first), domain.s * (1 + 1e-6)) for first in (0, 12)],
        [(("r_i", 0), ("r_j", 0), (gap_length(joint, domain) + 2 * domain.s) * (1 + 1e-6))],
    )
    return domain_check(routine.straight, box_over(routine, domain, real), conditions)


def scene_check(domain: PoseDomain, real: str, routine: Routine, start: Pose) -> Program:
    """The conditions on a scene's inputs: intervals, and attitudes that are rotations."""
    subject = routine.subject
    assert isinstance(subject, SceneSubject)
    sampled = SampledScene(subject.system, subject.state, subject.row_names, None, start)
    size = subject.assembly.arrays.position
    rotations = [(("A", size * size * k), size) for k in range(len(start.r))]
    whole = unroll(routine.program) if isinstance(routine.program, Looped) else routine.program
    box = box_over(replace(routine, subject=sampled, program=whole), domain, real)
    return domain_check(whole, box, Conditions(rotations, _tolerance(domain, real)))


def _tolerance(domain: PoseDomain, real: str) -> float:
    return _ROUNDINGS * (ARITHMETICS[real].unit + domain.drift)
