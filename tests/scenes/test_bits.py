"""Specialised routines against the generic path in doubles: the same bits wherever the operations are the same.

The operations of an entry are known by its form (`tests.scenes.operations`); what is compared are the numbers that both
programs give in plain floating-point arithmetic, the generic one with zeros and ones in its run-time geometry.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

from codegen.ir.evaluate import evaluate, float_domain
from codegen.mechanics.assembly import Assembly
from codegen.scenes.programs import estimate, program
from codegen.spec.placement import IDENTITY
from codegen.spec.scene import Marker
from tests.lower.numbers import Numbers

from .cases import EXACT_SCENES, scene
from .library import System, assembled, dense
from .mechanisms import Link, mechanism, pose
from .operations import FORMS, ZERO, form, rounded

NAMES = ("phi", "phi_q", "phi_q_t_lambda_q", "gamma")
ELSEWHERE = 1e-15
"""Beside the largest entry of the quantity."""


@dataclass(frozen=True, eq=False)
class Compared:
    """A quantity on both paths.

    Attributes:
        name: of the quantity.
        same: where both take the same operations, and the entry is not identically zero.
        is_zero: where the entry is identically zero.
        specialised: values of the scene's routine.
        generic: values of the library's routines put into place.
    """

    name: str
    same: Numbers
    is_zero: Numbers
    specialised: Numbers
    generic: Numbers


def compared(assembly: Assembly) -> Iterator[Compared]:
    """Run both paths at a pose."""
    specialised = program(assembly, NAMES, estimate)
    exact = pose(assembly, 2)
    numbers = {name: [float(x) for x in entries] for name, entries in exact.items()}
    symbols: dict[str, list[Any]] = {
        name: [form("input", name, k) for k in range(len(entries))] for name, entries in exact.items()
    }
    forms, values = evaluate(specialised, symbols, FORMS), evaluate(specialised, numbers)
    generic_forms = assembled(System(assembly, symbols, rounded), FORMS)
    generic_values = assembled(System(assembly, numbers, float), float_domain())
    for output in specialised.outputs:
        operations = dense(output, forms[output.name], ZERO)
        is_zero = (operations == ZERO) & (generic_forms[output.name] == ZERO)
        yield Compared(
            output.name,
            (operations == generic_forms[output.name]) & ~is_zero,
            is_zero,
            dense(output, values[output.name], 0.0).astype(float),
            generic_values[output.name].astype(float),
        )


@pytest.mark.parametrize("name", EXACT_SCENES[:3])
def test_the_same_operations_give_the_same_bits_and_others_the_same_to_1e_15(name: str) -> None:
    for quantity in compared(scene(name)):
        apart = abs(quantity.specialised - quantity.generic)
        assert not apart[quantity.same | quantity.is_zero].any(), quantity.name
        assert apart.max() <= ELSEWHERE * abs(quantity.generic).max(), quantity.name
        assert quantity.name != "phi_q" or np.sum(quantity.same) > np.sum(~quantity.is_zero) / 4


@pytest.mark.parametrize(
    ("x", "names"),
    ((Fraction(0), ("phi", "phi_q")), (Fraction(1, 3), ("phi_q_t_lambda_q",))),
    ids=("centre", "on an axis"),
)
def test_a_ball_joint_on_axes_of_its_bodies_takes_the_operations_of_the_generic_path(
    x: Fraction, names: tuple[str, ...]
) -> None:
    """Those that are left when products with zero and one are gone; so every entry has the same bits."""
    drawn = mechanism(0, 2, (Link("ball", "conventional", (0, 1)),))
    first, second = ((x, Fraction(0), Fraction(0)), (Fraction(0), x, Fraction(0)))
    (joint,) = drawn.scene.joints
    joint = replace(joint, marker_i=Marker(first, IDENTITY), marker_j=Marker(second, IDENTITY))
    for quantity in compared(replace(drawn, scene=replace(drawn.scene, joints=(joint,)))):
        if quantity.name in names:
            assert (quantity.same | quantity.is_zero).all() and quantity.same.any()
            assert (quantity.specialised == quantity.generic).all()
