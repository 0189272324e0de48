"""The Jacobian is the derivative of the residual, and solutions have residual zero."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.dynamics.jacobian import SECOND
from codegen.dynamics.layout import layout
from codegen.ir.evaluate import evaluate
from codegen.mechanics.system import System
from codegen.scenes.motion import BETA, Dae, dae
from codegen.scenes.programs import estimate

from . import mechanisms
from .poses import COMPLEX, STEP, Array, Machine, Pose, dense, start

CASES = {
    "loaded in space": (mechanisms.loaded(), "parametric", "exact"),
    "loaded in the plane": (mechanisms.loaded("planar"), "parametric", "exact"),
    "conventional": (mechanisms.pendulum("0.7"), "conventional", "exact"),
    "substituted": (mechanisms.loaded(), "parametric", "substituted"),
    "substituted in the plane": (mechanisms.loaded("planar"), "parametric", "substituted"),
    "oblique": (mechanisms.oblique(), "parametric", "substituted", "world"),
}


@cache
def system(case: str) -> System:
    return mechanisms.system(*CASES[case])


@cache
def machine(case: str) -> Machine:
    return Machine(system(case))


@cache
def equations(case: str, form: str, left_out: tuple[str, ...] = ()) -> Dae:
    return dae(system(case), form, left_out, choose=estimate)


def residual(found: Dae, y: Array, ydot: Array) -> Array:
    values = evaluate(found.residual, {"t": [0.3], "y": y, "ydot": ydot}, COMPLEX)["residual"]
    return np.array(values)


def jacobian(found: Dae, y: Array, ydot: Array, cj: float) -> Array:
    values = evaluate(found.jacobian, {"t": [0.3], "y": y, "ydot": ydot, "cj": [cj]}, COMPLEX)["jacobian"]
    return dense(found.jacobian, "jacobian", values)


def anywhere(found: Dae) -> tuple[Array, Array]:
    """A state that fits nothing; mu is zero."""
    rng = np.random.default_rng(3)
    y, ydot = rng.standard_normal((2, found.layout.size))
    y[found.layout.corrections.start :] = 0
    return y, ydot


@pytest.mark.parametrize(
    ("case", "form"),
    [
        ("loaded in space", "index2"),
        ("loaded in the plane", "index2"),
        ("loaded in the plane", "index1"),
        ("conventional", "index2"),
        ("conventional", "index1"),
        ("loaded in space", "condensed"),
    ],
)
def test_the_jacobian_is_the_derivative_of_the_residual_anywhere(case: str, form: str) -> None:
    found = equations(case, form)
    y, ydot = anywhere(found)
    cj = 1.7
    steps = 1j * STEP * np.eye(found.layout.size)
    expected = np.array([np.imag(residual(found, y + step, ydot + cj * step)) for step in steps]).T / STEP
    scale = np.abs(expected).max()
    np.testing.assert_allclose(jacobian(found, y, ydot, cj), expected, rtol=0, atol=1e-13 * scale)


@pytest.mark.parametrize(
    ("case", "form"),
    [
        ("substituted", "index2"),
        ("substituted in the plane", "index2"),
        ("substituted in the plane", "condensed"),
        ("oblique", "condensed"),
    ],
)
def test_a_substituted_jacobian_is_exact_along_the_manifold(case: str, form: str) -> None:
    found = equations(case, form)
    y, ydot, tangents = on_manifold(found, machine(case))
    cj = 1.7
    scale = np.abs(jacobian(found, y, ydot, cj)).max()
    for step in tangents:
        expected = np.imag(residual(found, y + 1j * STEP * step, ydot + 1j * STEP * cj * step)) / STEP
        np.testing.assert_allclose(jacobian(found, y, ydot, cj) @ step, expected, rtol=0, atol=1e-9 * scale)


def on_manifold(found: Dae, moving: Machine) -> tuple[Array, Array, Array]:
    """A state whose pose fits the joints, random else, and changes of it that keep the pose on the manifold."""
    layout = found.layout
    pose, _ = moving.consistent(2)
    phi_q = moving.at(("phi_q",), pose)["phi_q"]
    joints = phi_q[: len(moving.system.assembly.rows)]
    null = np.linalg.svd(joints)[2][np.linalg.matrix_rank(joints, tol=1e-9) :]
    y, ydot = anywhere(found)
    y[layout.positions.start : layout.positions.stop] = positions(moving.system, pose)
    tangents = []
    for q in null:
        step = np.zeros(layout.size)
        moved = positions(moving.system, pose.moved(moving.system, 1e-6 * q))
        back = positions(moving.system, pose.moved(moving.system, -1e-6 * q))
        step[: layout.positions.stop] = (moved - back) / 2e-6
        tangents.append(step)
    others = np.eye(layout.size)[layout.positions.stop : layout.multipliers.stop]
    return y, ydot, np.array([*tangents, *others])


def positions(system_: System, pose: Pose) -> Array:
    """A pose as the state has it."""
    found: list[float] = []
    for r, A in zip(pose.r, pose.A, strict=True):
        if system_.assembly.arrays.is_planar:
            found += [*r[:2], np.arctan2(A[1, 0], A[0, 0])]
        else:
            found += [*r, *Rotation.from_matrix(A).as_quat(scalar_first=True)]
    return np.array([*found, *pose.alpha])


@pytest.mark.parametrize(
    ("case", "form"),
    [
        ("conventional", "index1"),
        ("conventional", "index2"),
        ("loaded in space", "index2"),
        ("loaded in the plane", "index1"),
        ("substituted", "index2"),
        ("loaded in space", "condensed"),
        ("oblique", "condensed"),
    ],
)
def test_the_residual_vanishes_on_solutions(case: str, form: str) -> None:
    found, moving = equations(case, form), machine(case)
    layout = found.layout
    pose, v = driven(moving, 0.3) if moving.system.drives else moving.consistent(4)
    a, multipliers = moving.accelerations(pose, v, 0.3)
    where, rest = positions(moving.system, pose), np.zeros_like(multipliers)
    whole = np.concatenate([where, in_world(moving, pose, v), multipliers, rest])
    rates = np.concatenate([np.zeros_like(where), in_world(moving, pose, a), rest, rest])
    y, ydot = whole[list(layout.places)], rates[list(layout.places)]
    ydot[: layout.positions.stop] = -residual(found, y, ydot)[: layout.positions.stop]
    np.testing.assert_allclose(residual(found, y, ydot), 0, atol=1e-10)


def in_world(moving: Machine, pose: Pose, v: Array) -> Array:
    """Velocities with world translations."""
    if moving.system.assembly.translations == "world":
        return v
    seen = v.copy()
    for k, A in enumerate(pose.A):
        seen[6 * k : 6 * k + 3] = A @ v[6 * k : 6 * k + 3]
    return seen


def driven(moving: Machine, t: float) -> tuple[Pose, Array]:
    """A pose and velocities of the loaded arm at a time."""
    pose = start(moving.system)
    for _ in range(30):
        found = moving.at(("phi", "phi_q"), pose, t=t)
        pose = pose.moved(moving.system, -np.linalg.pinv(found["phi_q"], rcond=1e-9) @ found["phi"][:, 0])
    v = -np.linalg.pinv(found["phi_q"], rcond=1e-9) @ np.array(moving.system.phi_t(t))
    null = np.linalg.svd(found["phi_q"])[2][-1]
    return pose, v + 2 * null * (np.abs(found["phi_q"] @ null).max() < 1e-9)


def test_rates_of_positions_are_those_of_the_pose() -> None:
    """``pdot`` turns the attitude by omega, also where p is not of norm 1."""
    found = equations("loaded in space", "index2")
    y, ydot = anywhere(found)
    layout = found.layout
    ydot[: layout.positions.stop] -= residual(found, y, ydot)[: layout.positions.stop]
    p, rate = y[3:7], ydot[3:7]
    h = 1e-6
    turned = [Rotation.from_quat(p + s * rate, scalar_first=True) for s in (-h, h)]
    omega = (turned[0].inv() * turned[1]).as_rotvec() / (2 * h)
    np.testing.assert_allclose(omega, y[layout.velocities.start + 3 : layout.velocities.start + 6], rtol=1e-8)
    norm = p @ p
    assert 2 * p @ rate == pytest.approx(2 * (1 - norm) * norm)


def test_terms_that_are_left_out_are_left_out() -> None:
    exact, without = equations("loaded in the plane", "index2"), equations("loaded in the plane", "index2", SECOND)
    y, ydot = anywhere(exact)
    full, rest = jacobian(exact, y, ydot, 2.0), jacobian(without, y, ydot, 2.0)
    layout = exact.layout
    rows = list(layout.velocities)
    assert np.abs(rest[rows, : layout.positions.stop]).max() == 0
    assert np.abs(full[rows, : layout.positions.stop]).max() > 1
    np.testing.assert_allclose(full[list(layout.multipliers)], rest[list(layout.multipliers)], rtol=1e-13)


def test_entries_have_names_and_units() -> None:
    layout = equations("loaded in the plane", "index2").layout
    assert layout.names[:4] == ("arm.rx", "arm.ry", "arm.angle", "load.rx")
    assert layout.names[6:8] == ("shoulder.alpha1", "rail.alpha1")
    assert layout.units[6:8] == ("rad", "m")
    assert "drive of rail.lambda" in layout.names
    assert len(layout.names) == len(set(layout.names)) == layout.size
    assert layout.is_differential[layout.velocities.stop - 1]
    assert not layout.is_differential[layout.multipliers.start]
    assert float(BETA) == 20


def test_what_constants_tie_to_the_rest_is_no_unknown() -> None:
    """Rate, multiplier and correction of each coordinate; of a universal joint those of its second angle only."""
    cross = mechanisms.cross()
    for case, derivative in (("substituted", "substituted"), ("loaded in space", "exact")):
        whole, condensed = (layout(system(case), form) for form in ("index2", "condensed"))
        assert whole.size - condensed.size == 3 * 2
        assert not {"shoulder.alphadot1", "rail.alphadot1"} & set(condensed.names)
        assert mechanisms.system(cross, "parametric", derivative).condensed.coordinates == (1,)
    assert system("substituted").condensed.is_constant
    assert not system("loaded in space").condensed.is_constant
