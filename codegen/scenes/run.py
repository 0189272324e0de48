"""Simulate a scene: from a mechanism to its trajectory."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from codegen.dynamics.layout import Layout
from codegen.errors import Mistake, SpecificationError
from codegen.ir.program import Program
from codegen.measure.constraints import Array
from codegen.mechanics.mass import mass
from codegen.mechanics.system import System
from codegen.scenes.generate import Judged, judge
from codegen.scenes.motion import dae
from codegen.scenes.programs import estimate, program
from codegen.scenes.state import euler_parameters, program_arrays
from codegen.simulate.compiled import Compiled, compiled
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
        index: 2 (stabilised after Gear, Gupta and Leimkuhler) or 1 (after Baumgarte).
        left_out: second derivatives that the Jacobian lacks, see `codegen.dynamics.jacobian.SECOND`.
    """

    duration: float = 1.0
    outputs: int = 200
    tolerance: float = 1e-8
    form: str | None = None
    index: int = 2
    left_out: tuple[str, ...] = ()


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
        SpecificationError: joints that cannot be closed, bodies without mass, no compiler, no SUNDIALS.
    """
    massless = [body.name for body in scene.bodies if not body.mass]
    if massless:
        raise SpecificationError(
            Mistake(f'body "{name}"', "has no mass", "give mass (kg) and inertia (kg m^2)") for name in massless
        )
    plane = in_plane(scene) if scene.motion == "planar" else None
    judged = judge(plane.scene if plane else scene, settings.form)
    system = System(judged.assembly)
    equations = dae(system, f"index{settings.index}", settings.left_out)
    values = program(system, ("phi_q", "gamma", "force"), estimate)
    inertia = mass(judged.assembly.scene, judged.assembly.arrays, len(judged.assembly.columns), system.arguments())
    motion = _start(system, judged, values, inertia)
    y, ydot = _state(system, judged, equations.layout, motion)
    return Prepared(
        scene,
        plane,
        judged,
        system,
        equations.layout,
        values,
        inertia,
        compiled(scene.name, equations.residual, equations.jacobian),
        motion,
        y,
        ydot,
    )


def _start(system: System, judged: Judged, values: Program, inertia: Program) -> Motion:
    scene, arrays = system.assembly.scene, system.assembly.arrays
    size = arrays.position
    velocity = np.zeros(len(system.assembly.columns))
    for k, body in enumerate(scene.bodies):
        first = arrays.displacements * k
        v = np.array(body.velocity, dtype=np.float64)
        v = judged.pose.A[k].T @ v if system.assembly.translations == "body" else v
        velocity[first : first + size] = v[:size]
        turns = body.angular_velocity if size == 3 else body.angular_velocity[2:]
        velocity[first + size : first + arrays.displacements] = turns
    phi_t = np.array(system.phi_t, dtype=np.float64)
    return consistent_motion(values, inertia, program_arrays(system, judged.pose), velocity, phi_t)


def _state(system: System, judged: Judged, layout: Layout, motion: Motion) -> tuple[Array, Array]:
    """The state at the start and its rate."""
    arrays, pose = system.assembly.arrays, judged.pose
    y, ydot = np.zeros(layout.size), np.zeros(layout.size)
    velocity, acceleration = motion.velocity.copy(), motion.acceleration.copy()
    stride = 3 if arrays.is_planar else 7
    parameters = euler_parameters(pose.A[None])[0]
    for k in range(len(pose.r)):
        first, place = arrays.displacements * k, stride * k
        if system.assembly.translations == "body":
            for part in (velocity, acceleration):
                part[first : first + arrays.position] = (
                    pose.A[k][: arrays.position, : arrays.position] @ part[first : first + arrays.position]
                )
        y[place : place + arrays.position] = pose.r[k, : arrays.position]
        ydot[place : place + arrays.position] = velocity[first : first + arrays.position]
        omega = velocity[first + arrays.position : first + arrays.displacements]
        if arrays.is_planar:
            y[place + 2], ydot[place + 2] = np.arctan2(pose.A[k, 1, 0], pose.A[k, 0, 0]), omega[0]
        else:
            y[place + 3 : place + 7] = parameters[k]
            ydot[place + 3 : place + 7] = _parameter_rates(parameters[k], omega)
    first = stride * len(pose.r)
    y[first : layout.positions.stop] = pose.alpha
    ydot[first : layout.positions.stop] = velocity[arrays.displacements * len(pose.r) :]
    y[layout.velocities.start : layout.velocities.stop] = velocity
    ydot[layout.velocities.start : layout.velocities.stop] = acceleration
    y[layout.multipliers.start : layout.multipliers.stop] = motion.multipliers
    return y, ydot


def _parameter_rates(p: Array, omega: Array) -> Array:
    w, x, y, z = p
    G = np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
    return 0.5 * G.T @ omega


def run(prepared: Prepared, settings: Settings, progress: Progress = lambda _: None) -> Run:
    """Integrate.

    Args:
        prepared: the scene.
        settings: duration, outputs and tolerance.
        progress: told the time reached.
    """
    layout = prepared.layout
    tolerances = Tolerances(settings.tolerance, _absolute(layout, settings.tolerance))
    times = np.linspace(0.0, settings.duration, settings.outputs + 1)
    states, rates, reached = [prepared.y], [prepared.ydot], [0.0]
    failure = ""
    start = time.perf_counter()
    with Ida(prepared.equations, 0.0, prepared.y, prepared.ydot, layout.is_differential, tolerances) as ida:
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


MULTIPLIERS_FREE = 1e10
"""Absolute tolerance of the multipliers: they are not in the error test."""


def _absolute(layout: Layout, tolerance: float) -> Array:
    return np.array([tolerance if is_tested else MULTIPLIERS_FREE for is_tested in layout.is_differential])
