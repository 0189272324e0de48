"""What importers refuse: everything wrong is told at once, with a remedy, and nothing else is opened or raised."""

from __future__ import annotations

import random
import sys

import pytest

from codegen.errors import SpecificationError
from codegen.spec.mjcf import read_mjcf
from codegen.spec.urdf import read_urdf
from tests.spec.test_mjcf import FOUR_BAR
from tests.spec.test_urdf import ARM, HINGE, LINK, robot

pytest.importorskip("mujoco")
pytest.importorskip("defusedxml")

BOMB = """<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;&a;&a;">]>"""
FILE = """<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/passwd">]>"""
HINGED = '<mujoco><worldbody><body name="a"><joint name="h"/>{0}</body></worldbody>{1}</mujoco>'
MASS = '<inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>'


def mistakes(read, text, **named) -> list[str]:
    with pytest.raises(SpecificationError) as caught:
        read(text, "x", **named)
    for mistake in caught.value.mistakes:
        assert mistake.remedy and "\n" not in str(mistake)
    return [str(mistake) for mistake in caught.value.mistakes]


@pytest.mark.parametrize("read", [read_urdf, read_mjcf])
@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("", "is no XML"),
        ("<robot", "is no XML"),
        ("<robot></mujoco>", "is no XML"),
        ("<robot>\x00</robot>", "is no XML"),
        (b"\xff\xfe\x00", "is no XML"),
        (b'<?xml version="1.0" encoding="none"?><robot/>', "encoding"),
        ("<robot>\ud800</robot>", "encoding"),
        ("<other/>", 'its first element is "other"'),
        (BOMB + "<robot>&b;</robot>", "entities"),
        (FILE + "<robot>&a;</robot>", "entities"),
        ("<mujoco>" * 5000 + "</mujoco>" * 5000, "deep"),
    ],
)
def test_what_is_no_file_of_its_kind_is_refused(read, text, what):
    (mistake,) = mistakes(read, text)
    assert what in mistake


def test_all_mistakes_of_a_robot_are_told_at_once():
    text = robot(
        *map(LINK.format, "abc"),
        LINK.format("c"),
        LINK.format("d").replace('value="2"', 'value="heavy"'),
        '<link name="e"><inertial><mass value="1"/></inertial></link>',
        "<link/>",
        HINGE.format("one", "revolut", "a", "b", ""),
        HINGE.format("two", "revolute", "a", "cc", '<axis xyz="0 0 0"/>'),
        HINGE.format("three", "revolute", "a", "d", '<origin xyz="1 2" rpy="1 2 1e999"/>'),
        HINGE.format("four", "prismatic", "a", "e", '<limit lower="2" upper="1"/><dynamics damping="-1"/>'),
    )
    told = mistakes(read_urdf, text)
    for part in (
        'link "c": the name stands 2 times',
        "link: 1 have no name",
        'link "d": mass: value: "heavy"',
        'link "e": inertial: inertia is missing',
        'joint "one": type: "revolut" is not known; did you mean "revolute"?',
        'joint "two": child: there is no link "cc"',
        'joint "two": axis: is zero',
        'joint "three": origin: xyz: "1 2" is not 3 numbers',
        'joint "three": origin: rpy',
        'joint "four": limit: lower is above upper',
        'joint "four": dynamics: damping: is negative',
    ):
        assert any(part in line for line in told), (part, told)


@pytest.mark.parametrize(
    ("parts", "what"),
    [
        ([], "has no link"),
        ([*map(LINK.format, "ab")], "several links that hang on none"),
        (
            [
                *map(LINK.format, "abc"),
                HINGE.format("1", "fixed", "a", "b", ""),
                HINGE.format("3", "fixed", "a", "c", ""),
                HINGE.format("2", "fixed", "b", "c", ""),
            ],
            'link "c": hangs on 2 joints',
        ),
        (
            [
                *map(LINK.format, "abc"),
                HINGE.format("1", "revolute", "b", "c", ""),
                HINGE.format("2", "revolute", "c", "b", ""),
            ],
            'in a circle: "b", "c"',
        ),
        (
            [LINK.format("a"), '<link name="b"/>', HINGE.format("1", "revolute", "a", "b", "")],
            'link "b": moves and has no mass',
        ),
        (
            [
                LINK.format("a"),
                LINK.format("b").replace('iyy="0.2"', 'iyy="0.9"'),
                HINGE.format("1", "revolute", "a", "b", ""),
            ],
            "the inertia of no body",
        ),
        (
            [LINK.format("a"), LINK.format("ground"), HINGE.format("1", "revolute", "a", "ground", "")],
            "the name of what does not",
        ),
        (
            [LINK.format("a"), LINK.format("&#10;"), HINGE.format("1", "revolute", "a", "&#10;", "")],
            "signs that do not print",
        ),
        (['<xacro:macro xmlns:xacro="http://ros.org/xacro"/>'], "expand it first"),
        ([LINK.format("a").replace("<inertial>", '<inertial><origin quat="1 0 0 0"/>')], '"quat": is not known'),
    ],
)
def test_a_robot_that_is_no_mechanism_is_refused(parts, what):
    told = mistakes(read_urdf, robot(*parts))
    assert len(told) == 1 and what in told[0], told


def test_names_are_only_text():
    hostile = "x]; system(&quot;rm&quot;) a*/ \\ {{ name }}"
    text = robot(LINK.format("a"), LINK.format(hostile), HINGE.format("*/", "revolute", "a", hostile, ""))
    scene = read_urdf(text.replace('name="r"', f'name="{hostile}"'), "x").scene
    assert scene.bodies[0].name == 'x]; system("rm") a*/ \\ {{ name }}'
    assert scene.name == "x_system_rm_a_name"


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ('<mujoco><include file="/etc/passwd"/></mujoco>', "outside the folder"),
        ('<mujoco><include file="../secret.xml"/></mujoco>', "outside the folder"),
        ('<mujoco><include file="a\\..\\..\\secret.xml"/></mujoco>', "outside the folder"),
        ('<mujoco><include file="other.xml"/></mujoco>', "is missing"),
        ("<mujoco><worldbody><nonsense/></worldbody></mujoco>", "MuJoCo refuses it"),
        (HINGED.format("", ""), "mjMINVAL"),
        (HINGED.format(f'{MASS}<geom size="nan"/>', ""), "is no number"),
        (HINGED.format(MASS, '<asset><model name="m" file="/etc/passwd"/></asset>'), "is not read"),
        (HINGED.format(MASS, '<extension><plugin plugin="p"/></extension>'), "is not read"),
        (
            HINGED.format(f'{MASS}<replicate count="1000"><replicate count="1000"/></replicate>', ""),
            "more than 10000 copies",
        ),
        (HINGED.format('<geom type="mesh" mesh="m"/>', '<asset><mesh name="m" file="m.stl"/></asset>'), "is missing"),
        (HINGED.format('<geom type="mesh" mesh="m"/>', '<asset><mesh name="m" file="/m.stl"/></asset>'), "is missing"),
        (
            HINGED.format(f'{MASS}<joint type="slide" name="s" axis="1 0 0"/>', ""),
            'no joint of a scene together: hinge "h", slide "s"; put a body with a mass between them',
        ),
        (HINGED.format(MASS, '<equality><weld body1="a" relpose="0 0 .002 1 0 0 0"/></equality>'), "by 2 mm and 0 deg"),
        (
            HINGED.format(
                f'{MASS}<body name="b">{MASS}</body>',
                '<equality><connect body1="a" body2="b" anchor="0 0 0"/></equality>',
            ),
            'joins "a" to itself',
        ),
    ],
)
def test_a_model_that_is_no_mechanism_is_refused(text, what):
    told = mistakes(read_mjcf, text)
    assert len(told) == 1 and what in told[0], told


def test_a_missing_parser_is_named_with_its_remedy(monkeypatch):
    monkeypatch.setitem(sys.modules, "mujoco", None)
    assert "pip install 'jointgen[import]'" in mistakes(read_mjcf, "<mujoco/>")[0]
    monkeypatch.setitem(sys.modules, "defusedxml", None)
    assert "pip install 'jointgen[import]'" in mistakes(read_urdf, "<robot/>")[0]


def test_nothing_is_written_beside_the_model(tmp_path, monkeypatch, capfd):
    monkeypatch.chdir(tmp_path)
    mistakes(read_mjcf, HINGED.format(MASS, '<keyframe><key qpos="nan"/></keyframe>'))
    mistakes(read_mjcf, HINGED.format("", ""))
    read_mjcf(HINGED.format(MASS, ""), "x")
    assert not list(tmp_path.iterdir())
    assert capfd.readouterr() == ("", "")


WORDS = ['"', "<", "0", "e9", "-", " ", "\u0661", ">", "1e300", "nan", '"h"', "joint"]


@pytest.mark.parametrize("read", [read_urdf, read_mjcf])
@pytest.mark.parametrize("seed", range(150))
def test_a_damaged_file_is_read_or_refused(read, seed):
    generator = random.Random(seed)
    signs = list(ARM if read is read_urdf else FOUR_BAR)
    for _ in range(generator.randint(1, 4)):
        where = generator.randrange(len(signs))
        signs[where : where + generator.randint(0, 3)] = generator.choice(WORDS)
    try:
        read("".join(signs), "x")
    except SpecificationError as error:
        assert all(mistake.remedy and "\n" not in str(mistake) for mistake in error.mistakes)
