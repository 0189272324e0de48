"""Platform files: what is read, and every mistake at once."""

from __future__ import annotations

import json
import tomllib
from fractions import Fraction
from importlib import resources

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from codegen.errors import SpecificationError
from codegen.spec.platform import EULER_ORDERS, Platform
from codegen.spec.platform_file import read_platform
from codegen.spec.platform_file.schema import schema_text

HEXAPOD = """\
name = "hexapod"
base = [[1.0, 0.5, -0.5, -1.0, -0.5, 0.5], [0.0, 0.8, 0.8, 0.0, -0.8, -0.8], [0, 0, 0, 0, 0, 0]]
platform = [[0.5, 0.4, -0.2, -0.5, -0.2, 0.4], [0.2, 0.3, 0.5, 0.1, -0.5, -0.4], [0, 0, 0, 0, 0, 0]]

[home]
position = [0.0, 0.0, 1.0]
"""


def read(*changes: tuple[str, str]) -> Platform:
    text = HEXAPOD
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return read_platform(text, "p.toml")


def refused(*changes: tuple[str, str]) -> list[str]:
    with pytest.raises(SpecificationError) as caught:
        read(*changes)
    return [str(mistake) for mistake in caught.value.mistakes]


def test_lengths_come_out_in_metres_exactly() -> None:
    found = read(('name = "hexapod"', 'name = "hexapod"\nunit = "mm"'))
    assert found.base[1] == (Fraction(1, 2000), Fraction(1, 1250), 0)
    assert found.home.position == (0, 0, Fraction(1, 1000))


@pytest.mark.parametrize("order", EULER_ORDERS)
def test_euler_angles_are_those_of_scipy(order: str) -> None:
    angles = [0.3, -1.1, 2.5]
    pose = read(("1.0]\n", f'1.0]\neuler = "{order}"\nangles = {angles}\n')).home
    expected = Rotation.from_euler(order, angles).as_matrix()
    assert np.abs(np.array(pose.rotation, dtype=float) - expected).max() < 1e-15


def test_quarter_turns_are_exact() -> None:
    pose = read(("1.0]\n", '1.0]\neuler = "ZYX"\nangles = [1.5707963267948966, 0, 0]\n')).home
    assert pose.rotation == ((0, -1, 0), (1, 0, 0), (0, 0, 1))


def test_all_mistakes_are_told_at_once() -> None:
    found = refused(
        ('name = "hexapod"', 'name = "hexa pod"\nunit = "mmm"\ncolour = "red"'),
        ("[0.5, 0.4, -0.2, -0.5, -0.2, 0.4]", "[0.5, 0.4, -0.2, -0.5, -0.2]"),
        ("[0.2, 0.3, 0.5, 0.1, -0.5, -0.4], [0, 0, 0, 0, 0, 0]", "[0.2, 0.3, 0.5, 0.1, -0.5], [0, 0, 0, 0, 0]"),
        ("1.0]\n", "1.0]\nrotation = [[1, 0, 0], [0, 1.1, 0], [0, 0, 1]]\n"),
    )
    words = ("no C identifier", 'did you mean "mm"?', 'no key "colour"', "fewer than six", "not orthonormal")
    for part in words:
        assert sum(part in line for line in found) == 1, part
    assert len(found) == len(words)


WRONG = {
    "a leg of length zero": (("position = [0.0, 0.0, 1.0]", "position = [0.5, -0.2, 0]"), "leg 1 has length zero"),
    "one leg twice": (
        ("[0.5, 0.4, -0.2, -0.5, -0.2, 0.4], [0.2, 0.3,", "[0.5, 0.5, -0.2, -0.5, -0.2, 0.4], [0.2, 0.2,"),
        None,
    ),
    "joints on a line": (("[0.2, 0.3, 0.5, 0.1, -0.5, -0.4]", "[0, 0, 0, 0, 0, 0]"), "on one line"),
    "seven legs": (("-0.5, 0.5], [0.0, 0.8, 0.8, 0.0, -0.8, -0.8], [0, 0, 0, 0, 0, 0]",
                    "-0.5, 0.5, 0], [0.0, 0.8, 0.8, 0.0, -0.8, -0.8, 0], [0, 0, 0, 0, 0, 0, 0]"), "more than six"),
    "a reflection": (("1.0]\n", "1.0]\nrotation = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]\n"), "reflection"),
    "two attitudes": (("1.0]\n", "1.0]\nquaternion = [1, 0, 0, 0]\nrotation = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\n"),
                      "in one way"),
    "an order without angles": (("1.0]\n", '1.0]\neuler = "ZYX"\n'), "has no angles"),
    "an unknown order": (("1.0]\n", '1.0]\neuler = "ZYZX"\nangles = [0, 0, 0]\n'), 'there is no "ZYZX"'),
    "a quaternion that is none": (("1.0]\n", "1.0]\nquaternion = [0, 0, 0, 0]\n"), "squared norm 0"),
    "more than a variant offers": (
        ("1.0]\n", '1.0]\n[output]\nvariant = "values"\nquantities = ["Q1"]\n'), 'does not evaluate "Q1"'
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", [name for name in WRONG if WRONG[name][1]])
def test_what_is_wrong_is_refused_in_words(case: str) -> None:
    change, words = WRONG[case]
    found = refused(change)
    assert len(found) == 1 and words in found[0], found


def test_legs_that_share_both_joints_are_one_leg() -> None:
    same = ("[1.0, 0.5, -0.5, -1.0, -0.5, 0.5], [0.0, 0.8,", "[1.0, 1.0, -0.5, -1.0, -0.5, 0.5], [0.0, 0.0,")
    assert "coincident joints" in refused(same, WRONG["one leg twice"][0])[0]
    assert read(same), "legs may share one joint"


def test_the_shipped_schema_is_the_one_that_the_reader_makes() -> None:
    jsonschema = pytest.importorskip("jsonschema")
    shipped = resources.files("codegen.spec").joinpath("platform.schema.json").read_text()
    assert schema_text() == shipped, "run: make schema"
    jsonschema.Draft202012Validator(json.loads(shipped)).validate(tomllib.loads(HEXAPOD))
