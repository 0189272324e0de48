"""Freedom of a scene's mechanism by differences: constraints from the geometry alone, in floating point.

The coordinates are small displacements of each body: of its centre of mass and, as a rotation vector, of its attitude,
both in world axes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from codegen.spec.scene import GROUND, Joint, Marker, Scene

Array = NDArray[np.float64]


def attitude(quaternion: Array) -> Array:
    """Rotation matrix of a quaternion, from the images of the axes under q v q*."""
    w, v = quaternion[0], quaternion[1:]
    return np.array([(w * w - v @ v) * e + 2 * (v @ e) * v + 2 * w * np.cross(v, e) for e in np.eye(3)]).T


def turned(vector: Array) -> Array:
    """Rotation by a rotation vector (Rodrigues)."""
    angle = np.linalg.norm(vector)
    cross = np.cross(np.eye(3), vector).T if angle else np.zeros((3, 3))
    return np.eye(3) + np.sinc(angle / np.pi) * cross.T + 0.5 * np.sinc(angle / 2 / np.pi) ** 2 * cross @ cross


class Mechanism:
    """Poses and constraints of a scene."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.positions = {body.name: np.array(body.position, float) for body in scene.bodies}
        self.attitudes = {body.name: attitude(np.array(body.quaternion, float)) for body in scene.bodies}
        self.positions[GROUND], self.attitudes[GROUND] = np.zeros(3), np.eye(3)

    def moved(self, displacement: Array) -> Mechanism:
        """The mechanism with its bodies displaced."""
        result = Mechanism(self.scene)
        for body, shift in zip(self.scene.bodies, displacement.reshape(-1, 6), strict=True):
            result.positions[body.name] = self.positions[body.name] + shift[:3]
            result.attitudes[body.name] = turned(shift[3:]) @ self.attitudes[body.name]
        return result

    def residual(self) -> Array:
        """How far the joints are open."""
        return np.concatenate([self._of(joint) for joint in self.scene.joints])

    def jacobian(self) -> Array:
        """Central differences of the residual."""
        size, step = 6 * len(self.scene.bodies), 1e-5
        columns = [
            (self.moved(step * e).residual() - self.moved(-step * e).residual()) / (2 * step) for e in np.eye(size)
        ]
        return np.array(columns).T

    def freedom(self) -> int:
        """Degrees of freedom: coordinates less the rank of the Jacobian."""
        values = np.linalg.svd(self.jacobian(), compute_uv=False)
        rank = int(np.sum(values > 1e-7 * values[0]))
        assert not np.any((values > 1e-9 * values[0]) & (values < 1e-4 * values[0])), "no clear rank"
        return 6 * len(self.scene.bodies) - rank

    def velocity(self) -> Array:
        """Velocities at t = 0 as rates of the coordinates."""
        rates = [
            np.concatenate([np.array(b.velocity, float), self.attitudes[b.name] @ np.array(b.angular_velocity, float)])
            for b in self.scene.bodies
        ]
        return np.concatenate(rates)

    def _frame(self, body: str, marker: Marker) -> tuple[Array, Array]:
        A = self.attitudes[body]
        return self.positions[body] + A @ np.array(marker.point, float), A @ np.array(marker.axes, float)

    def _of(self, joint: Joint) -> Array:
        (p_i, C_i), (p_j, C_j) = map(self._frame, joint.bodies, (joint.marker_i, joint.marker_j))
        d, H = C_i.T @ (p_j - p_i), C_i.T @ C_j
        twist = np.array([H[2, 1] - H[1, 2], H[0, 2] - H[2, 0], H[1, 0] - H[0, 1]]) / 2
        parts = {
            "revolute": (d, H[:2, 2]),
            "translational": (d[:2], twist),
            "cylindrical": (d[:2], H[:2, 2]),
            "universal": (d, H[2:, 0]),
            "planar": (d[2:], H[:2, 2]),
            "ball": (d,),
            "rigid": (d, twist),
            "screw": (d[:2], H[:2, 2], d[2:] - float(joint.pitch) * np.arctan2(H[1, :1], H[0, :1])),
        }
        return np.concatenate(parts[joint.type])
