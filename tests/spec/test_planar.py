"""A scene that is to be reduced to the plane moves in one, or what forbids it is named."""

from __future__ import annotations

import pytest

from .texts import EXAMPLES, changed, refused, scene

FOUR_BAR = next(path for path in EXAMPLES if path.stem == "four_bar").read_text()
ENGINE = next(path for path in EXAMPLES if path.stem == "in_line_engine").read_text()
PLANAR_ENGINE = ENGINE.replace("gravity", 'motion = "planar"\ngravity', 1)
CYLINDER = "point = [0.4, 0.0, 0.0]\naxis = [1.0, 0.0, 0.0]"


def test_the_engine_and_the_four_bar_linkage_are_planar() -> None:
    assert scene(PLANAR_ENGINE).motion == "planar"
    assert scene(FOUR_BAR).motion == "planar"


def test_the_attitude_of_a_body_does_not_matter() -> None:
    """The engine with a rod whose own axes lie askew: the motion is what it was, in other body axes."""
    turned = changed(
        (
            "position = [0.25, 0.0, 0.0]\nquaternion = [1.0, 0.0, 0.0, 0.0]\nvelocity = [0.0, 0.75, 0.0]\n"
            "angular_velocity = [0.0, 0.0, -5.0]",
            "position = [0.25, 0.0, 0.0]\nquaternion = [0.5, 0.5, 0.5, 0.5]\nvelocity = [0.0, 0.75, 0.0]\n"
            "angular_velocity = [0.0, -5.0, 0.0]",
        ),
        text=PLANAR_ENGINE,
    )
    assert scene(turned).motion == "planar"


@pytest.mark.parametrize("type_", ["ball", "cylindrical", "universal", "screw"])
def test_a_joint_that_is_not_planar_is_named(type_: str) -> None:
    more = {"screw": "pitch = 0.1\n", "universal": "axis2 = [1, 0, 0]\n"}.get(type_, "")
    pin = 'name = "crank pin"\ntype = "revolute"'
    text = changed((pin, f"{more}{pin.replace('revolute', type_)}"), text=PLANAR_ENGINE)
    (line,) = refused(text)
    assert line.startswith(f'scene.toml: joint "crank pin": type: a {type_} joint is not planar; ')
    assert 'leave motion = "planar" out' in line


def test_axes_that_are_not_parallel_are_named() -> None:
    pin = "point = [0.1, 0.0, 0.0]\naxis = [0.0, 0.0, 1.0]"
    (line,) = refused(changed((pin, pin.replace("0.0, 1.0]", "1e-8, 1.0]")), text=PLANAR_ENGINE))
    assert line.startswith('scene.toml: joint "crank pin": its axis is not parallel to that of joint "main bearing"')


def test_a_slide_out_of_the_plane_is_named() -> None:
    (line,) = refused(changed((CYLINDER, CYLINDER.replace("[1.0, 0.0, 0.0]", "[1.0, 0.0, 0.1]")), text=PLANAR_ENGINE))
    assert line.startswith('scene.toml: joint "cylinder": it does not move perpendicularly to the axis of joint "main')


def test_velocities_out_of_the_plane_are_named() -> None:
    text = changed(("[0.0, 0.0, 15.0]", "[0.0, 1.0, 15.0]"), text=PLANAR_ENGINE).replace(
        "velocity = [0.0, 0.75, 0.0]", "velocity = [0.0, 0.75, 0.1]", 1
    )
    places = [line.split(": leaves")[0].split(": is not")[0] for line in refused(text)]
    assert places == ['scene.toml: body "crank": velocity', 'scene.toml: body "crank": angular_velocity']


def test_two_directions_of_sliding_span_the_plane() -> None:
    bodies = "".join(f'[[body]]\nname = "{n}"\nmass = 1\ninertia = [1, 1, 1]\n' for n in "abc")
    slides = "".join(
        f'[[joint]]\nname = "{n}"\ntype = "translational"\nbodies = ["ground", "{n}"]\npoint = [0, 0, 0]\n'
        f"axis = {axis}\n"
        for n, axis in zip("abc", ("[1, 0, 0]", "[0, 1, 0]", "[1, 1, 1]"), strict=True)
    )
    (line,) = refused(f'name = "x"\nmotion = "planar"\n{bodies}{slides}')
    assert line.startswith('scene.toml: joint "c": it does not move perpendicularly to the axis of the plane of joints')
