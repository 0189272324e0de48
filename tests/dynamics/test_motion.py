"""Motion that follows from the quantities of a scene: energy, reactions, and the forms of joints against each other."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F
from functools import cache

import numpy as np
import pytest

from codegen.spec.scene import Coordinate, Drive, Scene

from . import independent, mechanisms
from .poses import STEP, Array, Machine, Pose, flattened, size, start

SCENES = {
    "slider-crank": mechanisms.slider_crank,
    "four-bar": mechanisms.four_bar,
    "pendulum": mechanisms.pendulum,
}


@cache
def machine(name: str, form: str, motion: str = "spatial", derivative: str = "exact") -> Machine:
    return Machine(mechanisms.system(replace(SCENES[name](), motion=motion), form, derivative))


def of_bodies(found: Machine, values: Array) -> Array:
    """Without what belongs to joint coordinates."""
    return values[: size(found.system) - found.system.assembly.coordinates]


def in_world(pose: Pose, a: Array) -> Array:
    """Accelerations with translations in body axes, in world axes."""
    turned = [np.concatenate([R @ own[:3], own[3:]]) for R, own in zip(pose.A, a.reshape(-1, 6), strict=True)]
    return np.concatenate(turned)


@pytest.mark.parametrize("form", ["conventional", "parametric"])
@pytest.mark.parametrize("name", SCENES)
def test_energy_is_kept_without_dampers(name: str, form: str) -> None:
    found = machine(name, form)
    scene = found.system.assembly.scene
    for seed in range(3):
        pose, v = found.consistent(seed)
        a, _ = found.accelerations(pose, v)
        masses = [x for body in scene.bodies for x in [float(body.mass)] * 3]
        moves, turns = of_bodies(found, v).reshape(-1, 2, 3)[:, 0], of_bodies(found, v).reshape(-1, 2, 3)[:, 1]
        pairs = of_bodies(found, a).reshape(-1, 2, 3)
        kinetic = (moves.ravel() * masses) @ pairs[:, 0].ravel() + sum(
            w @ independent.numbers(body.inertia) @ wdot
            for body, w, wdot in zip(scene.bodies, turns, pairs[:, 1], strict=True)
        )
        later = pose.moved(found.system, 1j * STEP * v)
        stored = np.imag(independent.potential(scene, later)) / STEP
        assert kinetic + stored == pytest.approx(0, abs=1e-10 * (abs(stored) + abs(v @ v)))


@pytest.mark.parametrize("name", SCENES)
def test_conventional_and_parametric_form_give_the_same_motion(name: str) -> None:
    conventional, parametric = machine(name, "conventional"), machine(name, "parametric")
    for seed in range(3):
        pose, v = parametric.consistent(seed)
        a, _ = parametric.accelerations(pose, v)
        other, _ = conventional.accelerations(pose, of_bodies(parametric, v))
        np.testing.assert_allclose(of_bodies(parametric, a), other, rtol=0, atol=1e-10 * (1 + np.abs(other).max()))


@pytest.mark.parametrize("name", SCENES)
def test_translations_in_body_axes_give_the_same_motion(name: str) -> None:
    world, body = machine(name, "parametric"), machine(name, "parametric", "spatial", "substituted")
    pose, v = world.consistent(1)
    a, _ = world.accelerations(pose, v)
    seen = v.copy()
    for k, R in enumerate(pose.A):
        seen[6 * k : 6 * k + 3] = R.T @ v[6 * k : 6 * k + 3]
    other, _ = body.accelerations(pose, seen)
    expected = of_bodies(world, a)
    np.testing.assert_allclose(
        in_world(pose, of_bodies(body, other)), expected, rtol=0, atol=1e-10 * (1 + np.abs(expected).max())
    )


@pytest.mark.parametrize("form", ["conventional", "parametric"])
@pytest.mark.parametrize("name", ["slider-crank", "four-bar"])
def test_motion_in_the_plane_is_that_in_space(name: str, form: str) -> None:
    spatial, planar = machine(name, form), machine(name, form, "planar")
    for seed in range(3):
        pose, v = planar.consistent(seed)
        pose = flattened(pose)
        a, _ = planar.accelerations(pose, v)
        count = len(pose.r)
        wide = np.zeros(size(spatial.system))
        wide[6 * count :] = v[3 * count :]
        for k in range(count):
            wide[[6 * k, 6 * k + 1, 6 * k + 5]] = v[3 * k : 3 * k + 3]
        found, _ = spatial.accelerations(pose, wide)
        flat = np.concatenate([found[[6 * k, 6 * k + 1, 6 * k + 5]] for k in range(count)])
        np.testing.assert_allclose(flat, a[: 3 * count], rtol=0, atol=1e-10 * (1 + np.abs(a).max()))


# --- signs and axes of reactions


def hanging(type_: str) -> Scene:
    """A body that hangs at rest from the ground, body i of its joint."""
    weight = mechanisms.body("weight", mechanisms.vector(0, "-0.5", 0), "2")
    hook = mechanisms.joint("hook", type_, (None, weight), mechanisms.vector(0, 0, 0))
    return Scene("weight", mechanisms.GRAVITY, (weight,), (hook,))


@pytest.mark.parametrize("form", ["conventional", "parametric"])
def test_lambda_of_a_ball_is_the_force_of_body_j_on_body_i(form: str) -> None:
    found = Machine(mechanisms.system(hanging("ball"), form))
    a, multipliers = found.accelerations(start(found.system), np.zeros(size(found.system)))
    np.testing.assert_allclose(a, 0, atol=1e-13)
    np.testing.assert_allclose(multipliers[:3], [0, -2 * 9.81, 0], atol=1e-12)


def test_in_the_parametric_form_lambda_of_the_translations_is_in_axes_of_body_i() -> None:
    scene = hanging("ball")
    hook = scene.joints[0]
    swapped = replace(hook, bodies=(hook.bodies[1], hook.bodies[0]), marker_i=hook.marker_j, marker_j=hook.marker_i)
    found = Machine(mechanisms.system(replace(scene, joints=(swapped,))))
    quarter = np.zeros(size(found.system))
    quarter[:3], quarter[5] = [-0.5, 0.5, 0], np.pi / 2
    pose = found.assembled(start(found.system).moved(found.system, quarter))
    a, multipliers = found.accelerations(pose, np.zeros(size(found.system)))
    force_of_ground_on_weight = 2 * (a[:3] - independent.numbers(mechanisms.GRAVITY))
    np.testing.assert_allclose(multipliers[:3], pose.A[0].T @ force_of_ground_on_weight, atol=1e-12)
    assert np.linalg.norm(force_of_ground_on_weight) > 1


def test_the_effort_of_a_drive_is_minus_its_multiplier() -> None:
    arm = mechanisms.body("arm", mechanisms.vector("0.5", 0, 0), "2")
    load = Coordinate(drive=Drive(F(0), F(0)))
    pivot = mechanisms.joint("pivot", "revolute", (None, arm), mechanisms.vector(0, 0, 0), mechanisms.Z, load)
    found = Machine(mechanisms.system(Scene("arm", mechanisms.GRAVITY, (arm,), (pivot,))))
    a, multipliers = found.accelerations(start(found.system), np.zeros(size(found.system)))
    np.testing.assert_allclose(a, 0, atol=1e-13)
    assert -multipliers[-1] == pytest.approx(2 * 9.81 * 0.5)


def test_a_drive_prescribes_its_coordinate() -> None:
    found = Machine(mechanisms.system(mechanisms.loaded()))
    pose = replace(start(found.system), alpha=np.array([0.0, 0.5]))
    v = np.zeros(size(found.system))
    v[-1] = 0.7
    values = found.at(("phi", "phi_q_v", "gamma"), pose, v, t=0.2)
    angle = 3 * 0.2 + 0.7
    assert values["phi"][-1, 0] == pytest.approx(0.5 - 0.02 - 0.3 * 0.2 - 0.05 * np.sin(angle))
    drift = values["phi_q_v"][-1, 0] + found.system.phi_t(0.2)[-1]
    assert drift == pytest.approx(0.7 - 0.3 - 0.05 * 3 * np.cos(angle))
    assert values["gamma"][-1, 0] == pytest.approx(-0.05 * 9 * np.sin(angle))
