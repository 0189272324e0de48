"""The arguments of a scene's routines at t = 0, for its example."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import numpy as np

from codegen.dynamics.layout import Layout
from codegen.ir.ops import Constant
from codegen.measure.constraints import Array, Pose
from codegen.mechanics.system import System
from codegen.scenes.state import euler_parameters, program_arrays


def start(system: System, pose: Pose, layout: Layout) -> dict[str, Sequence[Constant]]:
    """Give every argument at t = 0.

    Velocities are those of the scene's file; rates of joint coordinates, and of the state, are 0. Multipliers are 1, so
    that what they multiply shows.

    Args:
        system: the scene.
        pose: at t = 0, all joints closed.
        layout: of the state of an integrator.

    Returns:
        Argument -> its entries, as many digits as a double has.
    """
    world = _velocity(system, pose, "world")
    numbers: Mapping[str, Sequence[float]] = {
        **program_arrays(system, pose),
        "velocity": _velocity(system, pose, system.assembly.translations).tolist(),
        "lambda": [1.0] * system.row_count,
        "y": _state(system, pose, layout, world).tolist(),
        "ydot": [0.0] * layout.size,
        "cj": [1.0],
    }
    return {name: [Constant(Fraction(x)) for x in values] for name, values in numbers.items()}


def _velocity(system: System, pose: Pose, translations: str) -> Array:
    """Velocity of each body, in the axes that are asked for, and its angular velocity; 0 for joint coordinates."""
    arrays = system.assembly.arrays
    found = np.zeros(len(system.assembly.columns))
    for k, body in enumerate(system.assembly.scene.bodies):
        v = np.array([float(x) for x in body.velocity])
        v = pose.A[k].T @ v if translations == "body" else v
        omega = [float(x) for x in body.angular_velocity]
        parts = [*v[: arrays.position], *(omega[2:] if arrays.is_planar else omega)]
        found[arrays.displacements * k : arrays.displacements * (k + 1)] = parts
    return found


def _state(system: System, pose: Pose, layout: Layout, velocity: Array) -> Array:
    size = system.assembly.arrays.position
    is_planar = system.assembly.arrays.is_planar
    turned = np.arctan2(pose.A[:, 1, 0], pose.A[:, 0, 0])[:, None] if is_planar else euler_parameters(pose.A[None])[0]
    positions = np.hstack([pose.r[:, :size], turned]).ravel()
    return np.concatenate(
        [positions, pose.alpha, velocity, np.ones(len(layout.multipliers)), np.zeros(len(layout.corrections))]
    )
