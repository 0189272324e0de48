"""Between the state of an integrator and the motion of the bodies, in the axes of the scene's file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from codegen.dynamics.layout import Layout
from codegen.measure.constraints import Array, Pose
from codegen.mechanics.system import System
from codegen.spec.plane import InPlane
from codegen.spec.scene import Scene


@dataclass(frozen=True, slots=True, eq=False)
class Frames:
    """How the axes of the file come from those of the equations.

    Attributes:
        world: [3, 3] world of the equations -> world of the file.
        bodies: [nb, 3, 3] axes of each body in the file -> in the equations.
        heights: [nb] m, along the normal of the plane; 0 in space.
    """

    world: Array
    bodies: Array
    heights: Array


def frames_of(scene: Scene, plane: InPlane | None) -> Frames:
    """Give the axes of a scene, or of one that was laid into its plane."""
    count = len(scene.bodies)
    if plane is None:
        return Frames(np.eye(3), np.tile(np.eye(3), (count, 1, 1)), np.zeros(count))
    turns = [np.array(plane.bodies[body.name], dtype=np.float64) for body in scene.bodies]
    heights = [float(plane.heights[body.name]) for body in scene.bodies]
    return Frames(np.array(plane.world, dtype=np.float64).T, np.array(turns), np.array(heights))


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """Motion of the bodies as the equations have it, at [n] times; in space also for motion in the plane.

    Attributes:
        r: [n, nb, 3] m.
        A: [n, nb, 3, 3].
        v: [n, nb, 3] m/s, world.
        omega: [n, nb, 3] rad/s, body axes.
        a: [n, nb, 3] m/s^2, world.
        omegadot: [n, nb, 3] rad/s^2.
        alpha: [n, na].
        alphadot: [n, na].
        multipliers: [n, m].
    """

    r: Array
    A: Array
    v: Array
    omega: Array
    a: Array
    omegadot: Array
    alpha: Array
    alphadot: Array
    multipliers: Array


def bodies_of(system: System, layout: Layout, y: Array, ydot: Array) -> Bodies:
    """Read the motion of the bodies off states.

    Rates of joint coordinates that a state leaves out are those of its polynomial, multipliers of its rows 0.

    Args:
        system: the scene.
        layout: of the state.
        y: [n, size].
        ydot: [n, size] its rate.
    """
    count, is_planar = len(system.assembly.scene.bodies), system.assembly.arrays.is_planar
    stride, times = (3 if is_planar else 7), len(y)
    positions = y[:, : stride * count].reshape(times, count, stride)
    first, size = layout.velocities.start, system.assembly.arrays.displacements
    rates = [part[:, first : first + size * count].reshape(times, count, size) for part in (y, ydot)]
    lifted = [_lifted(part, is_planar) for part in rates]
    r = np.zeros((times, count, 3))
    r[..., : 2 if is_planar else 3] = positions[..., : 2 if is_planar else 3]
    A = _plane_attitudes(positions[..., 2]) if is_planar else attitudes(positions[..., 3:])
    return Bodies(
        r,
        A,
        lifted[0][..., :3],
        lifted[0][..., 3:],
        lifted[1][..., :3],
        lifted[1][..., 3:],
        y[:, layout.coordinates],
        _coordinate_rates(layout, y, ydot),
        _multipliers(layout, y),
    )


def _coordinate_rates(layout: Layout, y: Array, ydot: Array) -> Array:
    found = ydot[:, layout.coordinates]
    kept = [k for k in range(len(layout.coordinates)) if k not in layout.condensed.coordinates]
    found[:, kept] = y[:, layout.velocities[len(layout.velocities) - len(kept) :]]
    return found


def _multipliers(layout: Layout, y: Array) -> Array:
    found = np.zeros((len(y), len(layout.multipliers) + len(layout.condensed.rows)))
    found[:, [k for k in range(len(found[0])) if k not in layout.condensed.rows]] = y[:, layout.multipliers]
    return found


def _lifted(rates: Array, is_planar: bool) -> Array:
    """Three components of velocity and of angular velocity."""
    if not is_planar:
        return rates
    found = np.zeros((*rates.shape[:2], 6))
    found[..., :2], found[..., 5] = rates[..., :2], rates[..., 2]
    return found


def attitudes(p: Array) -> Array:
    """Rotation matrices [..., 3, 3] of Euler parameters [..., 4] of any norm."""
    w, x, y, z = np.moveaxis(p / np.linalg.norm(p, axis=-1, keepdims=True), -1, 0)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    found: Array = np.moveaxis(np.array(rows), (0, 1), (-2, -1))
    return found


def _plane_attitudes(angle: Array) -> Array:
    c, s, o, e = np.cos(angle), np.sin(angle), np.zeros_like(angle), np.ones_like(angle)
    found: Array = np.moveaxis(np.array([[c, -s, o], [s, c, o], [o, o, e]]), (0, 1), (-2, -1))
    return found


def euler_parameters(A: Array) -> Array:
    """Euler parameters [..., 4] of rotation matrices [..., 3, 3]; neighbours along the first axis keep their sign."""
    from scipy.spatial.transform import Rotation

    flat: Array = Rotation.from_matrix(A.reshape(-1, 3, 3)).as_quat()[:, [3, 0, 1, 2]].reshape(*A.shape[:-2], 4)
    turns = np.sum(flat[1:] * flat[:-1], axis=-1, keepdims=True) < 0
    signs = np.concatenate([np.ones((1, *turns.shape[1:])), np.cumprod(np.where(turns, -1.0, 1.0), axis=0)])
    found: Array = flat * signs
    return found


def rate_matrix(p: Array) -> Array:
    """``G(p)`` [3, 4]: ``omega = 2 G pdot`` in body axes, ``pdot = G^T omega / 2``."""
    w, x, y, z = p
    return np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])


def program_arrays(system: System, pose: Pose, t: float = 0.0) -> Mapping[str, Sequence[float]]:
    """Arguments of the programs of a system in a pose at a time, s."""
    size = system.assembly.arrays.position
    turns = next(a.length for a in system.arguments() if a.name == "revolutions")
    return {
        "r": pose.r[:, :size].ravel().tolist(),
        "A": [x for A in pose.A for x in A[:size, :size].ravel(order="F").tolist()],
        "alpha": pose.alpha.tolist(),
        "revolutions": [0.0] * turns,
        "t": [t],
    }
