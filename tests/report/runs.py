"""Runs whose motion is known in closed form: an engine in the plane, and bodies that tumble with all joint types."""

from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from codegen.simulate.trajectory import Trajectory
from codegen.spec.scene import (
    COORDINATE_UNITS,
    SCENE_JOINTS,
    Body,
    Coordinate,
    Drive,
    Joint,
    Marker,
    Scene,
    Spring,
)
from codegen.spec.scene_file import read_scene

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


def example(name: str) -> Scene:
    return read_scene((EXAMPLES / f"{name}.toml").read_text(), name)


def rotation(q: np.ndarray) -> Rotation:
    """Of quaternions w x y z."""
    return Rotation.from_quat(q[..., [1, 2, 3, 0]])


def engine(count: int = 60) -> tuple[Scene, Trajectory]:
    """Crank 0.1 m at 15 rad/s, rod 0.3 m; the drive is at the main bearing."""
    scene = example("in_line_engine")
    driven = replace(scene.joints[0], coordinates=(Coordinate(drive=Drive(Fraction(0), Fraction(15))),))
    scene = replace(scene, joints=(driven, *scene.joints[1:]))
    t = np.linspace(0.0, 0.5, count)
    theta = 15 * t
    psi = -np.arcsin(np.sin(theta) / 3)
    pin, rod = (size * np.stack([np.cos(x), np.sin(x), 0 * x], axis=1) for size, x in ((0.1, theta), (0.3, psi)))
    r = np.stack([pin / 2, pin + rod / 2, pin + rod], axis=1)
    angles = np.stack([theta, psi, 0 * t], axis=1)
    q = np.stack([np.cos(angles / 2), 0 * angles, 0 * angles, np.sin(angles / 2)], axis=2)
    v, a = np.gradient(r, t, axis=0), np.gradient(np.gradient(r, t, axis=0), t, axis=0)
    w = np.zeros_like(r)
    w[:, :, 2] = np.gradient(angles, t, axis=0)
    stroke = r[:, 2, :1] - 0.4
    alpha = {"main bearing": theta[:, None], "cylinder": stroke}
    rates = {name: np.gradient(values, t, axis=0) for name, values in alpha.items()}
    effort = {"main bearing": np.cos(theta)[:, None]}
    names = tuple(body.name for body in scene.bodies)
    return scene, Trajectory(names, t, r, q, v, w, a, np.gradient(w, t, axis=0), alpha, rates, effort, {})


def tumbling(count: int = 40, names: tuple[str, ...] = ("one", "two")) -> tuple[Scene, Trajectory]:
    """Bodies at random places and attitudes at each time, joined by every joint type: no mechanism, but a picture."""
    draw = np.random.default_rng(7)

    def three() -> tuple[Fraction, Fraction, Fraction]:
        x, y, z = (Fraction(float(x)) for x in draw.normal(size=3))
        return x, y, z

    def marker() -> Marker:
        rows = Rotation.from_quat(draw.normal(size=4)).as_matrix()
        return Marker(three(), tuple(tuple(Fraction(float(x)) for x in row) for row in rows))

    still = Body("", Fraction(1), ((Fraction(1),) * 3,) * 3, (Fraction(0),) * 3, (Fraction(1), *(Fraction(0),) * 3))
    ends = [("ground", names[0]), *zip(names, (*names[1:], "ground"), strict=True)]
    joints = tuple(
        Joint(f"{names[0]} {kind}", kind, ends[k % len(ends)], marker(), marker())
        for k, kind in enumerate(SCENE_JOINTS)
    )
    springs = (Spring(("ground", names[-1]), (three(), three()), Fraction(1), Fraction(0), Fraction(1)),)
    scene = Scene("tumbling", three(), tuple(replace(still, name=name) for name in names), joints, springs)
    shape = (count, len(names), 3)
    r, v, w, a, al = (draw.normal(size=shape) for _ in range(5))
    q = draw.normal(size=(count, len(names), 4))
    q /= np.linalg.norm(q, axis=2, keepdims=True)
    alpha = {joint.name: draw.normal(size=(count, len(COORDINATE_UNITS[joint.type]))) for joint in joints}
    t = np.cumsum(draw.uniform(0.01, 0.1, size=count))
    return scene, Trajectory(names, t, r, q, v, w, a, al, alpha, alpha, {}, {})
