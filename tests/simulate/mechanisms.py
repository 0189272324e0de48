"""Mechanisms at their limits, as scenes: engines, a sledge on two rails, a screw, a free body, a fixed bar."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction as F

from codegen.spec.placement import IDENTITY, frame, marker
from codegen.spec.scene import GROUND, Body, Joint, Matrix, Scene, Vector

X, Z = (F(1), F(0), F(0)), (F(0), F(0), F(1))
NO_GRAVITY = (F(0), F(0), F(0))


def vector(*values: str | F | int) -> Vector:
    """Exact components."""
    x, y, z = map(F, values)
    return x, y, z


def principal(*values: str) -> Matrix:
    """An inertia about its principal axes."""
    a, b, c = map(F, values)
    return (a, F(0), F(0)), (F(0), b, F(0)), (F(0), F(0), c)


def body(name: str, position: Vector, velocity: Vector, angular_velocity: Vector, mass: str = "1") -> Body:
    """A body whose axes are those of the world."""
    inertia = principal("0.001", "0.003", "0.003")
    return Body(name, F(mass), inertia, position, (F(1), F(0), F(0), F(0)), velocity, angular_velocity)


def joint(name: str, type_: str, bodies: tuple[Body | None, Body | None], point: Vector, axis: Vector = Z) -> Joint:
    """A joint at a point of the world; None is the ground."""
    first, second = (marker(point, frame(axis), NO_GRAVITY if b is None else b.position, IDENTITY) for b in bodies)
    i, j = (GROUND if b is None else b.name for b in bodies)
    return Joint(name, type_, (i, j), first, second)


def engine(rod: str = "0.3", speed: str = "15", piston: str = "0.5", wrong: str = "0") -> Scene:
    """An in-line engine at dead centre, without gravity, in the plane; its crank is 0.1 m long.

    Args:
        rod: length, m.
        speed: of the crank, rad/s.
        piston: mass, kg.
        wrong: added to the speed of the rod, rad/s: no motion of the mechanism.
    """
    a, b, w = F("0.1"), F(rod), F(speed)
    crank = body("crank", vector(a / 2, 0, 0), vector(0, w * a / 2, 0), vector(0, 0, w))
    turning = -w * a / b + F(wrong)
    link = body("rod", vector(a + b / 2, 0, 0), vector(0, w * a / 2, 0), vector(0, 0, turning))
    slider = body("piston", vector(a + b, 0, 0), NO_GRAVITY, NO_GRAVITY, piston)
    joints = (
        joint("main bearing", "revolute", (None, crank), NO_GRAVITY),
        joint("crank pin", "revolute", (crank, link), vector(a, 0, 0)),
        joint("piston pin", "revolute", (link, slider), vector(a + b, 0, 0)),
        joint("cylinder", "translational", (None, slider), vector(a + b, 0, 0), X),
    )
    return Scene("engine", NO_GRAVITY, (crank, link, slider), joints, motion="planar")


def sledge() -> Scene:
    """A sledge on two parallel rails: one rail too many."""
    runner = body("sledge", NO_GRAVITY, vector(1, 0, 0), NO_GRAVITY)
    rails = [
        joint(name, "translational", (None, runner), vector(0, y, 0), X)
        for name, y in (("left", "0.2"), ("right", "-0.2"))
    ]
    return Scene("sledge", NO_GRAVITY, (runner,), tuple(rails), motion="planar")


def screw(form: str = "auto") -> Scene:
    """A nut on a thread of 1 mm/rad; it turns at 2 pi rad/s, to 16 digits."""
    w = F("6.283185307179586")
    nut = body("nut", NO_GRAVITY, vector(0, 0, w / 1000), vector(0, 0, w))
    thread = replace(joint("thread", "screw", (None, nut), NO_GRAVITY), pitch=F("0.001"), form=form)
    return Scene("screw", NO_GRAVITY, (nut,), (thread,))


def stone(*angular_velocity: str) -> Scene:
    """A body without a joint, thrown; its inertias are 1, 2 and 3 kg m^2."""
    thrown = replace(body("stone", NO_GRAVITY, vector(1, 2, 3), vector(*angular_velocity)), mass=F(2))
    return Scene("stone", vector(0, "-9.81", 0), (replace(thrown, inertia=principal("1", "2", "3")),), ())


def bar() -> Scene:
    """A bar with two bearings: it cannot move."""
    beam = body("bar", vector("0.1", 0, 0), NO_GRAVITY, NO_GRAVITY)
    bearings = [joint(name, "revolute", (None, beam), vector(x, 0, 0)) for name, x in (("left", "0"), ("right", "0.2"))]
    return Scene("bar", vector(0, "-9.81", 0), (beam,), tuple(bearings), motion="planar")
