"""The text of a scene, parsed by a TOML parser, holds the scene."""

from __future__ import annotations

import tomllib
from decimal import Decimal
from fractions import Fraction
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from codegen.errors import SpecificationError
from codegen.spec.placement import IDENTITY, marker, rotation
from codegen.spec.scene import (
    GROUND,
    ZERO_VECTOR,
    Body,
    Coordinate,
    Drive,
    Force,
    Joint,
    Limit,
    Scene,
    Spring,
    Torque,
    Wanted,
)
from codegen.spec.scene_text import write_scene

EXAMPLES = Path(__file__).parents[2] / "examples"
ONE, NOUGHT = Fraction(1), Fraction(0)
DIAGONAL = ((ONE, NOUGHT, NOUGHT), (NOUGHT, ONE, NOUGHT), (NOUGHT, NOUGHT, ONE))


def parsed(scene: Scene):
    return tomllib.loads(write_scene(scene), parse_float=lambda text: Fraction(Decimal(text)))


def block(name: str = "a", mass: Fraction = ONE, quaternion=(ONE, NOUGHT, NOUGHT, NOUGHT)) -> Body:
    return Body(name, mass, DIAGONAL, (ONE, NOUGHT, NOUGHT), quaternion)


def joint(kind: str, *coordinates: Coordinate, axes=IDENTITY, quaternion=(ONE, NOUGHT, NOUGHT, NOUGHT)) -> Joint:
    markers = (
        marker(ZERO_VECTOR, axes, position, attitude)
        for position, attitude in ((ZERO_VECTOR, IDENTITY), ((ONE, NOUGHT, NOUGHT), rotation(quaternion)))
    )
    return Joint("pin", kind, (GROUND, "a"), *markers, coordinates=coordinates)


def scene(*joints: Joint, bodies=None, **more) -> Scene:
    return Scene("s", (NOUGHT, NOUGHT, Fraction("-9.81")), bodies or (block(),), joints, **more)


@given(st.fractions())
def test_a_number_keeps_its_decimals_or_19_digits(value):
    written = parsed(scene(bodies=(block(mass=value or ONE),)))["body"][0]["mass"]
    assert abs(written - (value or ONE)) <= abs(value or ONE) / 10**19


@given(st.decimals(allow_nan=False, allow_infinity=False, min_value=-(10**9), max_value=10**9, places=15))
def test_a_decimal_is_written_as_it_is(value):
    exact = Fraction(value) or ONE
    assert parsed(scene(bodies=(block(mass=exact),)))["body"][0]["mass"] == exact


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_any_name_is_kept(name):
    assert parsed(scene(bodies=(block(name),)))["body"][0]["name"] == name


def test_all_that_a_scene_holds_is_written():
    limit = Limit(None, Fraction(2), Fraction(30), Fraction("0.4"))
    coordinates = (
        Coordinate(torque=Fraction(5), limit=limit),
        Coordinate(drive=Drive(NOUGHT, Fraction("6.28"), ONE, Fraction(3))),
    )
    whole = scene(
        joint("cylindrical", *coordinates),
        springs=(Spring((GROUND, "a"), ((ONE, NOUGHT, ONE), ZERO_VECTOR), Fraction(100), ONE, Fraction("0.1")),),
        torques=(Torque("a", (NOUGHT, ONE, NOUGHT)),),
        forces=(Force("a", (ONE, NOUGHT, NOUGHT)), Force("a", (ONE, ONE, NOUGHT), (NOUGHT, NOUGHT, ONE))),
        motion="planar",
        wanted=Wanted(("phi",), "table4"),
    )
    assert parsed(whole) == {
        "name": "s",
        "gravity": [0, 0, Fraction("-9.81")],
        "motion": "planar",
        "body": [{"name": "a", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0], "quaternion": [1, 0, 0, 0]}],
        "joint": [
            {
                "name": "pin",
                "type": "cylindrical",
                "bodies": ["ground", "a"],
                "points": [[0, 0, 0], [-1, 0, 0]],
                "axes": [[0, 0, 1], [0, 0, 1]],
                "torque": [5, 0],
                "drive": [{}, {"position": 0, "speed": Fraction("6.28"), "amplitude": 1, "frequency": 3}],
                "limit": [{"upper": 2, "stiffness": 30, "damping": Fraction("0.4")}, {}],
            }
        ],
        "spring": [
            {
                "bodies": ["ground", "a"],
                "points": [[1, 0, 1], [0, 0, 0]],
                "stiffness": 100,
                "damping": 1,
                "length": Fraction("0.1"),
            }
        ],
        "torque": [{"body": "a", "vector": [0, 1, 0]}],
        "force": [{"body": "a", "vector": [1, 0, 0]}, {"body": "a", "vector": [1, 1, 0], "point": [0, 0, 1]}],
        "output": {"quantities": ["phi"], "rows": "table4", "derivative": "exact"},
    }


QUARTER = (Fraction(1), NOUGHT, NOUGHT, Fraction(1))


@pytest.mark.parametrize(
    ("kind", "coordinates", "keys"),
    [
        ("revolute", [Coordinate()], {"points", "axes"}),
        ("revolute", [Coordinate(damping=ONE, torque=ONE)], {"points", "axes"}),
        ("revolute", [Coordinate(stiffness=ONE)], {"point", "axis"}),
        ("translational", [Coordinate()], {"point", "axis"}),
        ("rigid", [], {"point", "axis"}),
        ("ball", [], {"points"}),
        ("universal", [], {"points", "axes"}),
        ("universal", [Coordinate(damping=ONE), Coordinate()], {"point", "axis", "axis2"}),
    ],
)
def test_world_axes_are_written_only_where_the_frames_must_agree_about_the_axis(kind, coordinates, keys):
    turned = scene(joint(kind, *coordinates, quaternion=QUARTER), bodies=(block(quaternion=QUARTER),))
    (written,) = parsed(turned)["joint"]
    assert written.keys() & {"point", "points", "axis", "axes", "axis2"} == keys
    if "points" in keys:
        assert written["points"] == [[0, 0, 0], [0, 1, 0]]
    else:
        assert written["point"] == [0, 0, 0] and written["axis"] == [0, 0, 1]


def test_the_axes_of_a_universal_joint_are_h_of_the_first_and_f_of_the_second_body():
    turned = scene(joint("universal", quaternion=QUARTER), bodies=(block(quaternion=QUARTER),))
    (written,) = parsed(turned)["joint"]
    assert written["axes"] == [[0, 0, 1], [0, -1, 0]]


def test_directions_that_the_file_cannot_give_are_not_lost_in_silence():
    slanted = (
        (Fraction("0.6"), Fraction("-0.8"), NOUGHT),
        (Fraction("0.8"), Fraction("0.6"), NOUGHT),
        (NOUGHT, NOUGHT, ONE),
    )
    loads = (Coordinate(stiffness=ONE), Coordinate(), Coordinate())
    assert write_scene(scene(joint("planar", *loads)))
    with pytest.raises(SpecificationError, match="cannot give"):
        write_scene(scene(joint("planar", *loads, axes=slanted)))


def test_the_examples_are_written_whole():
    pytest.importorskip("mujoco")
    pytest.importorskip("defusedxml")
    from codegen.spec.mjcf import read_mjcf
    from codegen.spec.urdf import read_urdf

    for read, name in ((read_urdf, "robot.urdf"), (read_mjcf, "four_bar.xml")):
        imported = read((EXAMPLES / name).read_text(), name).scene
        assert write_scene(imported) == write_scene(read((EXAMPLES / name).read_text(), name).scene)
        tables = parsed(imported)
        for body, written in zip(imported.bodies, tables["body"], strict=True):
            assert written["mass"] == body.mass
            near = [
                *zip(written["position"], body.position, strict=True),
                *zip(written["quaternion"], body.quaternion, strict=True),
            ]
            assert all(abs(a - b) < Fraction(1, 10**18) for a, b in near)
        for joint_, written in zip(imported.joints, tables["joint"], strict=True):
            for point, marker_ in zip(written["points"], (joint_.marker_i, joint_.marker_j), strict=True):
                assert all(abs(a - b) < Fraction(1, 10**18) for a, b in zip(point, marker_.point, strict=True))
