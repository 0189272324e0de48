"""Forces that joints carry against the rows of their routines, and the groups of loops."""

import numpy as np
import pytest

from codegen.measure.attitudes import turned, turns
from codegen.measure.constraints import Pose, scales
from codegen.measure.freedoms import CARRIED, FREE, FREER, carried_rows, placed, twists
from codegen.measure.loops import group, loops
from tests.measure.mechanisms import Drawing, about_z, bricard, parallelogram_with_a_third_crank, slider_crank
from tests.reference.constraints import Geometry, relative_position, relative_rotation, split_alpha
from tests.reference.poses import random_alpha
from tests.reference.rotations import exp_map

each_joint = pytest.mark.parametrize("joint", sorted(CARRIED))


def joint_somewhere(joint: str):
    """Two bodies in a general pose with a joint between them whose coordinates are not 0."""
    generator = np.random.default_rng(7)
    drawing = Drawing()
    drawing.body("one", generator.normal(size=3), exp_map(generator.normal(size=3)))
    drawing.body("two", generator.normal(size=3), exp_map(generator.normal(size=3)))
    axis = np.array([2.0, -1.0, 2.0]) / 3
    second = np.array([1.0, 2.0, 0.0]) / np.sqrt(5)
    drawing.joint("pin", joint, ("one", "two"), generator.normal(size=3), axis, second, pitch=0.2)
    system, pose = drawing.mechanism()
    own, other = system.joints[0].frames
    alpha = random_alpha(joint, None, generator)
    zeros = np.zeros(3)
    geometry = Geometry(zeros, np.eye(3), zeros, np.eye(3), 0.2, 0.0, 0.0)
    offsets, angles = split_alpha(joint, None, alpha, geometry)
    trn = {"translational": 1, "screw": 1, "cylindrical": 1, "planar": 2}.get(joint, 0)
    d = own.C @ relative_position(trn, offsets, geometry)
    H = relative_rotation(len(angles), angles)
    A_j = pose.A[0] @ own.C @ H @ other.C.T
    r_j = pose.r[0] + pose.A[0] @ (own.s + d) - A_j @ other.s
    return system, Pose(np.array([pose.r[0], r_j]), np.array([pose.A[0], A_j]), pose.alpha)


@each_joint
def test_the_forces_that_a_joint_carries_span_the_rows_of_its_routine(joint):
    system, pose = joint_somewhere(joint)
    assert np.max(np.abs(system.phi(pose))) < 1e-14
    rows = system.phi_q(pose)
    carried = carried_rows(system.joints[0], pose, CARRIED[joint], 1.0)
    sizes = [np.linalg.matrix_rank(matrix, tol=1e-9) for matrix in (rows, carried, np.vstack([rows, carried]))]
    assert sizes == [len(CARRIED[joint])] * 3


@each_joint
def test_the_twists_that_a_joint_allows_do_no_work_on_what_it_carries(joint):
    system, pose = joint_somewhere(joint)
    origin = np.array([0.3, -1.0, 0.4])
    allowed = twists(system.joints[0], pose, origin, 1.0)
    assert len(allowed) == len(FREE[joint]) == 6 - len(CARRIED[joint])
    for angular, linear in zip(allowed[:, :3], allowed[:, 3:], strict=True):
        motion = np.concatenate([linear + np.cross(angular, pose.r[1] - origin), pose.A[1].T @ angular])
        assert np.max(np.abs(system.phi_q(pose)[:, 6:] @ motion), initial=0.0) < 1e-14


@each_joint
def test_a_freer_joint_carries_what_is_not_released(joint):
    degrees = {name: 6 - len(carried) for name, carried in CARRIED.items()}
    for freer in FREER.get(joint, ()):
        assert set(freer.released) <= set(CARRIED[joint])
        assert degrees[freer.type] == degrees[joint] + len(freer.released)


def test_the_loop_of_a_slider_crank_has_all_its_joints():
    system, _ = slider_crank().mechanism()
    assert loops(system) == ((0, 1, 2, 3),)


def test_a_second_loop_is_independent_of_the_first():
    system, _ = parallelogram_with_a_third_crank().mechanism()
    found = loops(system)
    assert len(found) == len(system.joints) - len(system.bodies) == 2
    assert all(len(loop) == 4 for loop in found)


def test_the_group_of_general_axes_is_that_of_all_motions():
    system, pose = bricard().mechanism()
    assert group(system, pose, range(6), scales(system).length).dimension == 6


def test_the_group_of_parallel_axes_is_plane_motion_wherever_the_joints_stand():
    system, pose = slider_crank(unit=100.0).mechanism()
    found = group(system, pose, range(4), scales(system).length)
    assert (found.dimension, found.name) == (3, "plane motion")


def test_attitudes_turn_and_turn_back():
    A = np.array([about_z(0.4), exp_map(np.array([0.3, -1.2, 0.8]))])
    vectors = np.array([[0.1, -0.2, 0.3], [0.0, 2.0, -1.0]])
    moved = turned(A, vectors)
    assert np.allclose(moved[1], A[1] @ exp_map(vectors[1]), atol=1e-14)
    assert np.allclose(turns(A, moved), vectors, atol=1e-14)


def test_a_joint_stands_where_its_frame_on_body_i_is():
    system, pose = slider_crank().mechanism()
    here = placed(system.joints[1], pose)
    assert np.allclose(here.point, [0.3 * np.cos(0.7), 0.3 * np.sin(0.7), 0.0])
    assert np.allclose(here.axes["h"], [0, 0, 1])
