"""From a scene to the files of its package."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import codegen
from codegen.dynamics.layout import layout
from codegen.emit.routine import Routine
from codegen.emit.scene_package import ScenePackage, scene_files
from codegen.emit.scene_record import scene_record
from codegen.emit.scene_subject import SceneSubject
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.measure.assembly import assemble
from codegen.measure.constraints import Pose
from codegen.measure.evaluations import Task, measured
from codegen.measure.mobility import Mobility, mobility
from codegen.measure.mobility_text import lines
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.attitude import attitude_program
from codegen.mechanics.mass import mass
from codegen.mechanics.plan import Plan, plan
from codegen.mechanics.system import System
from codegen.parallel import parallel
from codegen.passes import simplify
from codegen.scenes.bill import Bill, bill
from codegen.scenes.compose import compose
from codegen.scenes.forms import Choice, choose_forms, constraint_quantities
from codegen.scenes.loops import LOOPS, decided
from codegen.scenes.motion import jacobian_program, residual_program
from codegen.scenes.numbers import constraint_system, initial_pose, plane_rows, rows_of
from codegen.scenes.plane_notes import motion_notes
from codegen.scenes.programs import program, without_zero_rows
from codegen.scenes.readme import Told, readme
from codegen.scenes.start import start
from codegen.spec.plane import flattened, planar_normal
from codegen.spec.request import REALS
from codegen.spec.scene import SCENE_FORMS, Scene
from codegen.spec.sections import alike
from flopcount.count import count
from flopcount.counts import Counts

Check = Callable[[Routine, Pose], Program]
"""Gives the conditions on the inputs of a routine, by the pose at t = 0."""

Progress = Callable[[str], None]
"""Told what is finished."""


@dataclass(frozen=True)
class Judged:
    """A scene whose joints have their forms and whose rows are chosen.

    Attributes:
        choices: joint name -> its form and why.
        undropped: the scene with all rows that are not identically zero.
        assembly: the scene with independent rows.
        mobility: what was found of its rows.
        pose: at t = 0, all joints closed.
    """

    choices: Mapping[str, Choice]
    undropped: Assembly
    assembly: Assembly
    mobility: Mobility
    pose: Pose


def judge(scene: Scene, form: str | None = None) -> Judged:
    """Give the joints their forms and choose the rows.

    Args:
        scene: the mechanism.
        form: of all joints that may have it, in the place of what the scene says.

    Raises:
        SpecificationError: a joint cannot be closed.
    """
    choices = choose_forms(scene, form)
    forms = {name: choice.variant for name, choice in choices.items()}
    undropped = without_zero_rows(Assembly(scene, forms))
    system = constraint_system(scene, forms, undropped.dropped)
    assembled = assemble(system, initial_pose(scene, forms))
    if not assembled.is_closed:
        raise SpecificationError(
            Mistake(f'joint "{gap.joint}"', f"cannot be closed: {gap}", "correct the dimensions of its loop")
            for gap in assembled.open_joints
        )
    found = mobility(system, assembled.pose)
    first = plane_rows(scene)
    kept = {undropped.rows[row - first] for row in found.kept if row >= first}
    redundant = frozenset(undropped.rows) - kept
    assembly = replace(undropped, dropped=undropped.dropped | redundant)
    return Judged(choices, undropped, assembly, found, assembled.pose)


def wanted(scene: Scene) -> dict[str, tuple[str, ...]]:
    """Say which quantities each routine of a scene evaluates; ``all``, those of the constraints, comes last.

    Nothing is emitted that is not asked for: ``all`` needs two quantities of the constraints.
    """
    asked, fused = scene.wanted.quantities or _default(scene), constraint_quantities(scene)
    names = [name for name in asked if name != "residual"]
    names += ["residual", "jacobian"] if "residual" in asked else []
    is_fused = len(fused) > 1 and set(fused) <= set(asked)
    return {name: (name,) for name in names} | ({"all": fused} if is_fused else {})


def _default(scene: Scene) -> tuple[str, ...]:
    """What is generated of a scene that asks for nothing: everything for an integrator, if its bodies have mass."""
    constraints = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma")
    return (*constraints, "mass", "force", "residual") if all(body.mass for body in scene.bodies) else constraints


def generate_scene(
    scene: Scene,
    form: str | None = None,
    real: str = "double",
    progress: Progress = lambda _: None,
    measure: bool = False,
    loops: str = "auto",
    check: Check | None = None,
) -> dict[str, bytes]:
    """Generate the package of a scene in memory.

    Args:
        scene: the mechanism.
        form: of all joints that may have it, in the place of what the scene says.
        real: ``double`` or ``float``.
        progress: told each routine as it is done.
        measure: whether the README tells what the steps of the bill take on this machine.
        loops: whether equal parts are run in loops, one of `codegen.scenes.loops.LOOPS`.
        check: gives the conditions that a routine asserts in debug builds.

    Returns:
        Path below the package's folder -> content.

    Raises:
        SpecificationError: a joint cannot be closed, or there is no compiler to measure with.
    """
    notes = motion_notes(scene)
    scene = flattened(scene) if scene.motion == "planar" else scene
    judged = judge(scene, form)
    progress("rows")
    system = System(judged.assembly)
    planned = plan(judged.assembly)
    jobs = [_Job(scene.name, planned, name, names, loops) for name, names in wanted(scene).items()]
    built = parallel(_built, jobs, lambda job: progress(job.output))
    is_looped = any(isinstance(found, Looped) for found, _ in built)
    state = layout(system, "index2")
    subject = SceneSubject(system, state, row_names(judged.assembly), planned if is_looped else None)
    routines = tuple(
        Routine(subject, job.output, found, count(found), "S1 Tables 1 to 5, for this scene")
        for job, (found, _) in zip(jobs, built, strict=True)
    )
    specification = hashlib.sha256(repr((codegen.__version__, scene, form, real, loops)).encode()).hexdigest()
    made = _bill(judged, routines, form)
    progress("bill")
    measurement = measured([Task(item.programs, item.additions) for item in made.items], real) if measure else None
    text = readme(
        Told(subject, routines, judged.choices, lines(judged.mobility), len(judged.undropped.rows), made, measurement),
        codegen.__version__,
        specification,
        notes,
    )
    casadi = {job.output: data for job, (_, data) in zip(jobs, built, strict=True)}
    first = start(system, judged.pose, state)
    record = scene_record(subject)
    made_of = ScenePackage(scene.name, routines, codegen.__version__, specification, real, record, casadi, first, text)
    if check is not None:
        checks = {routine.output: check(routine, judged.pose) for routine in routines}
        made_of = replace(made_of, choices=True, checks=checks)
    return scene_files(made_of)


def _bill(judged: Judged, routines: Sequence[Routine], form: str | None) -> Bill:
    """The bill of all constraint quantities at once, if they are emitted; with what it would be in the plane."""
    scene = judged.assembly.scene
    names = constraint_quantities(scene)
    fused = [routine for routine in routines if tuple(o.name for o in routine.program.outputs) == names]
    if not fused:
        return Bill(())
    items = bill(judged.assembly, judged.undropped, fused[-1].program, bool(System(judged.assembly).drives))
    if scene.motion == "planar" or planar_normal(scene) is None:
        return Bill(items)
    return Bill(items, _in_plane(flattened(scene), form, names))


def _in_plane(scene: Scene, form: str | None, names: tuple[str, ...]) -> Counts:
    """Operations in the plane; of sections that are alike one is judged."""
    total = Counts()
    for same in alike(scene):
        judged = judge(same[-1].scene(scene), form)
        total += count(program(System(judged.assembly), names)).times(len(same))
    return total


def steps(scene: Scene) -> int:
    """Number of times that progress is told."""
    return 2 + len(wanted(scene))


def check_options(form: str | None, real: str, loops: str = "auto") -> None:
    """Refuse options that there are not.

    Raises:
        SpecificationError: all of them at once.
    """
    asked = (("--form", form, SCENE_FORMS), ("--real", real, REALS), ("--loops", loops, LOOPS))
    mistakes = [
        Mistake(name, f'there is no "{value}"', nearest(value, known))
        for name, value, known in asked
        if value is not None and value not in known
    ]
    if mistakes:
        raise SpecificationError(mistakes)


@dataclass(frozen=True)
class _Job:
    name: str
    plan: Plan
    output: str
    names: tuple[str, ...]
    loops: str


def _built(job: _Job) -> tuple[Program | Looped, bytes]:
    from codegen.emit import casadi

    found = decided(compose(job.plan, lambda system: _program(system, job)), job.loops)
    return found, casadi.serialised(casadi.casadi_function(f"jg_{job.name}_{job.output}", found))


def _program(system: System, job: _Job) -> Program:
    assembly = system.assembly
    match job.output:
        case "orthonormalise" | "check_orthonormal":
            return simplify(attitude_program(job.output, len(assembly.scene.bodies), assembly.arrays.is_planar))
        case "mass":
            return mass(assembly.scene, assembly.arrays, len(assembly.columns), system.arguments())
        case "residual":
            return residual_program(system)
        case "jacobian":
            return jacobian_program(system)
    return program(system, job.names)


def row_names(assembly: Assembly) -> tuple[tuple[str, str], ...]:
    """Joint and name of each row of all joints."""
    return tuple(
        (joint.name, row.name) for joint in assembly.scene.joints for row in rows_of(assembly.forms[joint.name])
    )
