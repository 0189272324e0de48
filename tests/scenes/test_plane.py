"""A planar mechanism somewhere in space moves as the same mechanism written in the plane of world x and y."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from codegen.ir.evaluate import evaluate, float_domain
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.scenes.programs import without_zero_rows
from codegen.spec.placement import dot, length
from codegen.spec.plane import InPlane, flattened, in_plane, planar_normal
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, Scene, Vector

from .library import System, assembled, dense
from .linkages import AXES, HEIGHTS, Linkage, linkage, matrix
from .workshop import any_program

POSES = ((Fraction(3, 5), Fraction(4, 5)), (Fraction(12, 13), Fraction(5, 13)), (Fraction(24, 25), Fraction(-7, 25)))
"""Cosine and sine of half the angle of the crank."""

ROUNDING = 1e-13

every_plane = pytest.mark.parametrize("plane", AXES)
with_any_axes = pytest.mark.parametrize("is_skew", (False, True), ids=("bodies along", "bodies askew"))


def conventional(scene: Scene) -> Assembly:
    """All joints in conventional form."""
    return Assembly(scene, {joint.name: Variant(joint.type, "conventional", None) for joint in scene.joints})


def program_in_plane(found: InPlane) -> tuple[Assembly, Program]:
    """phi and phi_q of the mechanism in the plane."""
    assembly = without_zero_rows(conventional(found.scene))
    return assembly, any_program(assembly, ("phi", "phi_q"))


def corresponding(link: Linkage, found: InPlane, half: tuple[Fraction, Fraction]) -> dict[str, list[float]]:
    """Inputs of the mechanism in the plane where the one in space has a pose."""
    world = np.array(found.world, dtype=object)
    inputs: dict[str, list[float]] = {"r": [], "A": []}
    for name, (r, q) in link.pose(half).items():
        A = world @ matrix(q) @ np.array(found.bodies[name], dtype=object).T
        assert abs(A[2, 2] - 1) < 1e-30 and max(abs(A[2, :2])) < 1e-30  # it turns about the normal
        inputs["r"] += [float(x) for x in (world @ r)[:2]]
        inputs["A"] += [float(x) for x in A[:2, :2].T.ravel()]
    return inputs


def in_space(link: Linkage, half: tuple[Fraction, Fraction]) -> dict[str, np.ndarray]:
    """phi and phi_q of the mechanism in space, by the library."""
    assembly = conventional(link.scene())
    pose = link.pose(half).values()
    inputs = {
        "r": [float(x) for r, _ in pose for x in r],
        "A": [float(x) for _, q in pose for x in matrix(q).T.ravel()],
        "alpha": [],
        "revolutions": [],
        "velocity": [0.0] * (6 * len(pose)),
        "lambda": [0.0] * assembly.all_rows,
    }
    found = assembled(System(assembly, inputs, float), float_domain())
    return {name: value.astype(float) for name, value in found.items()}


def displacements(found: InPlane) -> np.ndarray:
    """[6 n, 3 n]: what displacements in the plane are in space."""
    world = np.array(found.world, dtype=float)
    count = len(found.scene.bodies)
    result = np.zeros((6 * count, 3 * count))
    for k, body in enumerate(found.scene.bodies):
        result[6 * k : 6 * k + 3, 3 * k : 3 * k + 2] = world.T[:, :2]
        result[6 * k + 3 : 6 * k + 6, 3 * k + 2] = np.array(found.bodies[body.name], dtype=float)[2]
    return result


def rank(matrix: np.ndarray) -> int:
    """Number of singular values that are not rounding."""
    return int(np.sum(np.linalg.svd(matrix, compute_uv=False) > 1e-10))


@every_plane
@with_any_axes
def test_the_mechanism_moves_as_it_did(plane: str, is_skew: bool) -> None:
    """Constraints vanish at corresponding poses, and the same displacements are free there."""
    link = linkage(plane, is_skew)
    found = in_plane(link.scene())
    _, program = program_in_plane(found)
    for half in POSES:
        values = evaluate(program, corresponding(link, found, half))
        spatial = in_space(link, half)
        assert max(map(abs, values["phi"])) < ROUNDING
        assert abs(spatial["phi"]).max() < ROUNDING
        phi_q = dense(program.output("phi_q"), values["phi_q"], 0.0).astype(float)
        restricted = spatial["phi_q"] @ displacements(found)
        assert rank(phi_q) == rank(restricted) == rank(np.vstack([phi_q, restricted])) == 14


@every_plane
def test_what_holds_bodies_in_the_plane_is_no_longer_there(plane: str) -> None:
    """Two rows of each revolute and translational joint stay, and none of a planar one."""
    assembly, _ = program_in_plane(in_plane(linkage(plane, True).scene()))
    assert len(assembly.rows) == 14


@pytest.mark.parametrize("plane", [name for name in AXES if name != "skew"])
def test_axes_along_those_of_the_world_stay_zeros_and_ones(plane: str) -> None:
    link = linkage(plane, False)
    scene = link.scene()
    found = in_plane(scene)
    for axes in (found.world, *found.bodies.values()):
        assert sorted(abs(x) for row in axes for x in row) == [0] * 6 + [1] * 3
    for joint, old in zip(found.scene.joints, scene.joints, strict=True):
        for marker, before in ((joint.marker_i, old.marker_i), (joint.marker_j, old.marker_j)):
            assert {abs(x) for x in marker.point} <= {abs(x) for x in before.point} | {0}


def test_a_mechanism_in_the_plane_of_x_and_y_keeps_its_axes() -> None:
    link = replace(linkage("along z", False), own={name: AXES["along z"] for name in HEIGHTS})
    scene = link.scene()
    flat = flattened(scene)
    for body, old in zip(flat.bodies, scene.bodies, strict=True):
        assert body.quaternion == old.quaternion
        assert body.position == (*old.position[:2], 0)
        assert body.inertia == old.inertia
    assert flattened(flat) == flat


@every_plane
@with_any_axes
def test_loads_in_the_plane_stay_and_inertia_is_about_the_normal(plane: str, is_skew: bool) -> None:
    scene = linkage(plane, is_skew).scene()
    found = in_plane(scene)
    normal = found.world[2]
    for body, old in zip(found.scene.bodies, scene.bodies, strict=True):
        axis: Vector = found.bodies[body.name][2]
        turned = [dot(row, axis) for row in old.inertia]
        assert abs(body.inertia[2][2] - dot(axis, turned)) < 1e-30
    square = dot(scene.gravity, scene.gravity)
    assert abs(dot(found.scene.gravity, found.scene.gravity) + found.gravity**2 - square) < 1e-30
    assert found.scene.gravity[2] == 0
    assert found.scene.torques[0].vector[:2] == (0, 0)
    assert abs(found.scene.torques[0].vector[2] - dot(normal, scene.torques[0].vector)) < 1e-30


@every_plane
@with_any_axes
def test_a_force_has_the_moment_about_the_normal_that_it_had(plane: str, is_skew: bool) -> None:
    scene = linkage(plane, is_skew).scene()
    found = in_plane(scene)
    moments, pulls = [], []
    for data, normal in ((scene, np.array(found.world[2])), (found.scene, np.array([0, 0, 1]))):
        (force,) = data.forces
        body = data.body(force.body)
        assert body is not None
        pull = np.array(force.vector)
        pulls.append(dot(pull, pull) - dot(normal, pull) ** 2)
        moments.append(dot(normal, np.cross(matrix(body.quaternion) @ np.array(force.point), pull)))
    assert abs(moments[0] - moments[1]) < 1e-30
    assert abs(pulls[0] - pulls[1]) < 1e-30
    assert found.scene.forces[0].vector[2] == found.scene.forces[0].point[2] == 0


@every_plane
@with_any_axes
def test_a_spring_is_as_long_as_it_was(plane: str, is_skew: bool) -> None:
    link = linkage(plane, is_skew)
    scene = link.scene()
    lengths = []
    for data in (scene, flattened(scene)):
        (spring,) = data.springs
        ends = []
        for name, point in zip(spring.bodies, spring.points, strict=True):
            body = data.body(name)
            if body is not None:
                point = np.array(body.position) + matrix(body.quaternion) @ np.array(point)
            ends.append(np.array(point))
        lengths.append(length(tuple(ends[1] - ends[0])))
    assert abs(lengths[0] - lengths[1]) < 1e-30


@every_plane
def test_a_planar_mechanism_is_recognised(plane: str) -> None:
    link = linkage(plane, True)
    found = planar_normal(link.scene())
    assert found is not None
    assert abs(abs(dot(found, tuple(matrix(link.plane)[:, 2]))) - 1) < 1e-30


@pytest.mark.parametrize("type_", ("screw", "cylindrical", "universal", "ball"))
def test_a_joint_that_turns_or_moves_out_of_the_plane_makes_a_mechanism_spatial(type_: str) -> None:
    scene = linkage("skew", True).scene()
    first, *others = scene.joints
    assert planar_normal(replace(scene, joints=(replace(first, type=type_), *others))) is None


def test_a_body_that_no_joint_holds_makes_a_mechanism_spatial() -> None:
    scene = linkage("skew", True).scene()
    kept = tuple(joint for joint in scene.joints if joint.name != "floor")
    assert planar_normal(replace(scene, joints=kept)) is None
    assert planar_normal(replace(scene, joints=())) is None


def test_an_axis_askew_makes_a_mechanism_spatial() -> None:
    scene = linkage("along z", False).scene()
    first, *others = scene.joints
    f, g, h = zip(*first.marker_i.axes, strict=True)
    marker = replace(first.marker_i, axes=tuple(zip(h, f, g, strict=True)))  # type: ignore[arg-type]
    assert planar_normal(replace(scene, joints=(replace(first, marker_i=marker), *others))) is None


def test_bodies_that_only_slide_lie_in_the_plane_that_is_nearest_at_hand() -> None:
    scene = linkage("along x", False).scene()
    guide = next(joint for joint in scene.joints if joint.name == "guide")
    slider = scene.body("slider")
    assert slider is not None
    alone = replace(scene, bodies=(slider,), joints=(guide,), springs=(), torques=(), forces=())
    assert planar_normal(alone) is None
    assert {GROUND, "slider"} == set(in_plane(alone).bodies)
    assert len(without_zero_rows(conventional(flattened(alone))).rows) == 2
