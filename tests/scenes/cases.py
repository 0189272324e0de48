"""Mechanisms with every joint type in every form, the ground as body i and as body j, and several joints on a body."""

from __future__ import annotations

from functools import cache

import pytest

from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly

from .mechanisms import Link, mechanism
from .workshop import any_program

EXACT_SCENES = (
    "0: conventional revolute G0, conventional translational 0G",
    "1: conventional cylindrical 01, conventional universal 1G, conventional ball G0",
    "2: conventional planar 10, conventional rigid 0G",
    "3: conventional screw 0G",
    "4: regular revolute 0G, table4 translational G0, conventional ball 01",
    "5: regular cylindrical 01, table4 universal 1G",
    "6: regular planar G0, table4 rigid 01",
    "7: regular ball 0G, table4 revolute G0",
    "8: table4 ball 01, regular universal G1",
    "9: regular screw 0G, conventional universal 01",
    "10: table4 planar 10, table4 cylindrical 0G, regular translational 0G",
    "11: table4 screw G0, regular rigid 0G",
    "12: conventional revolute 01, conventional revolute 01",
)
"""Number of the drawing; joints with form, type and bodies (G: the ground)."""

SUBSTITUTED_SCENES = (
    "13: regular revolute 0G, table4 screw G0, conventional revolute 01",
    "14: regular cylindrical 1G, table4 planar 01, conventional universal 0G",
    "15: regular ball 0G, table4 ball 1G",
    "16: regular translational 0G, table4 universal 10, regular rigid 0G",
    "17: regular screw 10, table4 rigid G0, table4 revolute 01",
    "18: table4 cylindrical G0, table4 translational G0, regular universal G0, regular planar 0G",
)

SCENES = EXACT_SCENES + SUBSTITUTED_SCENES

every_scene = pytest.mark.parametrize("name", SCENES)


def described(name: str) -> tuple[int, list[Link]]:
    """Number and joints of a scene."""
    number, joints = name.split(": ")
    links = []
    for joint in joints.split(", "):
        form, type_, (i, j) = joint.split()
        links.append(Link(type_, form, (int(i.replace("G", "-1")), int(j.replace("G", "-1")))))
    return int(number), links


@cache
def scene(name: str) -> Assembly:
    """Draw a scene."""
    number, links = described(name)
    bodies = 1 + max(body for link in links for body in link.bodies)
    return mechanism(number, bodies, links, "substituted" if name in SUBSTITUTED_SCENES else "exact")


@cache
def program(name: str) -> Program:
    """All quantities of a scene."""
    return any_program(scene(name), seed=described(name)[0])
