"""Random mechanisms and poses, in exact numbers.

Joint frames are those of the bodies, turned about one of their axes by the angle of 3 : 4 : 5, or any; attachments are
at the centre of mass, on an axis of the body, or anywhere. Bodies need not fit together: what is tested are identities.
"""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from typing import Any

import numpy as np

from codegen.mechanics.assembly import Assembly
from codegen.spec.placement import IDENTITY
from codegen.spec.request import Variant
from codegen.spec.scene import GROUND, SCENE_JOINTS, Body, Joint, Marker, Matrix, Scene
from tests.lower.numbers import Inputs, Numbers, fraction, rotation

UPRIGHT = (Fraction(1), Fraction(0), Fraction(0), Fraction(0))
FORMS = ("conventional", "regular", "table4")
KINDS = ("aligned", "h along", "f along", "any")
"""Of joint frames: which of their axes lie along axes of their body."""

TURN = np.array([[3, -4, 0], [4, 3, 0], [0, 0, 5]], dtype=object) * Fraction(1, 5)
"""About the third axis, by the angle of 3 : 4 : 5."""

ASKEW = np.array([[-15, 52, 36], [-20, -39, 48], [60, 0, 25]], dtype=object) * Fraction(1, 65)
"""A rotation of which no column lies along an axis; what is across its third is rational too, see `placement.frame`."""


@dataclass(frozen=True, slots=True)
class Link:
    """A joint to be drawn: its type, its form (one of `FORMS`) and the numbers of its bodies; -1 is the ground."""

    type: str
    form: str
    bodies: tuple[int, int]


def aligned(source: random.Random) -> Numbers:
    """A rotation whose columns are axes."""
    matrix = np.zeros((3, 3), dtype=object) + Fraction(0)
    for column, row in enumerate(source.choice(list(permutations(range(3))))):
        matrix[row, column] = Fraction(source.choice((-1, 1)))
    return matrix if determinant(matrix) > 0 else -matrix


def determinant(matrix: Numbers) -> Any:
    """Of three columns."""
    a, b, c = matrix.T
    return np.dot(np.cross(a, b), c)


def axes(source: random.Random, kind: str) -> Matrix:
    """Axes of a marker: ``aligned``, ``h along`` or ``f along`` an axis of the body, or ``any``."""
    matrix = aligned(source)
    if kind == "any":
        matrix = matrix @ ASKEW
    if kind in ("h along", "any"):
        matrix = matrix @ TURN
    if kind == "f along":
        about_f = np.roll(TURN, (1, 1), (0, 1))
        matrix = matrix @ about_f
    return as_matrix(matrix)


def as_matrix(matrix: Numbers) -> Matrix:
    """Three rows of fractions."""
    a, b, c = ((Fraction(x), Fraction(y), Fraction(z)) for x, y, z in matrix)
    return a, b, c


def marker(source: random.Random, kinds: Sequence[str] = KINDS) -> Marker:
    """A joint frame on a body."""
    point = [Fraction(0)] * 3
    for k in source.sample(range(3), source.choice((0, 1, 2, 3))):
        point[k] = fraction(source) / 4
    x, y, z = point
    return Marker((x, y, z), axes(source, source.choice(kinds)))


def mechanism(seed: int, bodies: int, links: Iterable[Link], derivative: str = "exact") -> Assembly:
    """Draw the geometry of joints between some bodies.

    Args:
        seed: of the drawing.
        bodies: how many.
        links: the joints.
        derivative: of the joints in parametric form.
    """
    source = random.Random(seed)
    names = [f"body {k}" for k in range(bodies)]
    joints, forms = [], {}
    for number, link in enumerate(links):
        name = f"{link.type} {number}"
        i, j = (names[body] if body >= 0 else GROUND for body in link.bodies)
        pitch = Fraction(source.choice((0, 2, -3)), 7) if link.type == "screw" else Fraction(0)
        kinds = KINDS[:3] if link.type == "universal" else KINDS  # of its cross both axes must be rational, see ASKEW
        joints.append(Joint(name, link.type, (i, j), marker(source, kinds), marker(source, kinds), pitch))
        forms[name] = variant(link, derivative)
    still = tuple(Body(name, Fraction(1), IDENTITY, (Fraction(0),) * 3, UPRIGHT) for name in names)
    return Assembly(Scene("drawn", (Fraction(0),) * 3, still, tuple(joints)), forms)


def variant(link: Link, derivative: str) -> Variant:
    """Form of a joint."""
    if link.form == "conventional":
        return Variant(link.type, "conventional", None)
    return Variant(link.type, "parametric", link.form, derivative)


def drawn(seed: int, bodies: int, joints: int, forms: Sequence[str] = FORMS, derivative: str = "exact") -> Assembly:
    """Draw joints and geometry; the types follow one another from a random one on, so that none is left out."""
    source = random.Random(1000 + seed)
    first = source.randrange(len(SCENE_JOINTS))
    links = []
    for k in range(joints):
        i, j = source.sample(range(-1, bodies), 2)
        links.append(Link(SCENE_JOINTS[(first + k) % len(SCENE_JOINTS)], source.choice(list(forms)), (i, j)))
    return mechanism(seed, bodies, links, derivative)


def pose(assembly: Assembly, seed: int) -> Inputs:
    """Draw inputs; attitudes are exactly orthonormal, in planar motion turns about the normal."""
    source = random.Random(seed)
    inputs = {argument.name: [fraction(source) for _ in range(argument.length)] for argument in assembly.arguments()}
    inputs["revolutions"] = [Fraction(source.choice((-2, -1, 1, 2))) for _ in inputs["revolutions"]]
    inputs["A"] = []
    for _ in assembly.scene.bodies:
        if assembly.arrays.is_planar:
            half = fraction(source)
            cosine, sine = (1 - half * half) / (1 + half * half), 2 * half / (1 + half * half)
            inputs["A"] += [cosine, sine, -sine, cosine]
        else:
            inputs["A"] += list(rotation(source).T.ravel())
    return inputs
