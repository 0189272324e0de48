"""Simulate a scene: from a mechanism to its trajectory."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from codegen.dynamics.layout import Layout, layout
from codegen.errors import Mistake, SpecificationError
from codegen.ir.program import Program
from codegen.measure.constraints import Array, Pose
from codegen.mechanics.mass import mass
from codegen.mechanics.system import System
from codegen.scenes.driven import check_drives
from codegen.scenes.equations import ACCELERATIONS, equations, lower_run, quantities
from codegen.scenes.generate import Judged, judge
from codegen.scenes.state import euler_parameters, program_arrays, rate_matrix
from codegen.simulate.compiled import Compiled
from codegen.simulate.ida import FAILURES, Ida, Statistics, Tolerances
from codegen.simulate.start import Motion, consistent_motion
from codegen.spec.plane import InPlane, in_plane
from codegen.spec.scene import Scene

Progress = Callable[[float], None]
"""Told the time reached, s."""


@dataclass(frozen=True, slots=True)
class Settings:
    """How a scene is simulated.

    Attributes:
        duration: s.
        outputs: number of output times after the start.
        tolerance: of the error test, relative; absolute in m, rad, m/s and rad/s.
        form: of all joints that may have it, in the place of what the scene says.
        derivative: of the parametric joints, in the place of what the scene says.
        index: 2 (stabilised after Gear, Gupta and Leimkuhler) or 1 (after Baumgarte).
        left_out: second derivatives that the Jacobian lacks, see `codegen.dynamics.jacobian.SECOND`.
        through_singular: go on through singular configurations, on the smooth branch.
    """

    duration: float = 1.0
    outputs: int = 200
    tolerance: float = 1e-8
    form: str | None = None
    derivative: str | None = None
    index: int = 2
    left_out: tuple[str, ...] = ()
    through_singular: bool = False


@dataclass(frozen=True)
class Prepared:
    """A scene ready to run; it may run many times.

    Attributes:
        scene: as the file has it.
        plane: how it was laid into its plane, in planar motion.
        judged: forms and rows.
        system: joints, drives and forces.
        layout: of the state.
        values: ``phi_q``, ``gamma`` and ``force``.
        inertia: ``mass``.
        equations: compiled.
        motion: at the start.
        y: state at the start.
        ydot: its rate.
    """

    scene: Scene
    plane: InPlane | None
    judged: Judged
    system: System
    layout: Layout
    values: Program
    inertia: Program
    equations: Compiled
    motion: Motion
    y: Array
    ydot: Array

    @cached_property
    def identity(self) -> Array:
        """[n] 1 where the rate of an entry is in the residual, 0 elsewhere."""
        return np.array(self.layout.is_differential, dtype=np.float64)

    @property
    def dof(self) -> int:
        """Degrees of freedom that drives leave."""
        return self.judged.mobility.freedoms - len(self.system.drives)

    @property
    def moved(self) -> float:
        """How far bodies were moved to close the joints at the start, m."""
        given = [body.position for body in self.judged.assembly.scene.bodies]
        return float(np.max(np.abs(self.judged.pose.r - np.array(given, dtype=np.float64)), initial=0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Run:
    """States at the output times that were reached.

    Attributes:
        t: [n] s.
        y: [n, size].
        ydot: [n, size].
        statistics: of the integrator.
        wall_time: s, of the integration.
        failure: why it stopped before the end; empty if it did not.
    """

    t: Array
    y: Array
    ydot: Array
    statistics: Statistics
    wall_time: float
    failure: str


def prepare(scene: Scene, settings: Settings) -> Prepared:
    """Derive, compile and start a scene.

    Raises:
        SpecificationError: joints that cannot be closed, bodies without mass, drives that have nothing left to move, no
            compiler, no SUNDIALS.
    """
    massless = [body.name for body in scene.bodies if not body.mass]
    if massless:
        raise SpecificationError(
            Mistake(f'body "{name}"', "has no mass", "give mass (kg) and inertia (kg m^2)") for name in massless
        )
    plane = in_plane(scene) if scene.motion == "planar" else None
    chosen = with_forms(plane.scene if plane else scene, settings.form)
    derivative = settings.derivative or chosen.wanted.derivative
    judged = judge(replace(chosen, wanted=replace(chosen.wanted, derivative=derivative, point="world")))
    system = System(judged.assembly)
    form = "condensed" if settings.index == 2 else "index1"
    state = layout(system, form)
    lower_run(system, judged.undropped, form)
    values = quantities(system, ACCELERATIONS)
    inertia = mass(judged.assembly.scene, judged.assembly.arrays, len(judged.assembly.columns), system.arguments())
    check_drives(system, values, judged.pose)
    motion = _motion(system, values, inertia, judged.pose, _velocity(system))
    y, ydot = _state(system, state, judged.pose, motion)
    return Prepared(
        scene,
        plane,
        judged,
        system,
        state,
        values,
        inertia,
        equations(system, form, y, ydot, settings.left_out),
        motion,
        y,
        ydot,
    )


def with_forms(scene: Scene, form: str | None) -> Scene:
    """Give all joints that may have it a form; screws are parametric, since their angle goes on beyond a turn.

    Raises:
        SpecificationError: the scene asks for a screw in conventional form.
    """
    wrapped = [joint.name for joint in scene.joints if joint.type == "screw" and joint.form == "conventional"]
    if wrapped and form is None:
        what = "the conventional form of a screw knows its angle within one turn only"
        remedy = 'use form = "parametric" or "auto"'
        raise SpecificationError(Mistake(f'joint "{name}"', what, remedy) for name in wrapped)
    forms = ["parametric" if joint.type == "screw" else form or joint.form for joint in scene.joints]
    joints = (replace(joint, form=chosen) for joint, chosen in zip(scene.joints, forms, strict=True))
    return replace(scene, joints=tuple(joints))


def _velocity(system: System) -> Array:
    """Velocities at the start as the state has them; rates of joint coordinates follow from those of the bodies."""
    arrays = system.assembly.arrays
    size = arrays.position
    velocity = np.zeros(len(system.assembly.columns))
    for k, body in enumerate(system.assembly.scene.bodies):
        first = arrays.displacements * k
        velocity[first : first + size] = body.velocity[:size]
        turns = body.angular_velocity if size == 3 else body.angular_velocity[2:]
        velocity[first + size : first + arrays.displacements] = turns
    return velocity


def _motion(system: System, values: Program, inertia: Program, pose: Pose, velocity: Array, t: float = 0.0) -> Motion:
    """The consistent motion at a time nearest to given velocities, translations in world axes."""
    phi_t = np.array(system.phi_t(t), dtype=np.float64)
    wanted = _turned(system, pose, velocity, is_back=True)
    found = consistent_motion(values, inertia, program_arrays(system, pose, t), wanted, phi_t)
    return replace(
        found,
        velocity=_turned(system, pose, found.velocity),
        acceleration=_turned(system, pose, found.acceleration),
    )


def _turned(system: System, pose: Pose, values: Array, is_back: bool = False) -> Array:
    """Translations from the axes of the programs to the world's, or back."""
    found, arrays = values.copy(), system.assembly.arrays
    for k, A in enumerate(pose.A if system.assembly.translations == "body" else ()):
        part = slice(arrays.displacements * k, arrays.displacements * k + arrays.position)
        turn = A[: arrays.position, : arrays.position]
        found[part] = (turn.T if is_back else turn) @ values[part]
    return found


def consistent_state(prepared: Prepared, pose: Pose, velocity: Array, t: float) -> tuple[Array, Array]:
    """The state at a pose and its rate, with the consistent velocities nearest to given ones.

    Args:
        prepared: the scene.
        pose: on the constraints.
        velocity: as the state has them.
        t: s.
    """
    system = prepared.system
    motion = _motion(system, prepared.values, prepared.inertia, pose, velocity, t)
    return _state(system, prepared.layout, pose, motion)


def _state(system: System, layout: Layout, pose: Pose, motion: Motion) -> tuple[Array, Array]:
    """The state of a motion, translations in world axes, and its rate."""
    arrays = system.assembly.arrays
    y, ydot = np.zeros(layout.positions.stop), np.zeros(layout.positions.stop)
    stride = 3 if arrays.is_planar else 7
    parameters = euler_parameters(pose.A[None])[0]
    for k in range(len(pose.r)):
        first, place = arrays.displacements * k, stride * k
        y[place : place + arrays.position] = pose.r[k, : arrays.position]
        ydot[place : place + arrays.position] = motion.velocity[first : first + arrays.position]
        omega = motion.velocity[first + arrays.position : first + arrays.displacements]
        if arrays.is_planar:
            y[place + 2], ydot[place + 2] = np.arctan2(pose.A[k, 1, 0], pose.A[k, 0, 0]), omega[0]
        else:
            y[place + 3 : place + 7] = parameters[k]
            ydot[place + 3 : place + 7] = 0.5 * rate_matrix(parameters[k]).T @ omega
    y[layout.coordinates] = pose.alpha
    ydot[layout.coordinates] = motion.velocity[arrays.displacements * len(pose.r) :]
    zeros, places = np.zeros_like(motion.multipliers), list(layout.places)
    return (
        np.concatenate([y, motion.velocity, motion.multipliers, zeros])[places],
        np.concatenate([ydot, motion.acceleration, zeros, zeros])[places],
    )


def run(prepared: Prepared, settings: Settings, progress: Progress = lambda _: None) -> Run:
    """Integrate.

    Args:
        prepared: the scene.
        settings: duration, outputs and tolerance.
        progress: told the time reached.
    """
    times = np.linspace(0.0, settings.duration, settings.outputs + 1)
    states, rates, reached = [prepared.y], [prepared.ydot], [0.0]
    failure = ""
    start = time.perf_counter()
    with integrator(prepared, settings) as ida:
        for t in times[1:]:
            now, code = ida.advance(float(t))
            if code:
                failure = f"at t = {now:.9g} s the integrator {FAILURES.get(code, f'stopped with {code}')}"
                break
            states.append(ida.y.copy())
            rates.append(ida.ydot.copy())
            reached.append(now)
            progress(now)
        statistics = ida.statistics()
    wall_time = time.perf_counter() - start
    return Run(np.array(reached), np.array(states), np.array(rates), statistics, wall_time, failure)


def integrator(
    prepared: Prepared, settings: Settings, t: float = 0.0, y: Array | None = None, ydot: Array | None = None
) -> Ida:
    """Start IDA, at the start of the scene or from a consistent state."""
    layout = prepared.layout
    tolerances = Tolerances(settings.tolerance, _absolute(layout, settings.tolerance))
    first, rate = (prepared.y if y is None else y), (prepared.ydot if ydot is None else ydot)
    return Ida(prepared.equations, t, first, rate, prepared.identity, tolerances)


MULTIPLIERS_FREE = 1e10
"""Absolute tolerance of the multipliers: neither the error test nor Newton's iteration asks for their accuracy."""


def _absolute(layout: Layout, tolerance: float) -> Array:
    found = np.full(layout.size, MULTIPLIERS_FREE)
    found[: layout.velocities.stop] = tolerance
    return found
