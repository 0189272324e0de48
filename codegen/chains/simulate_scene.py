"""Simulate a scene by relative coordinates and give the files of the run."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from codegen.chains import simulate
from codegen.chains.generated import Generated
from codegen.chains.mechanism import Mechanism, mechanism
from codegen.chains.record import record
from codegen.chains.reduced import reduced
from codegen.chains.relative import relative
from codegen.chains.relative.convert import Relative
from codegen.chains.run import Progress
from codegen.chains.scene_motion import scene_motion
from codegen.chains.simulate import Settings
from codegen.chains.start import start
from codegen.chains.twists import twists
from codegen.errors import Mistake, SpecificationError
from codegen.measure.threads import one_thread
from codegen.scenes.simulate import Simulated
from codegen.scenes.summary import as_json
from codegen.simulate.limits import run_manifest
from codegen.simulate.trajectory import as_csv
from codegen.spec.scene import Body, Scene

Array = NDArray[np.float64]

_CHANGED = 1e-9
"""m/s or rad/s: less is rounding."""


@dataclass(frozen=True, slots=True, eq=False)
class Prepared:
    """A scene by relative coordinates, ready to be run.

    Attributes:
        scene: the mechanism.
        relative: as a chain.
        mechanism: the chain, with the speeds at which it starts.
        equations: compiled.
        settings: how it is run; the mode is that of the scene.
        changed: m/s or rad/s, by how much velocities were changed to satisfy the constraints at the start.
    """

    scene: Scene
    relative: Relative
    mechanism: Mechanism
    equations: Generated
    settings: Settings
    changed: float


def prepare(scene: Scene, settings: Settings) -> Prepared:
    """Derive and compile a scene by relative coordinates.

    Args:
        scene: the mechanism; with drives of all its freedoms it moves as they say, else under forces too.
        settings: how; the mode follows from the scene.

    Raises:
        SpecificationError: the scene cannot be run.
    """
    found = relative(scene)
    settings = replace(settings, mode=_mode(scene, found))
    simulate.check(found.chain, settings)
    with one_thread():
        equations = Generated(found.chain)
        ready = mechanism(found.chain, equations)
        changed = 0.0
        if settings.mode == "forward":
            ready, changed = _with_speeds(scene, found, ready, equations)
    return Prepared(scene, found, ready, equations, settings, changed)


def simulated_relative(scene: Scene, settings: Settings, progress: Progress = lambda _: None) -> Simulated:
    """Simulate a scene by relative coordinates.

    Args:
        scene: the mechanism.
        settings: how; the mode follows from the scene.
        progress: told the time reached.

    Raises:
        SpecificationError: the scene cannot be run.
    """
    ready = prepare(scene, settings)
    with one_thread():
        began = time.perf_counter()
        done = simulate.run(ready.mechanism, {}, ready.settings, progress)
        wall_time = time.perf_counter() - began
        told = record(ready.mechanism, ready.equations, done)
    trajectory = scene_motion(scene, ready.relative, told)
    numbers = simulate.summary(ready.mechanism, told, done, ready.settings) | {
        "initial_velocity_change": ready.changed,
        "wall_time": wall_time,
    }
    files = {
        "trajectory.csv": as_csv(trajectory),
        "summary.json": as_json(numbers),
        "manifest.json": run_manifest("scene", scene.name),
    }
    words = f"relative coordinates, {told.t[-1]:g} s, {len(told.t)} outputs"
    encoded = {path: text.encode() for path, text in files.items()}
    return Simulated(encoded, words, tuple(_notes(ready.relative, ready.changed)), done.failure, trajectory)


def _mode(scene: Scene, found: Relative) -> str:
    """As drives say, where all freedoms are driven, else under forces.

    Raises:
        SpecificationError: drives that depend on each other.
    """
    independents = found.chain.independents
    driven = [one.joint for one in independents if one.driven]
    what = f"its drive follows from the others: together they drive {len(driven)} of {len(independents)} freedoms"
    mistakes = [
        Mistake(f'joint "{joint.name}"', what, "leave out a drive; drives must not depend on each other")
        for joint in scene.joints
        for (link, _), one in zip(found.joints[joint.name].coordinates, joint.coordinates, strict=False)
        if one.drive is not None and link not in driven
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    return "inverse" if driven and len(driven) == len(independents) else "forward"


def _with_speeds(scene: Scene, found: Relative, ready: Mechanism, equations: Generated) -> tuple[Mechanism, float]:
    """Give the chain the speeds nearest to those of the bodies, weighed by the masses; tell how far they are off.

    Driven coordinates have the speeds of their drives.
    """
    q = start(ready, simulate.initial(ready, {})[0]).q
    N = reduced(equations, ready.part, q, np.zeros(len(ready.part.v))).rates.N
    moves = _moves(scene, found, equations, q) @ N
    wanted = np.concatenate([_velocity(body) for body in scene.bodies])
    weights = _weights(scene.bodies)
    speeds, free = simulate.initial(ready, {})[1], np.array([not one.driven for one in ready.chain.independents])
    rest = wanted - moves[:, ~free] @ speeds[~free]
    speeds[free] = np.linalg.lstsq(weights @ moves[:, free], weights @ rest)[0]
    independents = tuple(
        one if one.driven else replace(one, speed=Fraction(float(speed)))
        for one, speed in zip(ready.chain.independents, speeds, strict=True)
    )
    changed = float(np.max(np.abs(moves @ speeds - wanted), initial=0.0))
    return replace(ready, chain=replace(ready.chain, independents=independents)), changed


def _moves(scene: Scene, found: Relative, equations: Generated, q: Array) -> Array:
    """[6 nb, n] velocities of the centres of mass (world) and angular velocities (body axes) by the rates."""
    n, chain = len(q), found.chain
    frames = np.broadcast_to(equations.frames(q), (n, *equations.frames(q).shape))
    moving = twists(chain, frames, np.eye(n), np.zeros((n, n)))
    rows = []
    for body in scene.bodies:
        link, pose = found.bodies[body.name]
        R = np.eye(3) if link not in {one.name for one in chain.links} else frames[0, chain.index(link), :, :3]
        own = moving[link].at(np.broadcast_to(R @ np.array(pose.p, dtype=np.float64), (n, 3)))
        rows += [own.v.T, (R @ np.array(pose.R, dtype=np.float64)).T @ own.w.T]
    return np.concatenate(rows)


def _velocity(body: Body) -> Array:
    return np.array([*body.velocity, *body.angular_velocity], dtype=np.float64)


def _weights(bodies: tuple[Body, ...]) -> Array:
    """Square roots of masses and inertias: half the square of a weighed velocity is energy."""
    found = np.zeros((6 * len(bodies), 6 * len(bodies)))
    for k, body in enumerate(bodies):
        values, axes = np.linalg.eigh(np.array(body.inertia, dtype=np.float64))
        first = 6 * k
        found[first : first + 3, first : first + 3] = np.sqrt(float(body.mass)) * np.eye(3)
        found[first + 3 : first + 6, first + 3 : first + 6] = np.sqrt(np.maximum(values, 0.0))[:, None] * axes.T
    return found


def _notes(found: Relative, changed: float) -> Iterator[str]:
    yield from found.notes
    if changed > _CHANGED:
        yield f"velocities were changed by up to {changed:.3g} m/s or rad/s to satisfy the constraints at the start"
