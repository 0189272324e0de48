"""Small mechanisms with loads, as scenes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction as F

from codegen.mechanics.assembly import Assembly
from codegen.mechanics.system import System
from codegen.scenes.programs import without_zero_rows
from codegen.spec.placement import IDENTITY, frame, marker
from codegen.spec.request import Variant
from codegen.spec.scene import (
    GROUND,
    Body,
    Coordinate,
    Drive,
    Force,
    Joint,
    Limit,
    Matrix,
    Scene,
    Spring,
    Torque,
    Vector,
)

UPRIGHT = (F(1), F(0), F(0), F(0))
SLIM: Matrix = ((F("0.02"), F(0), F(0)), (F(0), F("0.3"), F(0)), (F(0), F(0), F("0.4")))
SKEWED: Matrix = ((F("0.2"), F("0.03"), F(0)), (F("0.03"), F("0.3"), F("-0.02")), (F(0), F("-0.02"), F("0.4")))


def vector(*values: str | int) -> Vector:
    """Exact components."""
    x, y, z = map(F, values)
    return x, y, z


DRIVE = Drive(F("0.02"), F("0.3"), F("0.05"), F(3), F("0.7"))
X, Y, Z = vector(1, 0, 0), vector(0, 1, 0), vector(0, 0, 1)
GRAVITY = vector(0, "-9.81", 0)


def body(name: str, position: Vector, mass: str = "1.5", inertia: Matrix = SLIM) -> Body:
    """A body at rest, its axes along those of the world."""
    return Body(name, F(mass), inertia, position, UPRIGHT)


def joint(
    name: str, type_: str, bodies: Sequence[Body | None], point: Vector, axis: Vector = Z, *loads: Coordinate
) -> Joint:
    """A joint at a point of the world; None is the ground."""
    axes = frame(axis)
    first, second = (marker(point, axes, vector(0, 0, 0) if b is None else b.position, IDENTITY) for b in bodies)
    i, j = (GROUND if b is None else b.name for b in bodies)
    return Joint(name, type_, (i, j), first, second, coordinates=loads)


def slider_crank(*loads: Coordinate) -> Scene:
    """In line; loads act on the crank."""
    crank, rod, piston = (body(n, vector(x, 0, 0)) for n, x in (("crank", "0.05"), ("rod", "0.25"), ("piston", "0.4")))
    joints = (
        joint("main", "revolute", (None, crank), vector(0, 0, 0), Z, *loads),
        joint("pin", "revolute", (crank, rod), vector("0.1", 0, 0)),
        joint("wrist", "revolute", (rod, piston), vector("0.4", 0, 0)),
        joint("slide", "translational", (None, piston), vector("0.4", 0, 0), X),
    )
    return Scene("engine", GRAVITY, (crank, rod, piston), joints)


def four_bar() -> Scene:
    """A four-bar linkage in the plane of x and y, with a spring from the ground to the coupler."""
    a, b, c = (
        body("crank", vector(0, "0.1", 0)),
        body("coupler", vector("0.25", "0.3", 0), "2"),
        body("rocker", vector("0.5", "0.2", 0)),
    )
    joints = (
        joint("first", "revolute", (None, a), vector(0, 0, 0)),
        joint("second", "revolute", (a, b), vector(0, "0.2", 0)),
        joint("third", "revolute", (b, c), vector("0.5", "0.4", 0)),
        joint("fourth", "revolute", (None, c), vector("0.5", 0, 0)),
    )
    spring = Spring((GROUND, "coupler"), (vector(1, 1, 0), vector("0.1", "0.02", 0)), F(80), F(0), F("0.4"))
    return Scene("four_bar", GRAVITY, (a, b, c), joints, (spring,))


def pendulum(damping: str = "0") -> Scene:
    """A spatial double pendulum with springs between its bodies and to the ground, pushed by constant forces."""
    upper, lower = (
        body("upper", vector("0.2", "-0.3", "0.1"), "1.2", SKEWED),
        body("lower", vector("0.3", "-0.8", "0.2"), "0.7"),
    )
    joints = (
        joint("hook", "ball", (None, upper), vector(0, 0, 0)),
        joint("elbow", "universal", (upper, lower), vector("0.4", "-0.6", "0.2"), X),
    )
    springs = (
        Spring((GROUND, "upper"), (vector("0.5", "0.1", 0), vector("0.1", 0, "0.2")), F(30), F(damping), F("0.2")),
        Spring(("upper", "lower"), (vector("0.1", "0.1", 0), vector(0, "0.3", "0.2")), F(20), F(damping), F("0.5")),
        Spring((GROUND, "lower"), (vector(0, 0, 0), vector(0, 0, 0)), F(5), F(damping), F(0)),
    )
    pushes = (
        Force("lower", vector(2, 1, -3), vector("0.1", "-0.4", "0.2")),
        Force("upper", vector(-1, 0, 2)),
    )
    return Scene("pendulum", GRAVITY, (upper, lower), joints, springs, forces=pushes)


def loaded(motion: str = "spatial") -> Scene:
    """Two bodies on a loaded arm: everything that may act, acts."""
    flat = motion == "planar"
    arm, load = (
        body("arm", vector("0.2", 0, 0), inertia=SLIM if flat else SKEWED),
        body("load", vector("0.5", "0.1", 0)),
    )
    turning = Coordinate(F(2), F(3), F("0.4"), F("0.1"), None, Limit(F("-0.5"), F("0.3"), F(100), F(2)))
    sliding = Coordinate(F(-1), F(20), F(1), F(0), DRIVE)
    joints = (
        joint("shoulder", "revolute", (None, arm), vector(0, 0, 0), Z, turning),
        joint("rail", "translational", (arm, load), vector("0.5", "0.1", 0), X, sliding),
    )
    depth = 0 if flat else "0.1"
    springs = (
        Spring((GROUND, "load"), (vector(1, "0.5", depth), vector("0.1", "0.2", depth)), F(40), F(3), F("0.6")),
        Spring(("arm", "load"), (vector("0.1", "0.1", 0), vector(0, "0.3", depth)), F(0), F(2), F(0)),
    )
    torques = (Torque("arm", Z if flat else vector(1, 2, "0.5")), Torque("load", Z))
    point = vector("0.3", "-0.1", 0 if flat else "0.2")
    forces = (
        Force("arm", vector(3, -2, 0 if flat else "1.5"), point),
        Force("load", vector(0, 4, 0)),
        Force("arm", vector("0.5", 0, 0), point),
        Force("arm", Y, vector(0, "0.25", 0)),
    )
    gravity = GRAVITY if flat else vector(1, "-9.81", 2)
    return Scene("arm", gravity, (arm, load), joints, springs, torques, motion, forces=forces)


def system(scene: Scene, form: str = "parametric", derivative: str = "exact", point: str = "body") -> System:
    """All joints in one form; in the plane the rows that are zero are left out."""
    rows = None if form == "conventional" else "regular"
    forms = {j.name: Variant(j.type, form, rows, derivative, point=point) for j in scene.joints}
    assembly = Assembly(scene, forms)
    return System(without_zero_rows(assembly) if scene.motion == "planar" else assembly)


def unloaded(scene: Scene) -> Scene:
    """The same without what acts on joint coordinates, so that any form will do."""
    return replace(scene, joints=tuple(replace(j, coordinates=()) for j in scene.joints))


def cross() -> Scene:
    """A body on a universal joint."""
    hung = body("hung", vector(0, "-0.3", 0))
    return Scene("cross", GRAVITY, (hung,), (joint("cross", "universal", (None, hung), vector(0, 0, 0)),))


def oblique() -> Scene:
    """Axes across all others, and loads along them: a plate slides on an arm that turns."""
    arm, plate = body("arm", vector("0.2", 0, 0), inertia=SKEWED), body("plate", vector("0.5", "0.1", 0))
    axis = vector(F(2, 7), F(3, 7), F(6, 7))
    loads = [Coordinate(F(k), F(3 + k), F("0.4"), F("0.1"), None, None) for k in range(3)]
    joints = (
        joint("pin", "revolute", (None, arm), vector("0.1", 0, 0), axis, loads[2]),
        joint("table", "planar", (arm, plate), vector("0.5", "0.1", 0), axis, *loads),
    )
    return Scene("oblique", GRAVITY, (arm, plate), joints)
