"""Joint frames reproduce the point and the axis that the file gives, on both bodies; in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.spec.placement import frame, marker, rotation
from codegen.spec.scene import Joint, Marker

from .texts import joined, scene

Triple = tuple[Fraction, ...]
DIGITS = Fraction(1, 10**38)
DECIMALS = st.integers(-999, 999).map(lambda value: Fraction(value, 100))
TRIPLES = st.tuples(DECIMALS, DECIMALS, DECIMALS)
DIRECTIONS = TRIPLES.filter(any)
# Norms are rational: these quaternions have norm 1 exactly.
QUATERNIONS = st.sampled_from(
    [("1", "0", "0", "0"), ("0.6", "0", "0", "0.8"), ("0.5", "0.5", "-0.5", "0.5"), ("0.1", "0.7", "-0.5", "0.5"),
     ("0.36", "0.48", "0.8", "0"), ("0.4", "0.4", "0.2", "0.8"), ("0", "1", "0", "0")]
)  # fmt: skip


def product(p: Triple, q: Triple) -> Triple:
    """Product of quaternions."""
    (a, b, c, d), (e, f, g, h) = p, q
    return (a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f,
            a * h + b * g - c * f + d * e)  # fmt: skip


def turned(quaternion: Triple, vector: Triple) -> Triple:
    """``q v q*``: a vector in body axes, in world axes."""
    w, x, y, z = quaternion
    return product(product(quaternion, (Fraction(0), *vector)), (w, -x, -y, -z))[1:]


def cross(a: Triple, b: Triple) -> Triple:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def dot(a: Triple, b: Triple) -> Fraction:
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def column(marked: Marker, k: int) -> Triple:
    return tuple(row[k] for row in marked.axes)


def is_orthonormal(axes: tuple[Triple, Triple, Triple]) -> bool:
    f, g, h = axes
    products = (dot(f, f) - 1, dot(g, g) - 1, dot(h, h) - 1, dot(f, g), dot(g, h), dot(h, f))
    right = (x - y for x, y in zip(cross(f, g), h, strict=True))
    return all(abs(value) < DIGITS for value in (*products, *right))


def text_of(vector: Triple) -> str:
    return "[" + ", ".join(f"{float(value):.2f}" for value in vector) + "]"


def placed(
    type_: str, point: Triple, axis: Triple, axis2: Triple | None, poses: list[tuple[Triple, tuple[str, ...]]]
) -> Joint:
    bodies = "".join(
        f'[[body]]\nname = "{name}"\nmass = 1\ninertia = [1, 1, 1]\nposition = {text_of(position)}\n'
        f"quaternion = [{', '.join(quaternion)}]\n"
        for name, (position, quaternion) in zip("ab", poses, strict=True)
    )
    second = "" if axis2 is None else f"axis2 = {[float(x) for x in axis2]}\n"
    more = f'type = "{type_}"\npoint = {text_of(point)}\naxis = {text_of(axis)}\n{second}'
    return scene(joined(more, f'name = "bars"\n{bodies}')).joints[0]


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from(["revolute", "translational", "planar", "ball"]),
    TRIPLES,
    DIRECTIONS,
    TRIPLES,
    TRIPLES,
    QUATERNIONS,
    QUATERNIONS,
)
def test_point_and_axis_come_back_exactly(type_, point, axis, r_i, r_j, q_i, q_j) -> None:
    joint = placed(type_, point, axis, None, [(r_i, q_i), (r_j, q_j)])
    frames = []
    for marked, r, q in ((joint.marker_i, r_i, q_i), (joint.marker_j, r_j, q_j)):
        quaternion = tuple(Fraction(value) for value in q)
        assert tuple(a + b for a, b in zip(r, turned(quaternion, marked.point), strict=True)) == point
        f, g, h = (turned(quaternion, column(marked, k)) for k in range(3))
        assert is_orthonormal((f, g, h))
        assert dot(h, axis) > 0
        assert all(abs(value) < 20 * DIGITS for value in cross(h, axis))
        frames.append((*f, *g, *h))
    assert all(abs(a - b) < DIGITS for a, b in zip(*frames, strict=True))


@settings(max_examples=30, deadline=None)
@given(DIRECTIONS, DIRECTIONS, QUATERNIONS, QUATERNIONS)
def test_the_cross_of_a_universal_joint_has_the_two_axes(axis, other, q_i, q_j) -> None:
    axis2 = cross(axis, other)
    if not any(axis2):
        return
    zero = (Fraction(0),) * 3
    joint = placed("universal", zero, axis, axis2, [(zero, q_i), (zero, q_j)])
    h_i = turned(tuple(map(Fraction, q_i)), column(joint.marker_i, 2))
    f_j = turned(tuple(map(Fraction, q_j)), column(joint.marker_j, 0))
    assert dot(h_i, axis) > 0 and dot(f_j, axis2) > 0
    assert all(abs(value) < 20 * DIGITS for value in cross(h_i, axis))
    # axis2 goes through a double on its way into the text.
    assert all(abs(value) <= Fraction(1, 10**14) * max(map(abs, axis2)) for value in cross(f_j, axis2))
    assert abs(dot(h_i, turned(tuple(map(Fraction, q_i)), column(joint.marker_i, 0)))) < DIGITS


def test_frames_lie_along_body_axes_where_they_can() -> None:
    for axis, expected in (
        ("[0, 0, 3]", (1, 0, 0)),
        ("[0, -2, 0]", (1, 0, 0)),
        ("[1, 0, 0]", (0, 1, 0)),
        ("[3, 4, 0]", (0, 0, 1)),
    ):
        (joint,) = scene(joined(f'type = "revolute"\npoint = [0.5, 0, 0]\naxis = {axis}')).joints
        assert column(joint.marker_i, 0) == expected
        assert joint.marker_i.axes == joint.marker_j.axes


def test_digits_that_a_file_leaves_out_make_no_arithmetic() -> None:
    """A body turned by a quarter, with sixteen digits of it: all constants are 0, 1 and the half length."""
    half = "0.7071067811865476"
    text = f"""name = "bars"
[[body]]
name = "a"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[body]]
name = "b"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = [1.0, 0.5, 0.0]
quaternion = [{half}, 0.0, 0.0, {half}]
"""
    (joint,) = scene(joined('type = "revolute"\npoint = [1, 0, 0]\naxis = [1e-17, 0, 1]', text)).joints
    assert joint.marker_j == Marker((Fraction(-1, 2), 0, 0), ((0, 1, 0), (-1, 0, 0), (0, 0, 1)))


def test_frames_stay_orthonormal_where_small_components_are_dropped() -> None:
    h = (Fraction(1, 10**10), Fraction(3, 5), Fraction(4, 5))
    assert is_orthonormal(tuple(zip(*frame(h), strict=True)))
    for quaternion in ((1, 10**-10, 0, 0), (3, 1, 2, 5), (10**9, 1, 1, 0)):
        attitude = rotation(tuple(map(Fraction, quaternion)))
        marked = marker((Fraction(0),) * 3, frame(h), (Fraction(0),) * 3, attitude)
        assert is_orthonormal(tuple(zip(*marked.axes, strict=True)))


@pytest.mark.parametrize("type_", ["ball", "rigid"])
def test_joints_without_an_axis_have_the_axes_of_the_first_body(type_: str) -> None:
    (joint,) = scene(joined(f'type = "{type_}"\npoint = [0.5, 0, 0]')).joints
    assert joint.marker_i.axes == ((1, 0, 0), (0, 1, 0), (0, 0, 1))


def test_frames_in_body_axes_are_laid_on_each_body_by_itself() -> None:
    more = 'type = "universal"\npoints = [[0.25, 0, 0], [-0.75, 0, 0]]\naxes = [[0, 0, 2], [0, 5, 0]]'
    (joint,) = scene(joined(more)).joints
    assert joint.marker_i == Marker((Fraction("0.25"), 0, 0), ((1, 0, 0), (0, 1, 0), (0, 0, 1)))
    assert joint.marker_j.point == (Fraction("-0.75"), 0, 0)
    assert column(joint.marker_j, 0) == (0, 1, 0)
    assert is_orthonormal(tuple(column(joint.marker_j, k) for k in range(3)))
