"""Simulate a scene and give the files of the run."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from codegen.errors import JointgenError, Mistake, SpecificationError, nearest
from codegen.measure.compile import compiler
from codegen.scenes.motion_record import record
from codegen.scenes.run import Prepared, Progress, Settings, prepare
from codegen.scenes.summary import as_json, summary
from codegen.scenes.watched_run import Watched, watched_run
from codegen.simulate.limits import limit_mistakes, run_manifest
from codegen.simulate.sundials import sundials
from codegen.simulate.trajectory import Trajectory, as_csv
from codegen.spec.request import DERIVATIVES
from codegen.spec.scene import SCENE_FORMS, Scene


@dataclass(frozen=True, slots=True)
class Simulated:
    """The files of a run.

    Attributes:
        files: path below the folder -> content.
        words: the run in a line.
        notes: what a user should know of the run.
        failure: why it stopped before the end; empty if it did not.
        trajectory: of the run, for pictures.
    """

    files: Mapping[str, bytes]
    words: str
    notes: tuple[str, ...]
    failure: str
    trajectory: Trajectory


def simulated(scene: Scene, settings: Settings, progress: Progress = lambda _: None) -> Simulated:
    """Simulate a scene.

    Args:
        scene: the mechanism.
        settings: how.
        progress: told the time reached.

    Raises:
        SpecificationError: the scene cannot be simulated.
    """
    prepared = prepare(scene, settings)
    watched = watched_run(prepared, settings, progress)
    told = record(prepared, watched.run)
    numbers = summary(prepared, watched, settings, told)
    files = {
        "trajectory.csv": as_csv(told.trajectory),
        "summary.json": as_json(numbers),
        "manifest.json": run_manifest("scene", scene.name),
    }
    words = f"{numbers['time_reached']:g} s in {numbers['steps']} steps, drift {numbers['constraint_drift']:.1e}"
    encoded = {path: text.encode() for path, text in files.items()}
    return Simulated(encoded, words, tuple(_notes(prepared, watched)), watched.run.failure, told.trajectory)


_CHANGED = 1e-9
"""m, m/s or rad/s: less is rounding."""


def _notes(prepared: Prepared, watched: Watched) -> Iterator[str]:
    """What a user should know of a run that was done."""
    moved, changed = prepared.moved, prepared.motion.changed
    if moved > _CHANGED:
        yield f"bodies were moved by up to {moved:.3g} m to close the joints at the start"
    if changed > _CHANGED:
        yield f"velocities were changed by up to {_most_changed(prepared)} to satisfy the constraints at the start"
    if prepared.dof == 0 and not prepared.system.drives:
        yield "the mechanism has no degree of freedom: it does not move"
    for passage in watched.passages:
        yield f"went through a {passage.words}"


def _most_changed(prepared: Prepared) -> str:
    """By how much the velocity of a body was changed at most, and whose."""
    arrays, motion = prepared.system.assembly.arrays, prepared.motion
    body, component = divmod(motion.most_changed, arrays.displacements)
    unit = "m/s" if component < arrays.position else "rad/s"
    return f'{motion.changed:.3g} {unit} (body "{prepared.scene.bodies[body].name}")'


def check_tools() -> None:
    """Refuse to start without a C compiler or SUNDIALS.

    Raises:
        SpecificationError: what is missing, all at once.
    """
    mistakes: list[Mistake] = []
    for needed in (compiler, sundials):
        try:
            needed()
        except JointgenError as error:
            mistakes += error.mistakes
    if mistakes:
        raise SpecificationError(mistakes)


def check_settings(settings: Settings) -> None:
    """Refuse settings that cannot be met.

    Raises:
        SpecificationError: all mistakes at once.
    """
    mistakes = [*limit_mistakes(settings.tolerance, settings.duration, settings.outputs)]
    if settings.index not in (1, 2):
        mistakes.append(Mistake("--index", f"there is no index {settings.index}", "known: 1, 2"))
    if settings.derivative not in (None, *DERIVATIVES):
        what = f'there is no "{settings.derivative}"'
        mistakes.append(Mistake("--derivative", what, nearest(settings.derivative, DERIVATIVES)))
    if settings.form is not None and settings.form not in SCENE_FORMS:
        mistakes.append(Mistake("--form", f'there is no "{settings.form}"', nearest(settings.form, SCENE_FORMS)))
    if mistakes:
        raise SpecificationError(mistakes)
