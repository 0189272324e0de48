"""The run of a scene by relative coordinates, told as the run of any scene: bodies, joints and reactions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from codegen.chains.record import Record, quaternions
from codegen.chains.relative.convert import Carried, Relative
from codegen.chains.relative.pose import Pose
from codegen.chains.twists import Twist, twists
from codegen.simulate.trajectory import Trajectory
from codegen.spec.chain import BASE
from codegen.spec.scene import GROUND, Joint, Scene

Array = NDArray[np.float64]


def scene_motion(scene: Scene, relative: Relative, record: Record) -> Trajectory:
    """Read the motion of bodies and joints off the run of a chain.

    Args:
        scene: the mechanism.
        relative: as a chain.
        record: the run of the chain, with its loads.
    """
    chain, t = relative.chain, record.t
    moving = twists(chain, record.frames, record.qd, record.qdd)
    parts = [_body(relative, record, moving, body.name) for body in scene.bodies]
    r, A, v, w, a, al = (np.stack(part, axis=1) for part in zip(*parts, strict=True))
    q = np.stack([quaternions(A[:, k]) for k in range(A.shape[1])], axis=1)
    coordinates = {name: carried.coordinates for name, carried in relative.joints.items() if carried.coordinates}
    places = {name: [chain.index(link) for link, _ in found] for name, found in coordinates.items()}
    offsets = {name: np.array([float(offset) for _, offset in found]) for name, found in coordinates.items()}
    return Trajectory(
        tuple(body.name for body in scene.bodies),
        t,
        *(r, q, v, w, a, al),
        alpha={name: record.q[:, links] - offsets[name] for name, links in places.items()},
        alphadot={name: record.qd[:, links] for name, links in places.items()},
        effort=dict(_efforts(scene, relative, record)),
        reaction=dict(_reactions(scene, relative, record)),
    )


def _body(relative: Relative, record: Record, moving: Mapping[str, Twist], name: str) -> tuple[Array, ...]:
    """Position, attitude, velocities and accelerations of a body at its centre of mass, angular ones in its axes."""
    link, pose = relative.bodies[name]
    frame = _frame(relative, record, link)
    arm, A = (frame[:, :, :3] @ np.array(part, dtype=np.float64) for part in (pose.p, pose.R))
    own = moving[link].at(arm)
    w, al = (np.einsum("kji,kj->ki", A, vector) for vector in (own.w, own.al))
    return frame[:, :, 3] + arm, A, own.v, w, own.a, al


def _frame(relative: Relative, record: Record, link: str) -> Array:
    """[k, 3, 4] pose of a link."""
    if link == BASE:
        return np.broadcast_to(np.eye(3, 4), (len(record.t), 3, 4))
    found: Array = record.frames[:, relative.chain.index(link)]
    return found


def _efforts(scene: Scene, relative: Relative, record: Record) -> Iterator[tuple[str, Array]]:
    """What drives bring, beside the other forces on their coordinates."""
    independent = {one.joint: k for k, one in enumerate(relative.chain.independents)}
    for joint in scene.joints:
        links = [link for link, _ in relative.joints[joint.name].coordinates]
        driven = [
            independent[link] for link, one in zip(links, joint.coordinates, strict=False) if one.drive is not None
        ]
        if driven and record.effort is not None:
            yield joint.name, record.effort[:, driven]


def _reactions(scene: Scene, relative: Relative, record: Record) -> Iterator[tuple[str, Array]]:
    """Force and moment on the second body, at the joint's point on it; none of joints whose bodies became one link."""
    for joint in scene.joints:
        carried = relative.joints[joint.name]
        if carried.end or carried.cut is not None:
            yield joint.name, _reaction(relative, record, joint, carried)


def _reaction(relative: Relative, record: Record, joint: Joint, carried: Carried) -> Array:
    chain = relative.chain
    if carried.cut is None:
        k = chain.index(carried.end)
        frame, wrench = record.frames[:, k], None if record.wrenches is None else record.wrenches[:, k]
    else:
        k = carried.cut
        frame = record.frames[:, len(chain.links) + len(chain.cuts) + k]
        wrench = None if record.reaction is None else record.reaction[:, 6 * k : 6 * k + 6]
    if wrench is None:
        return np.zeros((len(record.t), 6))
    force, moment = (np.einsum("kij,kj->ki", frame[:, :, :3], part) for part in (wrench[:, :3], wrench[:, 3:]))
    point = _point(relative, record, joint)
    moment = moment + np.cross(frame[:, :, 3] - point, force)
    found = np.concatenate([force, moment], axis=1)
    return found if carried.on_second else -found


def _point(relative: Relative, record: Record, joint: Joint) -> Array:
    """[k, 3] m, the joint's point on its second body."""
    body = joint.bodies[1]
    link, pose = (BASE, Pose()) if body == GROUND else relative.bodies[body]
    marker = pose @ Pose(joint.marker_j.axes, joint.marker_j.point)
    frame = _frame(relative, record, link)
    found: Array = frame[:, :, 3] + frame[:, :, :3] @ np.array(marker.p, dtype=np.float64)
    return found
