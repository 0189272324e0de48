"""Chain files: what they say is read exactly, and every mistake in them is told with its remedy."""

from __future__ import annotations

import json
import math
import tomllib
from fractions import Fraction
from importlib import resources

import mpmath
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from codegen.errors import SpecificationError
from codegen.spec.angles import PI, cosine_and_sine, quarter_turns
from codegen.spec.chain_file import read_chain, schema_text
from codegen.spec.chain_file.angle import parsed
from codegen.spec.chain_motions import Polynomial
from tests.mechanics.chain.trees import EXAMPLES

jsonschema = pytest.importorskip("jsonschema")
SHIPPED = resources.files("codegen.spec").joinpath("chain.schema.json").read_text()
QUICK_RETURN = (EXAMPLES / "quick_return.toml").read_text()

SPRING = '[[spring]]\neffectors = ["tool", '
STOP = '[[stop]]\njoint = "crank"\nlower = 0.5\n'

MISTAKES = {
    "a link on itself": ('parent = "crank"', 'parent = "block"', "cannot hang on itself"),
    "a parent below": ('parent = "crank"', 'parent = "slider"', "stands below"),
    "a link called base": ('name = "pivot"', 'name = "base"', "is link 0"),
    "two links of a name": ('name = "pivot"', 'name = "crank"', "stands 2 times"),
    "a negative mass": ("mass = 1000.0", "mass = -1.0", "is -1 kg"),
    "an inertia of no body": ("[2000.0, 2000.0, 2000.0]", "[1.0, 1.0, 3.0]", "belongs to no body"),
    "an inertia below 0": ("[2000.0, 2000.0, 2000.0]", "[-1.0, 1.0, 1.0]", "has a negative principal value"),
    "a cut on an unknown link": ('far = { link = "pivot" }', 'far = { link = "pivt" }', 'did you mean "pivot"'),
    "a cut within one link": ('far = { link = "slide" }', 'far = { link = "base" }', "both frames stand on"),
    "no independent coordinate": ('[[independent]]\njoint = "crank"\npolynomial = [0.44, "2*pi"]', "", "independent"),
    "an unknown coordinate": ('[[independent]]\njoint = "crank"', '[[independent]]\njoint = "crak"', "no link"),
    "two motions": ('polynomial = [0.44, "2*pi"]', 'polynomial = [1.0]\ntable = "a.csv"', "give one motion"),
    "an unknown effector": ('effector = "tool"', 'effector = "tol"', 'did you mean "tool"'),
    "an empty range": ("lower = -4.0", "lower = 2.0", "is not below upper"),
    "no angle": ('theta = "pi/2" }', 'theta = "pi/0" }', "is no angle"),
    "an unknown key": ("a = 1.5", "b = 1.5", "there is no key"),
    "a screw without pitch": ('type = "prismatic"\nalpha', 'type = "screw"\nalpha', "give the advance in m/rad"),
    "a pitch of no screw": ('type = "prismatic"\nalpha', 'type = "prismatic"\npitch = 1\nalpha', "has no pitch"),
    "a spring to nowhere": ("[[independent]]", f'{SPRING}"tol"]\n[[independent]]', 'did you mean "tool"'),
    "a spring within one link": ("[[independent]]", f'{SPRING}"tool"]\n[[independent]]', "both ends are on"),
    "stops upside down": ("[[independent]]", f"{STOP}upper = -1\n[[independent]]", "is not below upper"),
    "a stop without stiffness": ("[[independent]]", f"{STOP}\n[[independent]]", "stiffness: is missing"),
    "a drive without motion": ('polynomial = [0.44, "2*pi"]', "driven = true", "has no motion"),
    "a drive with a start": (
        'polynomial = [0.44, "2*pi"]',
        "polynomial = [0.44]\ndriven = true",
        "starts with",
    ),
    "a ball joint": ('type = "prismatic"\nalpha', 'type = "ball"\nalpha', "write three revolute links whose axes meet"),
    "an unknown joint": ('type = "prismatic"\nalpha', 'type = "balls"\nalpha', "there is no"),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_a_mistake_is_told_with_its_place_and_remedy(case):
    old, new, words = MISTAKES[case]
    assert old in QUICK_RETURN
    with pytest.raises(SpecificationError) as caught:
        read_chain(QUICK_RETURN.replace(old, new, 1), "quick_return.toml")
    assert words in str(caught.value)
    for mistake in caught.value.mistakes:
        assert mistake.place.startswith("quick_return.toml")
        assert mistake.remedy


def test_a_link_that_nothing_holds_must_have_mass():
    text = QUICK_RETURN + '\n[[link]]\nname = "vane"\nparent = "slider"\ntype = "revolute"\n'
    with pytest.raises(SpecificationError, match="neither it nor what hangs on it has mass"):
        read_chain(text, "file")
    read_chain(text + "mass = 0.1\ninertia = [0.1, 0.1, 0.1]\n", "file")
    read_chain(text + '[output]\nquantities = ["J"]\n', "file")


@pytest.mark.parametrize("inertia", ["[0, 1.0, 1.0]", "[[0.5, 0.5, 0], [0.5, 0.5, 0], [0, 0, 1]]"])
def test_a_thin_rod_may_have_no_inertia_about_its_axis(inertia):
    chain = read_chain(QUICK_RETURN.replace("[2000.0, 2000.0, 2000.0]", inertia), "file")
    assert chain.links[0].inertia[2][2] == 1


@pytest.mark.parametrize("inertia", ["[0, 0, 2000.0]", "[0.066, 0.086, 0.0125]"])
def test_an_effective_inertia_need_not_be_that_of_a_body(inertia):
    text = QUICK_RETURN.replace("[2000.0, 2000.0, 2000.0]", inertia)
    with pytest.raises(SpecificationError, match="effective = true"):
        read_chain(text, "file")
    assert read_chain(text.replace(inertia, f"{inertia}\neffective = true"), "file").links[0].inertia[0][1] == 0


def test_rounding_of_the_program_that_wrote_a_file_is_nothing():
    text = QUICK_RETURN.replace("[2000.0, 2000.0, 2000.0]", "[[2, 0, 1.3e-33], [0, 2, 0], [1.3e-33, 0, 2]]")
    chain = read_chain(text.replace('alpha = "-pi/2"', "alpha = -4.3e-35", 1), "file")
    assert chain.links[2].row.alpha == 0 and chain.links[0].inertia[0][2] == 0
    for size in ("1e31", "nan", "-inf"):
        with pytest.raises(SpecificationError, match="out of range"):
            read_chain(QUICK_RETURN.replace('alpha = "-pi/2"', f"alpha = {size}", 1), "file")


def test_a_cut_on_an_unknown_link_is_told_alone():
    text = QUICK_RETURN.replace('far = { link = "slide" }', 'far = { link = "slid" }')
    with pytest.raises(SpecificationError) as caught:
        read_chain(text, "file")
    assert len(caught.value.mistakes) == 1


def test_the_quick_return_is_read_exactly():
    chain = read_chain(QUICK_RETURN, "file")
    assert [link.name for link in chain.links] == ["crank", "block", "rocker", "coupler", "slider", "pivot", "slide"]
    assert chain.links[0].coordinate == Fraction("0.44")
    assert chain.links[2].row.alpha == -PI / 2
    assert chain.independents[0].motion == Polynomial((Fraction("0.44"), 2 * PI))
    (force,) = chain.effector_forces
    assert force.when is not None
    assert (force.when.lower, force.when.upper, force.when.direction) == (-4, Fraction("1.2"), -1)


@pytest.mark.parametrize(
    ("text", "turns"),
    [
        ("pi", 0.5),
        ("-pi/2", -0.25),
        ("2*pi/3", 1 / 3),
        ("+ 3 pi", 1.5),
        ("0.5 pi", 0.25),
        ("30 deg", 1 / 12),
        ("-90deg", -0.25),
    ],
)
def test_angles_are_multiples_of_pi_or_degrees(text, turns):
    found = parsed(text)
    assert found is not None
    assert float(found) == pytest.approx(turns * 2 * math.pi, rel=1e-15)


@settings(max_examples=50, deadline=None)
@given(st.fractions(-20, 20, max_denominator=10**6))
def test_cosines_and_sines_are_right_to_forty_digits(angle):
    if quarter_turns(angle) not in (None, 0):
        return
    with mpmath.workdps(60):
        exact = mpmath.mpf(angle.numerator) / angle.denominator
        for found, truth in zip(cosine_and_sine(angle), (mpmath.cos(exact), mpmath.sin(exact)), strict=True):
            allowed = 1e-9 if quarter_turns(angle) == 0 else 1e-40
            assert abs(mpmath.mpf(found.numerator) / found.denominator - truth) < allowed


@pytest.mark.parametrize("quarters", range(-5, 6))
def test_sixteen_digits_of_a_right_angle_mean_a_right_angle(quarters):
    cosine, sine = cosine_and_sine(Fraction(quarters * math.pi / 2))
    assert (cosine, sine) == [(1, 0), (0, 1), (-1, 0), (0, -1)][quarters % 4]


def test_the_shipped_schema_is_the_one_that_the_reader_makes():
    assert schema_text() == SHIPPED, "run: make schema"


@pytest.mark.parametrize("name", ["quick_return", "spatial_slider_crank"])
def test_every_example_validates(name):
    jsonschema.Draft202012Validator(json.loads(SHIPPED)).validate(
        tomllib.loads((EXAMPLES / f"{name}.toml").read_text())
    )
