"""Forces are those of the scene, and their derivatives are derivatives."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest

from codegen.ir.evaluate import evaluate
from codegen.ir.ops import Op
from codegen.mechanics.mass import mass
from codegen.spec.scene import Scene

from . import independent, mechanisms
from .poses import STEP, Machine, Pose, dense, size, split, start

CASES = {
    "loaded in space": (mechanisms.loaded(), "exact"),
    "loaded in the plane": (mechanisms.loaded("planar"), "exact"),
    "loaded, translations in body axes": (mechanisms.loaded(), "substituted"),
    "loaded in the plane, translations in body axes": (mechanisms.loaded("planar"), "substituted"),
    "damped pendulum": (mechanisms.pendulum("0.7"), "exact"),
    "springs without dampers": (mechanisms.pendulum(), "exact"),
}


@pytest.fixture(scope="module", params=CASES)
def machine(request: pytest.FixtureRequest) -> Machine:
    scene, derivative = CASES[request.param]
    return Machine(mechanisms.system(scene, "parametric", derivative))


def anywhere(machine: Machine, seed: int) -> tuple[Pose, np.ndarray]:
    """A pose and velocities that need not fit the joints."""
    rng = np.random.default_rng(seed)
    n = size(machine.system)
    return start(machine.system).moved(machine.system, 0.4 * rng.standard_normal(n)), rng.standard_normal(n)


@pytest.mark.parametrize("seed", range(4))
def test_forces_are_those_of_the_scene(machine: Machine, seed: int) -> None:
    pose, v = anywhere(machine, seed)
    found = machine.at(("force",), pose, v)["force"][:, 0]
    np.testing.assert_allclose(found, independent.force(machine.system, pose, v), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("seed", range(2))
def test_force_q_and_force_v_are_the_derivatives_of_the_forces(machine: Machine, seed: int) -> None:
    pose, v = anywhere(machine, seed)
    n = size(machine.system)
    found = machine.at(("force_q", "force_v"), pose, v)
    steps = 1j * STEP * np.eye(n)
    by_place = [independent.force(machine.system, pose.moved(machine.system, step), v) for step in steps]
    by_rate = [independent.force(machine.system, pose, v + step) for step in steps]
    for name, columns in (("force_q", by_place), ("force_v", by_rate)):
        expected = np.imag(np.array(columns)).T / STEP
        np.testing.assert_allclose(found[name], expected, rtol=1e-11, atol=1e-11, err_msg=name)


def test_a_soft_stop_gives_a_linear_spring_beyond_and_nothing_before() -> None:
    machine = Machine(mechanisms.system(mechanisms.loaded()))
    limit = mechanisms.loaded().joints[0].coordinates[0].limit
    assert limit is not None
    assert limit.upper is not None

    def pushed(alpha: float, rate: float) -> float:
        pose = start(machine.system)
        pose = replace(pose, alpha=np.array([alpha, 0.0]))
        v = np.zeros(size(machine.system))
        v[-2] = rate
        spring_and_damper = 2 - 3 * (alpha - 0.1) - 0.4 * rate
        return float(machine.at(("force",), pose, v)["force"][-2, 0]) - spring_and_damper

    assert abs(pushed(0.0, 5.0)) < 1e-5
    assert pushed(0.8, 0.0) == pytest.approx(-100 * 0.5, rel=1e-6)
    assert pushed(0.8, 3.0) == pytest.approx(-100 * 0.5 - 2 * 3, rel=1e-6)
    assert pushed(-1.0, 0.0) == pytest.approx(100 * 0.5, rel=1e-6)


@pytest.mark.parametrize("motion", ["spatial", "planar"])
def test_the_mass_matrix_gives_the_kinetic_energy(motion: str) -> None:
    scene: Scene = mechanisms.loaded(motion)
    machine = Machine(mechanisms.system(scene))
    program = mass(scene, machine.system.assembly.arrays, size(machine.system))
    M = dense(program, "mass", evaluate(program, {})["mass"])
    _, v = anywhere(machine, 0)
    motions, _ = split(machine.system, v)
    energy = sum(
        float(body.mass) * u @ u + w @ independent.numbers(body.inertia) @ w
        for body, (u, w) in zip(scene.bodies, motions, strict=True)
    )
    assert v @ M @ v == pytest.approx(energy, rel=1e-14)


def test_a_spring_without_a_free_length_takes_no_square_root() -> None:
    scene = mechanisms.pendulum("0.7")
    linear = replace(scene, springs=tuple(replace(spring, length=F(0)) for spring in scene.springs))
    machine = Machine(mechanisms.system(linear, "conventional"))
    for name in ("force", "force_q", "force_v"):
        assert not [i for i in machine.program(name).instructions if i.op is Op.SQRT]
