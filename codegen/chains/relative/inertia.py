"""Mass properties of bodies in the axes of the links that they belong to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from codegen.chains.relative.pose import Pose, multiplied
from codegen.spec.chain import Link
from codegen.spec.placement import IDENTITY, dot, transposed
from codegen.spec.scene import ZERO_VECTOR, Body, Matrix, Vector


def hung(links: Sequence[Link], bodies: Sequence[tuple[Body, str, Pose]]) -> list[Link]:
    """Give links the mass properties of the bodies on them.

    Args:
        links: massless.
        bodies: each with the name of its link and its pose there; those on the base are left out.
    """
    return [_with(link, [(body, pose) for body, name, pose in bodies if name == link.name]) for link in links]


def _with(link: Link, bodies: Sequence[tuple[Body, Pose]]) -> Link:
    mass = sum((body.mass for body, _ in bodies), Fraction(0))
    if not mass:
        return link
    centre: Vector = ZERO_VECTOR
    for body, pose in bodies:
        centre = _added(centre, pose.p, body.mass / mass)
    inertia: Matrix = (ZERO_VECTOR, ZERO_VECTOR, ZERO_VECTOR)
    for body, pose in bodies:
        turned = multiplied(multiplied(pose.R, body.inertia), transposed(pose.R))
        inertia = _summed(inertia, turned, _of_point(body.mass, _added(pose.p, centre, Fraction(-1))))
    return replace(link, mass=mass, centre=centre, inertia=inertia)


def _of_point(mass: Fraction, r: Vector) -> Matrix:
    """Inertia of a point about the origin."""
    square = dot(r, r)
    rows = [tuple(mass * (square * IDENTITY[i][k] - r[i] * r[k]) for k in range(3)) for i in range(3)]
    return tuple(rows)  # type: ignore[return-value]


def _added(a: Vector, b: Vector, factor: Fraction) -> Vector:
    x, y, z = (p + factor * q for p, q in zip(a, b, strict=True))
    return x, y, z


def _summed(*matrices: Matrix) -> Matrix:
    rows = [tuple(sum((m[i][k] for m in matrices), Fraction(0)) for k in range(3)) for i in range(3)]
    return tuple(rows)  # type: ignore[return-value]
