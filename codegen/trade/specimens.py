"""What routines of joints and of scenes are judged by: blocks, poses over a domain, and the box that holds them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from codegen.emit.joint_subject import JointSubject
from codegen.emit.routine import Routine
from codegen.emit.scene_subject import SceneSubject
from codegen.errors import InternalError
from codegen.ir.program import Program
from codegen.measure.bounds import ARITHMETICS, Box
from codegen.measure.constraints import Pose, Row
from codegen.measure.draw import COLUMNS, Points, sobol_points
from codegen.measure.pose_boxes import pose_box
from codegen.measure.pose_domain import MOST_TURNS, Block, PoseDomain, blocks
from codegen.measure.poses import Poses, poses_at
from codegen.measure.row_names import conventional_rows, parametric_rows
from codegen.passes.given_trigonometry import SINES_COSINES
from codegen.scenes.numbers import rows_of
from codegen.spec.scene import COORDINATE_UNITS
from codegen.trade.scene_motion import TRAVEL, SceneMotion
from codegen.trade.scene_poses import SceneSampler

_MARGIN = 1 + 1e-6


@dataclass(frozen=True, eq=False)
class SampledScene(SceneSubject):
    """A scene as the subject of routines that are judged.

    Attributes:
        start: pose at t = 0, all joints closed.
        form: of all joints that may have it; empty where the scene chooses.
    """

    start: Pose | None = None
    form: str = ""

    @cached_property
    def sampler(self) -> SceneSampler:
        """Draws its poses."""
        if self.start is None:
            raise InternalError("a scene without a pose")
        return SceneSampler(SceneMotion(self.system, self.start))


def routine_name(routine: Routine) -> str:
    """The symbol; of a scene whose form was asked for, with that form."""
    subject = routine.subject
    form = subject.form if isinstance(subject, SampledScene) else ""
    return f"{routine.symbol} --form {form}" if form else routine.symbol


def joint_subject(routine: Routine) -> JointSubject:
    """The joint that a routine is of."""
    if not isinstance(routine.subject, JointSubject):
        raise InternalError(f"{routine.symbol} is not of a joint")
    return routine.subject


def blocks_of(routine: Routine) -> tuple[Block, ...]:
    """The blocks of a routine's outputs."""
    rows = _rows(routine)
    return tuple(block for output in routine.straight.outputs for block in blocks(output, rows))


def poses_over(routine: Routine, domain: PoseDomain, points: Points, is_converged: bool) -> Poses:
    """Poses of points of the unit cube that are `columns_of` wide."""
    if isinstance(routine.subject, SampledScene):
        return routine.subject.sampler.poses(domain, points, is_converged)
    subject = joint_subject(routine)
    return poses_at(subject.joint, subject.variant, routine.program.arguments, domain, points, is_converged)


def columns_of(routine: Routine) -> int:
    """Dimensions of the points that poses are made of."""
    return routine.subject.sampler.columns if isinstance(routine.subject, SampledScene) else COLUMNS


def box_over(routine: Routine, domain: PoseDomain, real: str) -> Box:
    """The box of inputs that holds every pose of a domain."""
    if isinstance(routine.subject, SampledScene):
        return _scene_box(routine.straight, routine.subject, domain, real)
    subject = joint_subject(routine)
    return pose_box(routine.straight, subject.joint, subject.variant, domain, real)


def _rows(routine: Routine) -> tuple[Row, ...]:
    if isinstance(routine.subject, SampledScene):
        return _scene_rows(routine.subject)
    subject = joint_subject(routine)
    if subject.variant.form == "conventional":
        return conventional_rows(subject.joint)
    return parametric_rows(subject.joint, subject.variant.rows or "")


def _scene_rows(subject: SampledScene) -> tuple[Row, ...]:
    assembly = subject.assembly
    rows = [row for joint in assembly.scene.joints for row in rows_of(assembly.forms[joint.name])]
    units = [u for p in assembly.placed if p.form.coordinates for u in COORDINATE_UNITS[p.joint.type]]
    drives = [Row("drive", "m" if units[driven.alpha] == "m" else "1") for driven in subject.system.drives]
    return (*(rows[row] for row in assembly.rows), *drives)


def _scene_box(program: Program, subject: SampledScene, domain: PoseDomain, real: str) -> Box:
    """Intervals around the pose at t = 0, as far as `SceneSampler` goes; nothing else is known of them."""
    sampler = subject.sampler
    assembly, start, units = subject.assembly, sampler.motion.start, sampler.motion.units(domain.s)
    size = assembly.arrays.position
    reach = (TRAVEL + domain.misfit) * domain.s
    slips = units[len(units) - len(start.alpha) :] * (TRAVEL + domain.misfit)
    inputs: dict[str, list[tuple[float, float]]] = {
        "r": [_around(float(x), reach) for body in start.r for x in body[:size]],
        "A": [_around(0.0, 1 + domain.drift)] * (size * size * len(start.r)),
        "alpha": [_around(float(x), float(slip)) for x, slip in zip(start.alpha, slips, strict=True)],
        "revolutions": [_around(0.0, float(MOST_TURNS))] * assembly.counted,
        "velocity": [_around(0.0, domain.velocity)] * len(units),
        "lambda": [_around(0.0, domain.multiplier)] * subject.system.row_count,
        "t": [(0.0, 1.0)],
        SINES_COSINES: [_around(0.0, 1.0)] * (2 * len(start.alpha)),
    }
    unit = ARITHMETICS[real].unit
    deviation = {("A", k): unit + domain.drift for k in range(len(inputs["A"]))}
    deviation |= {(SINES_COSINES, k): unit for k in range(len(inputs[SINES_COSINES]))}
    return Box({a.name: inputs[a.name] for a in program.used_arguments()}, {}, deviation)


def _around(middle: float, size: float) -> tuple[float, float]:
    wide = size * _MARGIN + abs(middle) * (_MARGIN - 1)
    return middle - wide, middle + wide


def sample(routine: Routine, domain: PoseDomain, count: int, is_converged: bool) -> Poses:
    """Poses of Sobol points."""
    return poses_over(routine, domain, sobol_points(count, columns_of(routine)), is_converged)
