"""Scenes at the edges: names of any kind, two joints between the same bodies, rows and quantities that are left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import pytest

from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.passes.select import select
from codegen.scenes.programs import program as cheapest_program
from tests.lower.numbers import EXACT

from .library import System, assembled
from .mechanisms import Link, mechanism, pose
from .workshop import ALL, any_program, values

PAIR = (Link("revolute", "conventional", (0, 1)), Link("ball", "table4", (1, -1)))


def assert_equal(assembly: Assembly, program: Program, names: Sequence[str] = ALL) -> None:
    """Compare a program with the library's routines, exactly."""
    inputs = pose(assembly, 7)
    emitted, expected = values(program, inputs), assembled(System(assembly, inputs, Fraction), EXACT)
    assert set(emitted) == set(names)
    for quantity in names:
        assert emitted[quantity].shape == expected[quantity].shape, quantity
        assert (emitted[quantity] == expected[quantity]).all(), quantity


def renamed(assembly: Assembly, bodies: Sequence[str], joints: Sequence[str]) -> Assembly:
    """The same scene with other names."""
    old = assembly.scene
    body_names = dict(zip((body.name for body in old.bodies), bodies, strict=True))
    joint_names = dict(zip((joint.name for joint in old.joints), joints, strict=True))
    new = replace(
        old,
        bodies=tuple(replace(body, name=body_names[body.name]) for body in old.bodies),
        joints=tuple(
            replace(
                joint,
                name=joint_names[joint.name],
                bodies=tuple(body_names.get(name, name) for name in joint.bodies),  # type: ignore[arg-type]
            )
            for joint in old.joints
        ),
    )
    return Assembly(new, {joint_names[name]: variant for name, variant in assembly.forms.items()})


@pytest.mark.parametrize(
    ("bodies", "joints"),
    (
        (("world", "ground_2"), ("i", "j")),
        (("a b", "a_b"), ("a b", "a_b")),
        (("ij pin", "pin"), ("pin", "pin_2")),
        (("Räder", "轮"), ("\n", "*/")),
        (("i", "star i"), ("world", "star")),
        (("lambda", "alpha_0"), ("velocity", "r")),
    ),
)
def test_names_do_not_matter(bodies: tuple[str, str], joints: tuple[str, str]) -> None:
    drawn = renamed(mechanism(2, 2, PAIR), bodies, joints)
    assert_equal(drawn, any_program(drawn, ("phi", "phi_q")), ("phi", "phi_q"))


def test_two_joints_may_join_the_same_bodies() -> None:
    """One of them the other way round; their blocks fall on one another."""
    drawn = mechanism(4, 2, (Link("revolute", "conventional", (0, 1)), Link("universal", "conventional", (1, 0))))
    assert_equal(drawn, any_program(drawn))


@pytest.mark.parametrize("form", ("conventional", "regular"))
def test_rows_may_be_left_out(form: str) -> None:
    """Also rows within a vector of three, and all rows of a joint; multipliers are those of the rows that stay."""
    drawn = mechanism(5, 2, (Link("revolute", form, (0, 1)), Link("ball", "conventional", (1, -1))))
    first = len(drawn.rows) - 3
    for dropped in ({1, 3, first + 2}, set(range(first))):
        less = replace(drawn, dropped=frozenset(dropped))
        assert len(less.rows) == first + 3 - len(dropped)
        assert_equal(less, any_program(less))


@pytest.mark.parametrize("form", ("conventional", "regular"))
def test_no_row_need_be_left(form: str) -> None:
    drawn = mechanism(5, 1, (Link("universal", form, (0, -1)),))
    none = replace(drawn, dropped=frozenset(drawn.rows))
    assert none.rows == ()
    program = any_program(none)
    assert_equal(none, program)
    assert not any(program.output(name).values for name in ALL if name != "phi_q_t_lambda")


@pytest.mark.parametrize("name", ALL)
def test_a_quantity_alone_is_that_among_all(name: str) -> None:
    drawn = mechanism(2, 2, PAIR)
    assert_equal(drawn, any_program(drawn, (name,)), (name,))


@pytest.mark.parametrize("derivative", ("exact", "substituted"))
def test_a_substituted_joint_may_be_asked_for_phi_or_for_all_but_phi(derivative: str) -> None:
    drawn = mechanism(2, 1, (Link("revolute", "regular", (0, -1)),), derivative)
    for names in (("phi",), ("phi_q", "gamma"), ("gamma", "phi")):
        assert_equal(drawn, any_program(drawn, names), names)


def test_the_cheapest_program_has_the_same_values() -> None:
    drawn = mechanism(2, 2, PAIR)
    names = ("phi", "phi_q")
    assert_equal(drawn, cheapest_program(drawn, names), names)


def test_rows_and_columns_are_selected_in_the_order_asked_for() -> None:
    drawn = mechanism(1, 1, (Link("ball", "conventional", (0, -1)),))
    program = any_program(drawn, ("phi_q",))
    inputs = pose(drawn, 1)
    whole = values(program, inputs)["phi_q"]
    part = values(select(program, {"phi_q": ((2, 0), (4, 0, 3))}), inputs)["phi_q"]
    assert (part == whole[[2, 0]][:, [4, 0, 3]]).all()
