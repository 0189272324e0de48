"""Sections of a scene, and series of equal ones."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

from hypothesis import given
from hypothesis import strategies as st

from codegen.spec.scene import GROUND, Body, Force, Joint, Marker, Scene, Spring, Torque
from codegen.spec.sections import alike, differing, repeated, sections

ZERO = (Fraction(0),) * 3
AXES = tuple(tuple(Fraction(int(i == k)) for k in range(3)) for i in range(3))


def scene(bodies: int, ties: list[tuple[int, int]], springs: tuple[tuple[int, int], ...] = ()) -> Scene:
    """Bodies and revolute joints between them; -1 is the ground."""
    names = [f"b{k}" for k in range(bodies)]
    still = tuple(Body(name, Fraction(1), AXES, ZERO, (Fraction(1), *ZERO)) for name in names)

    def name(k: int) -> str:
        return GROUND if k < 0 else names[k]

    marker = Marker(ZERO, AXES)
    joints = tuple(Joint(f"j{k}", "revolute", (name(i), name(j)), marker, marker) for k, (i, j) in enumerate(ties))
    elastic = tuple(Spring((name(i), name(j)), (ZERO, ZERO), *(Fraction(1),) * 3) for i, j in springs)
    return Scene("drawn", ZERO, still, joints, elastic)


def shapes(found: Scene) -> list[tuple[list[int], list[int]]]:
    """Bodies and joints of the sections."""
    return [(list(section.bodies), list(section.joints)) for section in sections(found)]


def test_bodies_that_only_the_ground_ties_are_sections_of_their_own() -> None:
    assert shapes(scene(4, [(-1, 0), (0, 1), (-1, 2), (3, 2)])) == [([0, 1], [0, 1]), ([2, 3], [2, 3])]


def test_bodies_that_take_turns_are_one_section() -> None:
    assert shapes(scene(4, [(0, 2), (1, 3)])) == [([0, 1, 2, 3], [0, 1])]
    assert shapes(scene(2, [(-1, 1), (-1, 0)])) == [([0, 1], [0, 1])]


def test_a_spring_ties_bodies_as_a_joint_does() -> None:
    ties = [(-1, 0), (-1, 1), (-1, 2)]
    assert len(shapes(scene(3, ties))) == 3
    assert shapes(scene(3, ties, springs=((0, 1),))) == [([0, 1], [0, 1]), ([2], [2])]


def test_a_body_without_joints_goes_with_its_neighbour() -> None:
    assert shapes(scene(3, [(-1, 0), (-1, 2)])) == [([0], [0]), ([1, 2], [1])]
    assert shapes(scene(3, [(-1, 0), (-1, 1)])) == [([0], [0]), ([1, 2], [1])]


def test_springs_torques_and_forces_go_with_their_bodies() -> None:
    tied = scene(2, [(-1, 0), (-1, 1)], springs=((-1, 1), (-1, 0)))
    found = replace(tied, torques=(Torque("b1", ZERO),), forces=(Force("b1", ZERO), Force("b0", ZERO)))
    parts = [(section.springs, section.torques, section.forces) for section in sections(found)]
    assert parts == [((1,), (), (1,)), ((0,), (0,), (0,))]


def test_bodies_that_are_pushed_otherwise_are_not_alike() -> None:
    found = scene(2, [(-1, 0), (-1, 1)])
    across = (Fraction(1), Fraction(0), Fraction(0))
    pushed = [
        replace(found, forces=(Force("b0", across), other))
        for other in (Force("b1", across), Force("b1", across, across))
    ]
    assert [len(alike(data)) for data in pushed] == [1, 2]


@given(st.integers(1, 6), st.data())
def test_sections_cover_everything_once_and_no_joint_leaves_one(bodies: int, data: st.DataObject) -> None:
    ends = st.tuples(st.integers(-1, bodies - 1), st.integers(0, bodies - 1)).filter(lambda tie: tie[0] != tie[1])
    ties = data.draw(st.lists(ends, min_size=1, max_size=6))
    found = sections(scene(bodies, ties))
    assert [k for section in found for k in section.bodies] == list(range(bodies))
    assert [k for section in found for k in section.joints] == list(range(len(ties)))
    for section in found:
        assert all(body in section.bodies for k in section.joints for body in ties[k] if body >= 0)


def test_sections_that_differ_in_where_they_are_attached_are_alike() -> None:
    found = scene(2, [(-1, 0), (-1, 1)])
    moved = replace(found.joints[1], marker_i=Marker((Fraction(1), Fraction(0), Fraction(2)), AXES))
    (group,) = alike(replace(found, joints=(found.joints[0], moved)))
    varying, values = differing([section.scene(replace(found, joints=(found.joints[0], moved))) for section in group])
    assert varying == {(0, 0, 0): 0, (0, 0, 2): 1} and values == ((0, 0), (1, 2))


def test_sections_of_other_mass_or_other_joints_are_not_alike() -> None:
    found = scene(2, [(-1, 0), (-1, 1)])
    heavy = replace(found.bodies[1], mass=Fraction(2))
    assert len(alike(replace(found, bodies=(found.bodies[0], heavy)))) == 2
    ball = replace(found.joints[1], type="ball")
    assert len(alike(replace(found, joints=(found.joints[0], ball)))) == 2


def test_equal_keys_at_equal_distances_are_a_series() -> None:
    assert repeated([0, 0, 0]) == (range(3),)
    assert repeated([0, 1, 1, 0, 1, 1]) == (range(0, 6, 3), range(1, 6, 3), range(2, 6, 3))
    assert repeated([0, 0, 0, 1]) == (range(3), range(3, 4))


def test_a_series_ends_where_something_else_comes_between() -> None:
    assert repeated([0, 1, 0, 2, 0, 3]) == (range(0, 3, 2), range(1, 2), range(3, 4), range(4, 5), range(5, 6))


@given(st.lists(st.integers(0, 2), min_size=1, max_size=14))
def test_every_position_is_in_one_series_and_keys_between_are_equal(keys: list[int]) -> None:
    found = repeated(keys)
    assert sorted(k for series in found for k in series) == list(range(len(keys)))
    for series in found:
        gaps = {tuple(keys[k : k + series.step]) for k in series[:-1]}
        assert len({keys[k] for k in series}) == 1 and len(gaps) <= 1
