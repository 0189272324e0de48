"""Bringing mechanisms together; closure is measured on the joints' own points and axes, not on phi."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.measure.assembly import assemble
from codegen.measure.constraints import ConstraintSystem, Pose
from codegen.measure.velocities import project_velocity
from tests.measure.mechanisms import (
    bars_that_are_too_short,
    bricard,
    four_bar,
    pendulum,
    slider_crank,
    spatial_slider_crank,
    triangle,
)

MECHANISMS = {
    "slider-crank": slider_crank(),
    "four-bar": four_bar(),
    "six-bar": bricard(),
    "spatial": spatial_slider_crank(),
    "several": slider_crank(copies=3),
}
each_mechanism = pytest.mark.parametrize("name", MECHANISMS)
each_form = pytest.mark.parametrize("form", ["conventional", "parametric"])


def disturbed(system: ConstraintSystem, pose: Pose, size: float, seed: int = 5) -> Pose:
    return pose.moved(size * np.random.default_rng(seed).normal(size=system.column_count))


def openings(system: ConstraintSystem, pose: Pose) -> float:
    """Largest distance of points that a joint holds together, m, or sine between axes that it keeps parallel."""
    found = []
    for joint in system.joints:
        ends = [(pose.body(body), frame) for body, frame in zip(joint.bodies, joint.frames, strict=True)]
        points = [r + A @ frame.s for (r, A), frame in ends]
        axes = [A @ frame.C for (_, A), frame in ends]
        apart = points[1] - points[0]
        if joint.type == "translational":
            apart = apart - (apart @ axes[0][:, 2]) * axes[0][:, 2]
        found.append(np.linalg.norm(apart))
        if joint.type in ("revolute", "translational"):
            found.append(np.linalg.norm(axes[0][:, 2] - axes[1][:, 2]))
        if joint.type == "translational":
            found.append(np.linalg.norm(axes[0] - axes[1]))
        if joint.type == "universal":
            found.append(abs(axes[0][:, 2] @ axes[1][:, 0]))
    return float(max(found))


@each_form
@each_mechanism
def test_a_disturbed_mechanism_is_closed_again_near_where_it_was(name, form):
    system, pose = MECHANISMS[name].mechanism(form)
    start = disturbed(system, pose, 0.03)
    assert openings(system, start) > 0.01
    found = assemble(system, start)
    assert found.is_closed
    assert openings(system, found.pose) < 1e-11
    assert np.max(np.abs(start.step_to(found.pose))) < 0.3
    assert np.allclose(found.pose.A @ np.swapaxes(found.pose.A, 1, 2), np.eye(3), atol=1e-14)


@each_mechanism
def test_a_closed_mechanism_stays_as_it_is_bit_for_bit(name):
    system, pose = MECHANISMS[name].mechanism()
    found = assemble(system, pose)
    assert found.is_closed
    assert np.array_equal(found.pose.r, pose.r)
    assert np.array_equal(found.pose.A, pose.A)


@each_mechanism
def test_the_end_is_quadratic_also_with_redundant_rows(name):
    """From gaps of a micrometre two steps are enough; linear convergence would take twenty."""
    system, pose = MECHANISMS[name].mechanism()
    found = assemble(system, disturbed(system, pose, 1e-6))
    assert found.is_closed
    assert found.iterations <= 3


@pytest.mark.parametrize(("heavy", "light"), [(0, 2), (2, 0)])
def test_heavy_bodies_move_less(heavy, light):
    """The piston is drawn 5 cm off its pins; crank or piston gives way, whichever is light."""
    system, pose = slider_crank().mechanism()
    start = Pose(pose.r + np.array([[0, 0, 0], [0, 0, 0], [0.05, 0, 0]]), pose.A, pose.alpha)
    weights = np.ones((3, 6))
    weights[heavy] = 1e8
    change = start.step_to(assemble(system, start, weights.ravel()).pose).reshape(3, 6)
    assert np.max(np.abs(change[heavy])) < 1e-5
    assert np.max(np.abs(change[light])) > 0.01


def test_bars_that_are_too_short_stay_open_by_the_missing_length():
    # 0.4 m are missing; the sum of squares is least where the three pins share them.
    system, pose = bars_that_are_too_short().mechanism()
    found = assemble(system, disturbed(system, pose, 0.02))
    assert not found.is_closed
    assert {gap.joint for gap in found.open_joints} == {"O1", "A", "O2"}
    assert [gap.length for gap in found.after] == pytest.approx([0.4 / 3] * 3, rel=1e-4)
    assert "open by 133.3 mm" in str(found.open_joints[0])


def test_a_joint_that_is_turned_over_is_no_solution():
    system, pose = pendulum().mechanism()
    over = Rotation.from_rotvec([0.0, np.pi, 0.0]).as_matrix()
    joint = system.joints[0]
    position = joint.frames[1].s if joint.bodies[0] is None else joint.frames[0].s
    start = Pose(-(over @ position)[None], over[None], pose.alpha)
    found = assemble(system, start)
    assert not found.is_closed
    assert found.open_joints[0].angle == pytest.approx(np.pi)


@each_form
@each_mechanism
def test_projected_velocities_keep_the_mechanism_closed_to_second_order(name, form):
    system, pose = MECHANISMS[name].mechanism(form)
    velocity = np.random.default_rng(2).normal(size=system.column_count)
    found, left = project_velocity(system, pose, velocity)
    assert left < 1e-12
    gaps = [openings(system, pose.moved(h * found)) for h in (1e-3, 1e-4)]
    assert gaps[1] < 0.011 * gaps[0] + 1e-13
    assert np.allclose(project_velocity(system, pose, found)[0], found, atol=1e-12)


def test_velocities_follow_a_prescribed_rate():
    system, pose = pendulum().mechanism()
    rate = np.array([0.3, -0.2, 0.1, 0.0, 0.0])
    found, left = project_velocity(system, pose, np.zeros(6), rate)
    assert left < 1e-14
    assert np.allclose(system.phi_q(pose) @ found, rate, atol=1e-14)


def test_a_rate_that_a_locked_mechanism_cannot_follow_is_left_over():
    system, pose = triangle().mechanism()
    rate = np.zeros(15)
    rate[-1] = 1.0
    assert project_velocity(system, pose, np.zeros(12), rate)[1] > 0.1


def test_where_the_bodies_stand_in_the_world_makes_no_difference():
    near, far = slider_crank(), slider_crank()
    system, pose = near.mechanism()
    start = disturbed(system, pose, 0.02)
    shift = np.array([0.0, 0.0, 100.0])
    far.bodies = {name: (r + shift, A) for name, (r, A) in far.bodies.items()}
    far.joints = [replace(joint, point=np.array(joint.point, float) + shift) for joint in far.joints]
    other, _ = far.mechanism()
    found, moved = assemble(system, start), assemble(other, Pose(start.r + shift, start.A, start.alpha))
    assert moved.is_closed
    assert np.allclose(found.pose.r + shift, moved.pose.r, atol=1e-9)
