"""The references of the two mechanisms of S2 are themselves checked: difference quotients, energy, printed facts."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
import pytest
import sympy
from scipy.integrate import quad

from .one_freedom import OneFreedom, q
from .quick_return import CUT, DRIVE, crossings, cutting_work, quick_return
from .spatial_slider_crank import LENGTHS, lock_up, spatial_slider_crank

MECHANISMS: dict[str, Callable[[], OneFreedom]] = {
    "quick return": quick_return,
    "quick return, other branch": lambda: quick_return(branch=1),
    **{f"slider-crank {float(length)}": lambda length=length: spatial_slider_crank(length) for length in LENGTHS},  # type: ignore[misc]
}
ANGLES = np.array([-2.0, -0.3, 0.44, 1.7, 2.9, 3.6])


@pytest.mark.parametrize("name", MECHANISMS)
def test_attitudes_are_rotations_with_their_derivatives(name: str) -> None:
    h = 1e-5
    for body in MECHANISMS[name]().bodies.values():
        for angle in ANGLES:
            A, dA, ddA = body.motion(angle)[3:]
            before, after = body.motion(angle - h), body.motion(angle + h)
            assert np.max(np.abs(A @ A.T - np.eye(3))) < 1e-14
            assert np.linalg.det(A) > 0
            assert np.max(np.abs((after[3] - before[3]) / (2 * h) - dA)) < 1e-7
            assert np.max(np.abs((after[4] - before[4]) / (2 * h) - ddA)) < 1e-6


@pytest.mark.parametrize("name", MECHANISMS)
def test_slopes_are_difference_quotients(name: str) -> None:
    mechanism, h = MECHANISMS[name](), 1e-5
    before, after = mechanism.inertia(ANGLES - h), mechanism.inertia(ANGLES + h)
    _, dm, _, dV = mechanism.inertia(ANGLES)
    assert (after[0] - before[0]) / (2 * h) == pytest.approx(dm, rel=1e-6, abs=1e-5)
    assert (after[2] - before[2]) / (2 * h) == pytest.approx(dV, rel=1e-6, abs=1e-5)


@pytest.mark.parametrize("name", MECHANISMS)
def test_kinetic_energy_is_that_of_bodies_that_are_moved(name: str) -> None:
    """From places at two moments, without omega: the trace of the second moments of mass."""
    mechanism, h = MECHANISMS[name](), 1e-4
    total = 0.0
    for body in mechanism.bodies.values():
        place = sympy.lambdify(q, sympy.Matrix.hstack(body.A, body.r))
        rate = (place(0.44 + h) - place(0.44 - h)) / (2 * h)
        inertia = np.array(body.inertia, dtype=float)
        moments = np.trace(inertia) / 2 * np.eye(3) - inertia
        total += float(body.mass) * rate[:, 3] @ rate[:, 3] + np.trace(rate[:, :3] @ moments @ rate[:, :3].T)
    assert total == pytest.approx(mechanism.inertia(0.44)[0], rel=1e-6)


def test_the_drive_does_the_work_of_cutting_each_turn() -> None:
    assert pytest.approx(5.2 * CUT, rel=1e-5) == 2 * np.pi * DRIVE
    assert cutting_work(0.44, np.array(0.44 + 2 * np.pi)) == pytest.approx(-5.2 * CUT, rel=1e-12)


def test_the_work_of_cutting_is_an_integral_over_the_stroke() -> None:
    x = quick_return()
    begins, ends = crossings()
    for first, last in ((0.44, 2.0), (0.44, 4.0), (0.44, 0.44 + 5.0), (ends, begins + 2 * np.pi + 1.0)):

        def power(angle: float) -> float:
            is_cutting = (angle - begins) % (2 * np.pi) < ends - begins
            return CUT * float(x.output("x", angle, 1.0)[1]) if is_cutting else 0.0

        points = [p for p in (ends, begins + 2 * np.pi) if first < p < last] or None
        assert cutting_work(first, np.array(last)) == pytest.approx(
            quad(power, first, last, points=points)[0], rel=1e-9
        )


def test_the_return_is_quicker_than_the_stroke() -> None:
    angles = np.linspace(0, 2 * np.pi, 100_001)
    rate = quick_return().output("x", angles, 1.0)[1]
    assert np.mean(rate < 0) > 0.6
    assert np.max(rate) > 5 * np.max(-rate)


@pytest.mark.parametrize("length", LENGTHS)
def test_acceleration_peaks_where_the_crank_points_along_the_offset(length: Fraction) -> None:
    d, r, L, w = np.hypot(0.1, 0.12), 0.08, float(length), 2 * np.pi
    angle = np.arctan2(0.1, 0.12)
    peak = spatial_slider_crank(length).output("x", angle, w)[2]
    assert peak == pytest.approx(d * r * w**2 / np.sqrt(L**2 - (d + r) ** 2), rel=1e-12)
    angles = np.linspace(0, 2 * np.pi, 10_001)
    assert np.max(spatial_slider_crank(length).output("x", angles, w)[2]) <= peak * (1 + 1e-12)
    assert float(lock_up()) == pytest.approx(d + r, rel=1e-15)


@pytest.mark.parametrize("name", MECHANISMS)
def test_integration_keeps_energy(name: str) -> None:
    mechanism = MECHANISMS[name]()
    force = DRIVE if name.startswith("quick") else 0.05
    times = np.linspace(0, 0.15, 4)
    found = mechanism.motion(0.44, 2 * np.pi, times, lambda *_: force)
    speed = mechanism.speed_by_energy(0.44, 2 * np.pi, found[:, 0], force * (found[:, 0] - 0.44))
    assert np.max(np.abs(found[:, 1] - speed)) < 1e-10


@pytest.mark.parametrize("name", MECHANISMS)
def test_effort_and_acceleration_invert_each_other(name: str) -> None:
    mechanism = MECHANISMS[name]()
    for angle in ANGLES:
        effort = mechanism.effort(angle, 3.0, -2.0)
        assert mechanism.acceleration(angle, 3.0, effort) == pytest.approx(-2.0, rel=1e-11)
