"""Mechanisms of several equal parts that differ in where they are attached, and their routines in both shapes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.plan import Plan, plan
from codegen.mechanics.system import System
from codegen.scenes.compose import compose
from codegen.scenes.programs import estimate, program, without_zero_rows
from codegen.spec.plane import flattened
from codegen.spec.scene import Joint, Scene, Spring
from codegen.spec.scene_file.copies import copied

from .mechanisms import Link, mechanism

OFFSET = (Fraction(1, 3), Fraction(-2, 7), Fraction(1, 10))
PLANE = (*OFFSET[:2], Fraction(0))
CONSTRAINTS = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma", "phi_q_v", "phi_q_t_lambda")
ALL = (*CONSTRAINTS, "force")

LINKS = {
    "conventional": (
        Link("revolute", "conventional", (-1, 0)),
        Link("universal", "conventional", (0, 1)),
        Link("translational", "conventional", (1, -1)),
    ),
    "both": (
        Link("screw", "conventional", (-1, 0)),
        Link("revolute", "table4", (0, 1)),
        Link("ball", "conventional", (1, -1)),
    ),
}
"""Of one part with two bodies."""


def parts(form: str, count: int, derivative: str = "exact") -> Assembly:
    """Draw a part and repeat it; each has attachments of its own on the ground, and a spring to it.

    Args:
        form: one of `LINKS`.
        count: number of parts.
        derivative: of the parametric joints.
    """
    one = mechanism(5, 2, LINKS[form], derivative)
    spring = Spring((one.scene.bodies[0].name, "ground"), (OFFSET, OFFSET), Fraction(9), Fraction(1, 2), Fraction(1, 4))
    scene = copied(replace(one.scene, springs=(spring,)), count, OFFSET)
    return with_forms(one, scene)


def with_forms(one: Assembly, scene: Scene) -> Assembly:
    """Give the joints of copies the forms of the first."""
    forms = [one.forms[joint.name] for joint in one.scene.joints]
    names = [joint.name for joint in scene.joints]
    return Assembly(scene, {name: forms[k % len(forms)] for k, name in enumerate(names)})


def in_the_plane(count: int) -> Assembly:
    """Slider-cranks beside each other in one plane."""
    one = mechanism(6, 2, (LINKS["conventional"][0], Link("revolute", "conventional", (0, 1))))
    upright = replace(one.scene, joints=tuple(_along_z(joint) for joint in one.scene.joints), motion="planar")
    spring = Spring((upright.bodies[0].name, "ground"), (PLANE, PLANE), Fraction(9), Fraction(1, 2), Fraction(1, 4))
    scene = flattened(copied(replace(upright, springs=(spring,)), count, PLANE))
    return without_zero_rows(with_forms(one, scene))


def _along_z(joint: Joint) -> Joint:
    one, zero = Fraction(1), Fraction(0)
    axes = ((one, zero, zero), (zero, one, zero), (zero, zero, one))
    i, j = (replace(marker, point=(*marker.point[:2], zero), axes=axes) for marker in (joint.marker_i, joint.marker_j))
    return replace(joint, marker_i=i, marker_j=j)


def looped(assembly: Assembly, names: Sequence[str] = ALL) -> Looped:
    """A routine of all quantities, part by part; any evaluation."""
    return compose(planned(assembly), lambda system: program(system, names, estimate))


def planned(assembly: Assembly) -> Plan:
    """The parts."""
    return plan(assembly)


def whole(assembly: Assembly, names: Sequence[str] = ALL) -> Program:
    """The same routine of the scene as one, without a thought of parts."""
    return program(System(assembly), names, estimate)
