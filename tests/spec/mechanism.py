"""Kinematics and mass matrix of a scene whose joints form a tree, in doubles, by the textbook."""

from __future__ import annotations

import numpy as np

from codegen.spec.scene import Body, Joint, Marker, Scene

Pose = tuple[np.ndarray, np.ndarray]

AXES = {
    "revolute": ["turn h"],
    "translational": ["move h"],
    "cylindrical": ["move h", "turn h"],
    "universal": ["turn h", "turn f"],
    "planar": ["move f", "move g", "turn h"],
    "ball": ["turn h", "turn g", "turn f"],
    "rigid": [],
}
"""Successive motions of body j on body i, each about or along an axis that the motions before it have carried along."""

COLUMN = {"f": 0, "g": 1, "h": 2}


def floats(values) -> np.ndarray:
    return np.array([[float(x) for x in row] if isinstance(row, tuple) else float(row) for row in values])


def attitude(body: Body) -> np.ndarray:
    w, x, y, z = map(float, body.quaternion)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def at_rest(scene: Scene) -> dict[str, Pose]:
    poses = {body.name: (floats(body.position), attitude(body)) for body in scene.bodies}
    return poses | {"ground": (np.zeros(3), np.eye(3))}


def frame_in_world(marker: Marker, pose: Pose) -> Pose:
    r, A = pose
    return r + A @ floats(marker.point), A @ floats(marker.axes)


def about(axis: np.ndarray, angle: float) -> np.ndarray:
    x, y, z = axis
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def moved(joint: Joint, pose_i: Pose, values) -> tuple[Pose, list[tuple[str, np.ndarray, np.ndarray]]]:
    """Pose of body j, and of each motion its kind, a point on its axis and its direction, world."""
    p, C = frame_in_world(joint.marker_i, pose_i)
    motions = []
    for (kind, axis), value in zip((word.split() for word in AXES[joint.type]), values, strict=True):
        direction = C[:, COLUMN[axis]].copy()
        motions.append((kind, p.copy(), direction))
        if kind == "turn":
            C = about(direction, value) @ C
        else:
            p = p + value * direction
    A = C @ floats(joint.marker_j.axes).T
    return (p - A @ floats(joint.marker_j.point), A), motions


class Tree:
    """Poses and motions of a scene for given values of its coordinates, by the names of the joints."""

    def __init__(self, scene: Scene, values: dict[str, list[float]] | None = None) -> None:
        values = values or {}
        self.scene = scene
        self.motions: dict[str, list] = {}
        self.above: dict[str, Joint] = {}
        hung = {joint.bodies[1] for joint in scene.joints}
        self.poses = {name: pose for name, pose in at_rest(scene).items() if name not in hung}
        waiting = list(scene.joints)
        while waiting:
            joint = next(joint for joint in waiting if joint.bodies[0] in self.poses)
            waiting.remove(joint)
            zero = [0.0] * len(AXES[joint.type])
            i, j = joint.bodies
            self.poses[j], self.motions[joint.name] = moved(joint, self.poses[i], values.get(joint.name, zero))
            self.above[j] = joint

    def mass_matrix(self) -> np.ndarray:
        order = [(joint.name, k) for joint in self.scene.joints for k in range(len(AXES[joint.type]))]
        M = np.zeros((len(order), len(order)))
        for body in self.scene.bodies:
            r, A = self.poses[body.name]
            V, W = np.zeros((3, len(order))), np.zeros((3, len(order)))
            name = body.name
            while name in self.above:
                joint = self.above[name]
                for k, (kind, point, direction) in enumerate(self.motions[joint.name]):
                    column = order.index((joint.name, k))
                    V[:, column] = direction if kind == "move" else np.cross(direction, r - point)
                    W[:, column] = direction if kind == "turn" else 0.0
                name = joint.bodies[0]
            M += float(body.mass) * V.T @ V + W.T @ A @ floats(body.inertia) @ A.T @ W
        return M
