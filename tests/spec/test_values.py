"""Numbers of a scene file are taken exactly as they stand; everything else as documented."""

from __future__ import annotations

from fractions import Fraction

import pytest

from codegen.spec.scene import Coordinate, Drive, Force, Limit, Wanted

from .texts import PENDULUM, changed, joined, scene


@pytest.mark.parametrize(
    "text", ["0.1", "1", "-3", "0.30000000000000000000000001", "1e-30", "9.81e2", "1_000.5", "0x10", "-0.0", "1e30"]
)
def test_a_decimal_is_exact(text: str) -> None:
    found = scene(changed(("[0.0, -9.81, 0.0]", f"[0, {text}, 0]"))).gravity[1]
    assert found == (Fraction(16) if text == "0x10" else Fraction(text.replace("_", "")))


def test_three_principal_values_are_a_diagonal_inertia() -> None:
    rows = "inertia = [[0.01, 0, 0], [0, 0.2, 0], [0, 0, 0.2]]"
    assert scene(PENDULUM) == scene(changed(("inertia = [0.01, 0.2, 0.2]", rows)))


def test_what_is_left_out_has_its_default() -> None:
    least = scene('name = "x"\n[[body]]\nname = "a"\nmass = 1\ninertia = [1, 1, 1]')
    (body,) = least.bodies
    assert not any((*least.gravity, *body.position, *body.velocity, *body.angular_velocity))
    assert body.quaternion == (1, 0, 0, 0)
    assert (least.joints, least.springs, least.torques, least.forces) == ((), (), (), ())
    assert (least.motion, least.assemble) == ("spatial", False)
    assert least.wanted == Wanted((), "regular", "exact")


def test_loads_stand_on_the_coordinates_of_a_joint_translations_first() -> None:
    text = """
type = "cylindrical"
point = [0, 0, 0]
axis = [0, 0, 1]
torque = [1.5, 2.5]
stiffness = [0, 4]
damping = [0.5, 0]
rest = [0, 0.25]
drive = [{}, { position = -0.34081938, speed = 6.25, amplitude = 0.5, frequency = 3, phase = 0.75 }]
limit = [{ lower = -1, stiffness = 100 }, {}]
"""
    (joint,) = scene(joined(text)).joints
    swing = Drive(Fraction("-0.34081938"), Fraction("6.25"), Fraction("0.5"), Fraction(3), Fraction("0.75"))
    assert joint.coordinates == (
        Coordinate(
            Fraction("1.5"), Fraction(0), Fraction("0.5"), limit=Limit(Fraction(-1), None, Fraction(100), Fraction(0))
        ),
        Coordinate(Fraction("2.5"), Fraction(4), rest=Fraction("0.25"), drive=swing),
    )
    assert joint.needs_coordinates


@pytest.mark.parametrize(
    ("type_", "freedoms"),
    {"revolute": 1, "translational": 1, "screw": 1, "cylindrical": 2, "universal": 2, "planar": 3, "ball": 3,
     "rigid": 0}.items(),
)  # fmt: skip
def test_a_joint_has_as_many_coordinates_as_degrees_of_freedom(type_: str, freedoms: int) -> None:
    more = {"screw": "pitch = 0.1", "universal": "axis2 = [1, 0, 0]"}.get(type_, "")
    (joint,) = scene(joined(f'type = "{type_}"\npoint = [0, 0, 0]\naxis = [0, 0, 1]\n{more}')).joints
    assert joint.coordinates == (Coordinate(),) * freedoms
    assert not joint.needs_coordinates


@pytest.mark.parametrize("type_", ["ball", "cylindrical", "rigid"])
def test_a_single_0_acts_on_no_coordinate_however_many_there_are(type_: str) -> None:
    text = f'type = "{type_}"\npoint = [0, 0, 0]\naxis = [0, 0, 1]\nform = "conventional"\n'
    assert scene(joined(text + "torque = 0.0\nstiffness = 0\ndamping = 0.0")) == scene(joined(text))


def test_the_output_table_says_what_is_wanted() -> None:
    text = PENDULUM + '[output]\nquantities = ["phi", "mass"]\nrows = "table4"\nderivative = "substituted"\n'
    assert scene(text).wanted == Wanted(("phi", "mass"), "table4", "substituted")


def test_bodies_and_joints_may_have_any_names_that_print() -> None:
    names = ['x]; system(\\"rm\\"); //', "a*/", "Rad 1 – größer", "%s{{ 7*7 }}", "rod", "while"]
    for name in names:
        found = scene(PENDULUM.replace('"bar"', f'"{name}"').replace('"pin"', f'"{name}"'))
        assert found.bodies[0].name == found.joints[0].name == found.joints[0].bodies[1] == name.replace("\\", "")


def test_a_body_that_nothing_holds_is_no_mistake() -> None:
    assert len(scene(PENDULUM + '[[body]]\nname = "free"\nmass = 1\ninertia = [1, 1, 1]\n').bodies) == 2


def test_copies_repeat_everything_and_move_what_stands_on_the_ground() -> None:
    spring = '[[spring]]\nbodies = ["ground", "bar"]\npoints = [[0, 1, 0], [0.5, 0, 0]]\nstiffness = 3\n'
    torque = '[[torque]]\nbody = "bar"\nvector = [0, 0, 2]\n'
    force = '[[force]]\nbody = "bar"\nvector = [0, 5, 0]\npoint = [0.25, 0, 0]\n'
    found = scene(PENDULUM + spring + torque + force + "[copies]\ncount = 3\noffset = [0, 0.1, 2]\n")
    assert [body.name for body in found.bodies] == ["bar_1", "bar_2", "bar_3"]
    assert [joint.bodies for joint in found.joints] == [("ground", f"bar_{k}") for k in (1, 2, 3)]
    assert [joint.name for joint in found.joints] == ["pin_1", "pin_2", "pin_3"]
    assert found.bodies[2].position == (Fraction("0.5"), Fraction("0.2"), 4)
    assert found.joints[2].marker_i.point == (0, Fraction("0.2"), 4)
    assert found.joints[2].marker_j == found.joints[0].marker_j
    assert found.springs[2].points == ((0, Fraction("1.2"), 4), (Fraction("0.5"), 0, 0))
    assert [item.body for item in found.torques] == ["bar_1", "bar_2", "bar_3"]
    assert found.forces == tuple(Force(f"bar_{k}", (0, 5, 0), (Fraction("0.25"), 0, 0)) for k in (1, 2, 3))


def test_a_force_acts_on_the_centre_of_mass_if_no_point_is_given() -> None:
    assert scene(PENDULUM + '[[force]]\nbody = "bar"\nvector = [1, 2, 3]\n').forces == (
        Force("bar", (1, 2, 3), (0, 0, 0)),
    )


def test_one_copy_leaves_the_names_alone_and_the_caller_has_the_last_word() -> None:
    text = PENDULUM + "[copies]\ncount = 2\n"
    assert scene(text, copies=1) == scene(PENDULUM)
    assert [body.name for body in scene(PENDULUM, copies=2).bodies] == ["bar_1", "bar_2"]
