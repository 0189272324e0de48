"""The pictures of a chain's run: its plot and, on request, the page that plays it.

The chain is shown as a scene: links are bodies with their frames, inner joints are joints, cuts are rigid joints.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

from codegen.chains.mechanism import Mechanism
from codegen.chains.record import Record, quaternions
from codegen.report.animation import page
from codegen.report.motion_plot import plot
from codegen.simulate.trajectory import Trajectory
from codegen.spec.chain import BASE
from codegen.spec.placement import IDENTITY
from codegen.spec.scene import GROUND, ZERO_VECTOR, Body, Coordinate, Drive, Joint, Marker, Matrix, Scene, Vector

Array = NDArray[np.float64]

_STILL = 1e-9
"""rad or m."""

_TYPES = {"revolute": "revolute", "prismatic": "translational", "screw": "screw"}


def chain_pictures(mechanism: Mechanism, record: Record, animation: bool) -> dict[str, bytes]:
    """Draw a run.

    Args:
        mechanism: the chain.
        record: its run.
        animation: whether the page is wanted too.

    Returns:
        Path below the folder of the run -> content.
    """
    scene = as_scene(mechanism, record)
    coordinates = as_trajectory(mechanism, record, has_bodies=False)
    pictures = {"plot.svg": plot(coordinates, scene.name, scene)}
    if animation:
        pictures["animation.html"] = page(scene, as_trajectory(mechanism, record, has_bodies=True))
    return {path: text.encode() for path, text in pictures.items()}


def as_scene(mechanism: Mechanism, record: Record) -> Scene:
    """Give the chain at the start of a run as a scene."""
    chain = mechanism.chain
    frames = {BASE: np.eye(3, 4)} | {link.name: record.frames[0, k] for k, link in enumerate(chain.links)}
    bodies = []
    for link, q in zip(chain.links, quaternions(record.frames[0, : len(chain.links), :, :3]), strict=True):
        place = _vector(frames[link.name][:, 3])
        bodies.append(Body(_name(link.name), link.mass, link.inertia, place, tuple(map(Fraction, q))))  # type: ignore[arg-type]
    joints = [*_joints(mechanism, record, frames), *_welds(mechanism, record, frames)]
    return Scene(chain.name, chain.gravity, tuple(bodies), tuple(joints))


def _joints(mechanism: Mechanism, record: Record, frames: dict[str, Array]) -> Iterator[Joint]:
    for k, link in enumerate(mechanism.chain.links):
        own = frames[link.name].copy()
        if link.type == "prismatic":
            own[:, 3] -= record.q[0, k] * own[:, 2]
        is_loaded = record.tau is not None and bool(np.any(record.tau[:, k]))
        coordinate = Coordinate(drive=Drive(Fraction(0), Fraction(0)) if is_loaded else None)
        bodies, type_ = (_name(link.parent), _name(link.name)), _TYPES[link.type]
        markers = _marker(frames[link.parent], own), Marker(ZERO_VECTOR, IDENTITY)
        yield Joint(link.name, type_, bodies, *markers, pitch=link.pitch, coordinates=(coordinate,))


def _welds(mechanism: Mechanism, record: Record, frames: dict[str, Array]) -> Iterator[Joint]:
    """The cuts: far frames at the start, on both sides."""
    chain = mechanism.chain
    first, count = len(chain.links), len(chain.cuts)
    for k, cut in enumerate(chain.cuts):
        sides = (cut.base, cut.far)
        poses = record.frames[0, first + k], record.frames[0, first + count + k]
        near, far = (_marker(frames[side.link], pose) for side, pose in zip(sides, poses, strict=True))
        yield Joint(f"cut {cut.name}", "rigid", (_name(cut.base.link), _name(cut.far.link)), near, far)


def _marker(body: Array, frame: Array) -> Marker:
    """A frame as a body sees it."""
    back = body[:, :3].T
    return Marker(_vector(back @ (frame[:, 3] - body[:, 3])), _matrix(back @ frame[:, :3]))


def _name(link: str) -> str:
    """The base is the ground; a link of that name is called otherwise."""
    return GROUND if link == BASE else f"link {link}" if link == GROUND else link


def _vector(values: Array) -> Vector:
    return tuple(Fraction(float(x)) for x in values)  # type: ignore[return-value]


def _matrix(values: Array) -> Matrix:
    return tuple(_vector(row) for row in values)  # type: ignore[return-value]


def as_trajectory(mechanism: Mechanism, record: Record, has_bodies: bool) -> Trajectory:
    """Give a run as a trajectory of the scene; independent coordinates come first, since plots end somewhere.

    Args:
        mechanism: the chain.
        record: its run.
        has_bodies: whether the poses of the links are in it; their velocities and accelerations are not.
    """
    links = mechanism.chain.links if has_bodies else ()
    count = len(record.t)
    r = record.frames[:, : len(links), :, 3]
    q = np.zeros((count, len(links), 4))
    for k in range(len(links)):
        q[:, k] = quaternions(record.frames[:, k, :, :3])
    none = np.zeros((count, len(links), 3))
    names = [link.name for link in mechanism.chain.links]
    order = [*mechanism.part.v.tolist(), *mechanism.part.w.tolist()]
    tau = record.tau if record.tau is not None else np.zeros_like(record.q)
    return Trajectory(
        tuple(_name(link.name) for link in links),
        record.t,
        *(r, q, none, none, none, none),
        alpha={names[k]: _settled(record.q[:, k])[:, None] for k in order},
        alphadot={names[k]: record.qd[:, k, None] for k in order},
        effort={names[k]: tau[:, k, None] for k in order if np.any(tau[:, k])},
        reaction={},
    )


def _settled(values: Array) -> Array:
    """A coordinate that moves by rounding only does not move."""
    return np.full_like(values, values[0]) if np.ptp(values) < _STILL else values
