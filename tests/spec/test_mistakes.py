"""Every mistake in a scene file is told with its place, the unit and the remedy, and all of a file are told at once."""

from __future__ import annotations

import pytest

from .texts import PENDULUM, changed, joined, refused, scene

NAME, MASS, INERTIA = 'name = "pendulum"', "mass = 1.5", "inertia = [0.01, 0.2, 0.2]"
TURN, AXIS, POINT = "quaternion = [1.0, 0.0, 0.0, 0.0]", "axis = [0.0, 0.0, 1.0]", "point = [0.0, 0.0, 0.0]"
TYPE, BODIES = 'type = "revolute"', 'bodies = ["ground", "bar"]'

# What is changed in the pendulum, and what the one line must begin with and hold.
ONE = {
    "no name": ((NAME, ""), "scene.toml: name: is missing", "C identifier"),
    "no identifier": ((NAME, 'name = "2x"'), 'scene.toml: name: "2x" is no C identifier', "no digit first"),
    "keyword": ((NAME, 'name = "while"'), 'scene.toml: name: "while" is a keyword of C', '"while_scene"'),
    "keyword of C++": ((NAME, 'name = "class"'), 'scene.toml: name: "class" is a keyword', '"class_scene"'),
    "long name": ((NAME, f'name = "{"x" * 41}"'), "scene.toml: name: ", "at most 40"),
    "letters of other alphabets": ((NAME, 'name = "é"'), "scene.toml: name: ", "no C identifier"),
    "unknown key": ((NAME, NAME + "\ngravty = [0, 0, 0]"), 'scene.toml: there is no key "gravty"', '"gravity"'),
    "unknown key of a body": ((MASS, MASS + "\nmas = 1"), 'scene.toml: body "bar": there is no key "mas"', '"mass"'),
    "motion": ((NAME, NAME + '\nmotion = "plane"'), 'scene.toml: motion: there is no "plane"', '"planar"'),
    "gravity": (("gravity = [0.0, -9.81, 0.0]", "gravity = [9.81]"), "scene.toml: gravity: has 1 entries", "list of 3"),
    "no mass": ((MASS, ""), 'scene.toml: body "bar": has no mass', "kg, or ask for kinematic quantities only (phi, "),
    "no inertia": ((INERTIA, ""), 'scene.toml: body "bar": has no inertia', "kg m^2"),
    "mass 0": ((MASS, "mass = 0"), 'scene.toml: body "bar": mass: is 0 kg', "above 0 kg"),
    "mass in words": ((MASS, 'mass = "1 kg"'), 'scene.toml: body "bar": mass: is the text "1 kg"', "number in kg"),
    "mass true": ((MASS, "mass = true"), 'scene.toml: body "bar": mass: is true, not a number', "number in kg"),
    "mass nan": ((MASS, "mass = nan"), 'scene.toml: body "bar": mass: "nan" is out of range', "1e-30 to 1e30"),
    "mass inf": ((MASS, "mass = inf"), 'scene.toml: body "bar": mass: "inf" is out of range', "kg"),
    "huge mass": ((MASS, "mass = 1e400"), 'scene.toml: body "bar": mass: "1e400" is out of range', "kg"),
    "monstrous mass": ((MASS, "mass = 1e999999999"), 'scene.toml: body "bar": mass: "1e999999999" is', "kg"),
    "tiny mass": ((MASS, "mass = 1e-31"), 'scene.toml: body "bar": mass: "1e-31" is out of range', "kg"),
    "whole monster": ((MASS, "mass = 1" + "0" * 31), 'scene.toml: body "bar": mass: ', "beyond 1e30"),
    "mass of a date": ((MASS, "mass = 1979-05-27"), 'scene.toml: body "bar": mass: is a date or time', "kg"),
    "skew inertia": (
        (INERTIA, "inertia = [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]"),
        'scene.toml: body "bar": inertia: is not symmetric: two entries differ by 0.1 kg m^2',
        "equal entries",
    ),
    "flat inertia": (
        (INERTIA, "inertia = [0, 1, 1]"),
        'scene.toml: body "bar": inertia: is not positive',
        "0, 1, 1 kg",
    ),
    "indefinite inertia": (
        (INERTIA, "inertia = [[1, 2, 0], [2, 1, 0], [0, 0, 1]]"),
        'scene.toml: body "bar": inertia: is not positive definite: principal values -1, 1, 3 kg m^2',
        "above 0",
    ),
    "inertia of no body": (
        (INERTIA, "inertia = [[2, 1, 0], [1, 2, 0], [0, 0, 1]]"),
        'scene.toml: body "bar": inertia: belongs to no body: principal values 1, 1, 3 kg m^2',
        "sum of the others",
    ),
    "long quaternion": (
        (TURN, "quaternion = [3, 0, 0, 4]"),
        'scene.toml: body "bar": quaternion: has norm 5, not 1',
        "normalised it is [0.6, 0.0, 0.0, 0.8]",
    ),
    "quaternion off by 2e-9": ((TURN, "quaternion = [1.000000002, 0, 0, 0]"), 'scene.toml: body "bar": quat', "1.0000"),
    "no quaternion": ((TURN, "quaternion = [0, 0, 0, 0]"), 'scene.toml: body "bar": quaternion: has norm 0', "[1, 0"),
    "two components": (
        ("position = [0.5, 0.0, 0.0]", 'position = [0.5, "x", 0.0]'),
        'scene.toml: body "bar": position: component 2: is the text "x", not a number',
        "number in m",
    ),
    "joint type": ((TYPE, 'type = "revolut"'), 'scene.toml: joint "pin": type: there is no "revolut"', '"revolute"'),
    "no joint type": ((TYPE, ""), 'scene.toml: joint "pin": type: is missing', "revolute, translational"),
    "unknown body": ((BODIES, 'bodies = ["ground", "baar"]'), 'scene.toml: joint "pin": bodies: there is', '"bar"'),
    "same body": ((BODIES, 'bodies = ["bar", "bar"]'), 'scene.toml: joint "pin": bodies: both are "bar"', "different"),
    "two grounds": (
        (BODIES, 'bodies = ["ground", "ground"]'),
        'scene.toml: joint "pin": bodies: both are the ',
        "diff",
    ),
    "one body": ((BODIES, 'bodies = ["bar"]'), 'scene.toml: joint "pin": bodies: has 1 entries', "list of 2"),
    "no point": ((POINT, ""), 'scene.toml: joint "pin": point: is missing', "in m, world"),
    "no axis": ((AXIS, ""), 'scene.toml: joint "pin": axis: is missing', "world axes"),
    "zero axis": ((AXIS, "axis = [0, 0, 0]"), 'scene.toml: joint "pin": axis: is zero', "any length"),
    "axis2": ((AXIS, AXIS + "\naxis2 = [1, 0, 0]"), 'scene.toml: joint "pin": axis2: a revolute joint has one', "out"),
    "pitch": ((AXIS, AXIS + "\npitch = 0.1"), 'scene.toml: joint "pin": pitch: a revolute joint has no', "screw"),
    "mixed": ((AXIS, "axes = [[0, 0, 1], [0, 0, 1]]"), 'scene.toml: joint "pin": mixes point in world', "points and"),
    "form": (
        (AXIS, AXIS + '\nform = "implicit"'),
        'scene.toml: joint "pin": form: there is no "implicit"',
        "known: auto",
    ),
    "two torques": (
        (AXIS, AXIS + "\ntorque = [1, 2]"),
        'scene.toml: joint "pin": torque: has 2 entries for 1 ',
        "in rad",
    ),
    "loaded conventional": (
        (AXIS, AXIS + '\nform = "conventional"\ntorque = 1.0'),
        'scene.toml: joint "pin": torque: acts on the joint coordinate, which the conventional form does not have',
        "use form auto or parametric",
    ),
    "negative spring": ((AXIS, AXIS + "\nstiffness = -1"), 'scene.toml: joint "pin": stiffness: is -1', "0 or more"),
    "rest alone": ((AXIS, AXIS + "\nrest = 1"), 'scene.toml: joint "pin": rest: there is no spring', "give stiffness"),
    "drive": ((AXIS, AXIS + "\ndrive = { speed = 1 }"), 'scene.toml: joint "pin": drive: position: is missing', "rad"),
    "sine without frequency": (
        (AXIS, AXIS + "\ndrive = { position = 0, speed = 1, amplitude = 1 }"),
        'scene.toml: joint "pin": drive: amplitude: there is no frequency',
        "rad/s",
    ),
    "phase without sine": (
        (AXIS, AXIS + "\ndrive = { position = 0, speed = 1, phase = 1 }"),
        'scene.toml: joint "pin": drive: phase: there is no amplitude',
        "leave phase out",
    ),
    "sine that starts elsewhere": (
        (AXIS, AXIS + "\ndrive = { position = 0, speed = 1, amplitude = 1, frequency = 1, phase = 0.5 }"),
        'scene.toml: joint "pin": drive: does not close at t = 0: position with the sine is 0.479425539 rad',
        "correct position",
    ),
    "no drive": ((AXIS, AXIS + "\ndrive = 1"), 'scene.toml: joint "pin": drive: is a number, not a table', "table"),
    "limit": ((AXIS, AXIS + "\nlimit = { stiffness = 1 }"), 'scene.toml: joint "pin": limit: has neither', "at least"),
    "limit upside down": (
        (AXIS, AXIS + "\nlimit = { lower = 1, upper = 0.5, stiffness = 1 }"),
        'scene.toml: joint "pin": limit: lower, 1, is not below upper, 0.5',
        "lower < upper",
    ),
    "quantity": (
        ("[[body]]", '[output]\nquantities = ["phi_a"]\n[[body]]'),
        "scene.toml: output: quantities: ",
        "phi_q",
    ),
    "rows": (
        ("[[body]]", '[output]\nrows = "table5"\n[[body]]'),
        'scene.toml: output: rows: there is no "table5"',
        "4",
    ),
    "copies": (("[[body]]", "[copies]\ncount = 0\n[[body]]"), "scene.toml: copies: count: is out of range", "10000"),
    "fewer than whole copies": (
        ("[[body]]", "[copies]\ncount = 1.5\n[[body]]"),
        "scene.toml: copies: count: is a",
        "1 to",
    ),
    "flag": ((NAME, NAME + "\nassemble = 1"), "scene.toml: assemble: is a number", "true or false"),
    "torque on nothing": (
        ("[[joint]]", '[[torque]]\nbody = "rod"\nvector = [0, 0, 1]\n[[joint]]'),
        'scene.toml: torque 1: body: there is no body "rod"',
        "bar",
    ),
    "torque on the ground": (
        ("[[joint]]", '[[torque]]\nbody = "ground"\nvector = [0, 0, 1]\n[[joint]]'),
        "scene.toml: torque 1: body: a torque on the ground",
        "name a body",
    ),
    "force on nothing": (
        ("[[joint]]", '[[force]]\nbody = "rod"\nvector = [0, 0, 1]\n[[joint]]'),
        'scene.toml: force 1: body: there is no body "rod"',
        "bar",
    ),
    "force on the ground": (
        ("[[joint]]", '[[force]]\nbody = "ground"\nvector = [0, 0, 1]\n[[joint]]'),
        "scene.toml: force 1: body: a force on the ground",
        "name a body",
    ),
    "force without direction": (
        ("[[joint]]", '[[force]]\nbody = "bar"\npoint = [0, 0, 1]\n[[joint]]'),
        "scene.toml: force 1: vector: is missing",
        "in N",
    ),
    "syntax": ((NAME, "name ="), "scene.toml: is no TOML: Invalid value (at line 1, ", "toml.io"),
    "deep": ((NAME, "name = " + "[" * 5000 + "]" * 5000), "scene.toml: is nested too deeply", "three levels"),
    "long key": ((NAME, ".".join("a" * 300) + " = 1"), "scene.toml: line 1: has more than 200 points", "several lines"),
    "long integer": ((NAME, "name = 1" + "0" * 5000), "scene.toml: is no TOML: ", "syntax"),
}

# Names of the body, and what the one line must begin with and hold.
NAMES = {
    "ground": ("ground", 'body "ground": name: "ground" is the body that does not move', "another name"),
    "empty": ("", "body 1: name: has 0 signs", "1 to 60"),
    "blank": ("  ", 'body "  ": name: is blank', "letters or digits"),
    "control sign": ("b\\nr", 'body "b\\nr": name: "b\\nr" holds signs that do not print', "leave them out"),
    "escape": ("\\u001b[31m", 'body "\\x1b[31m": name: "\\x1b[31m" holds signs that do not', "leave them out"),
    "long": ("b" * 61, f'body "{"b" * 60}…": name: has 61 signs', "1 to 60"),
}

# Joints between two bars.
JOINTS = {
    "screw without pitch": ('type = "screw"\npoint = [0,0,0]\naxis = [0,0,1]', "pitch: is missing", "m/rad"),
    "screw of pitch 0": ('type = "screw"\npoint = [0,0,0]\naxis = [0,0,1]\npitch = 0', "pitch: is 0 m/rad", "revolute"),
    "universal with one axis": (
        'type = "universal"\npoint = [0,0,0]\naxis = [0,0,1]',
        "axis2: is missing",
        "second body",
    ),
    "skew universal": (
        'type = "universal"\npoint = [0,0,0]\naxis = [0,0,1]\naxis2 = [1,0,1]',
        "axis2: stands at 45 degrees to axis, not at 90",
        "is [1.0, 0.0, 0.0]",
    ),
    "skew by 1e-8": (
        'type = "universal"\npoint = [0,0,0]\naxis = [0,0,1]\naxis2 = [1,0,1e-8]',
        "axis2: stands at 89.9999994 degrees",
        "is [1.0, 0.0, 0.0]",
    ),
    "parallel universal": (
        'type = "universal"\npoint = [0,0,0]\naxis = [0,0,2]\naxis2 = [0,0,-1]',
        "axis2: stands at 180 degrees to axis",
        "is [0.0, 1.0, 0.0]",
    ),
    "axes without points": ('type = "revolute"\naxes = [[0,0,1],[0,0,1]]', "points: is missing", "in m, body axes"),
    "points without axes": ('type = "revolute"\npoints = [[1,0,0],[0,0,0]]', "axes: is missing", "axes of both bodies"),
    "zero in axes": (
        'type = "revolute"\npoints = [[1,0,0],[0,0,0]]\naxes = [[0,0,1],[0,0,0]]',
        "axes: entry 2: is zero",
        "any length",
    ),
    "torque of a rigid joint": ('type = "rigid"\npoint = [0,0,0]\ntorque = 1', "torque: a rigid joint has no", "leave"),
    "one torque of two": (
        'type = "cylindrical"\npoint = [0,0,0]\naxis = [0,0,1]\ntorque = 1',
        "torque: has 1 entry for 2 degrees of freedom",
        "in m, rad",
    ),
    "one drive of three": (
        'type = "planar"\npoint = [0,0,0]\naxis = [0,0,1]\ndrive = { position = 0, speed = 1 }',
        "drive: has 1 entry for 3 degrees of freedom",
        "in m, m, rad, {} for none",
    ),
    "wrong torque of two": (
        'type = "cylindrical"\npoint = [0,0,0]\naxis = [0,0,1]\ntorque = [1, "2"]',
        'torque: entry 2: is the text "2"',
        "give a number",
    ),
}

SPRINGS = {
    "unknown body": ('bodies = ["ground", "bart"]\npoints = [[0,0,0],[0,0,0]]', "bodies: there is no body", '"bar"'),
    "negative damping": (
        'bodies = ["ground", "bar"]\npoints = [[0,1,0],[0,0,0]]\ndamping = -1',
        "damping: is -1 N s/m",
        "0 N s/m or more",
    ),
    "no direction": (
        'bodies = ["ground", "bar"]\npoints = [[0,0,0],[-0.5,0,0]]\nstiffness = 1\nlength = 0.1',
        "points: its ends coincide at t = 0, where its force has no direction",
        "length = 0 m",
    ),
    "no points": ('bodies = ["ground", "bar"]', "points: is missing", "in m, body axes"),
}


@pytest.mark.parametrize("case", ONE)
def test_a_mistake_is_told_in_one_line_with_its_place_and_remedy(case: str) -> None:
    change, start, remedy = ONE[case]
    (line,) = refused(changed(change))
    assert line.startswith(start)
    assert remedy in line


@pytest.mark.parametrize("case", NAMES)
def test_a_name_of_a_body_that_cannot_be_used_is_told(case: str) -> None:
    name, start, remedy = NAMES[case]
    lines = refused(PENDULUM.replace('"bar"', f'"{name}"'))
    assert lines[0].startswith(f"scene.toml: {start}")
    assert remedy in lines[0]
    assert len(lines) == 1 or case == "ground"


def test_bodies_under_single_brackets_are_told() -> None:
    assert "scene.toml: body: is a table; write [[body]] above each body" in refused(changed(("[[body]]", "[body]")))
    assert refused('name = "x"\nbody = []') == ["scene.toml: body: is empty; write [[body]] above each body"]
    assert refused('name = "x"')[0].startswith("scene.toml: body: is missing")


@pytest.mark.parametrize("case", JOINTS)
def test_a_mistake_in_a_joint_of_another_type_is_told(case: str) -> None:
    text, what, remedy = JOINTS[case]
    (line,) = refused(joined(text))
    assert line.startswith(f'scene.toml: joint "pin": {what}')
    assert remedy in line


@pytest.mark.parametrize("case", SPRINGS)
def test_a_mistake_in_a_spring_is_told(case: str) -> None:
    text, what, remedy = SPRINGS[case]
    (line,) = refused(f"{PENDULUM}[[spring]]\n{text}\n")
    assert line.startswith(f"scene.toml: spring 1: {what}")
    assert remedy in line


def test_all_mistakes_of_a_file_are_told_at_once() -> None:
    text = changed(
        (NAME, 'name = "a*/"\nfoo = 1'),
        (MASS, "mass = -1"),
        (TURN, "quaternion = [2, 0, 0, 0]"),
        (AXIS, 'axis = [0, 0, 0]\nform = "x"'),
        (BODIES, 'bodies = ["ground", "beam"]'),
    )
    lines = refused(f'{text}[[spring]]\nbodies = ["bar", "bar"]\nstiffness = "x"\n[[torque]]\nvector = [1]\n')
    places = sorted(line.split(": ", 1)[1].rsplit("; ", 1)[0] for line in lines)
    starts = [
        'body "bar": mass: is -1',
        'body "bar": quaternion: has norm 2',
        'joint "pin": axis: is zero',
        'joint "pin": bodies: there is no body "beam"',
        'joint "pin": form: there is no "x"',
        'name: "a*/" is no C identifier',
        'spring 1: bodies: both are "bar"',
        "spring 1: points: is missing",
        "spring 1: stiffness: is the text",
        'there is no key "foo"',
        "torque 1: body: is missing",
        "torque 1: vector: has 1 entries",
    ]
    assert len(places) == len(starts)
    assert all(place.startswith(start) for place, start in zip(places, starts, strict=True))


def test_equal_names_are_told_once() -> None:
    text = (
        joined('type = "ball"\npoint = [0, 0, 0]')
        .replace('name = "b"', 'name = "a"')
        .replace('"a", "b"', '"a", "ground"')
    )
    assert refused(text) == ['scene.toml: body "a": the name stands 2 times; give each a name of its own']


def test_masses_may_be_missing_where_only_kinematic_quantities_are_asked_for() -> None:
    asked = '[output]\nquantities = ["phi", "phi_q", "gamma"]\n[[body]]'
    body = scene(changed((MASS, ""), (INERTIA, ""), ("[[body]]", asked))).bodies[0]
    assert body.mass == 0 and not any(value for row in body.inertia for value in row)
    forces = changed((MASS, ""), ("[[body]]", asked.replace('"gamma"', '"force"')))
    assert 'scene.toml: body "bar": has no mass' in refused(forces)[0]


def test_a_name_from_the_file_stays_on_one_line_and_short() -> None:
    nasty = "\\n".join(['x]; system(\\"rm\\")', "a*/", "\\u001b[31m", "y" * 500])
    lines = refused(changed(('name = "bar"', f'name = "{nasty}"')))
    assert any('x]; system(\\"rm\\")\\na*/\\n\\x1b[31m' in line for line in lines)
    assert all(len(line) < 500 for line in lines)


def test_the_list_of_mistakes_of_a_hopeless_file_is_cut() -> None:
    lines = refused(PENDULUM + "[[body]]\nnme = 1\n" * 200)
    assert len(lines) == 101
    assert lines[-1].startswith("scene.toml: there are ")


def test_the_names_that_a_long_list_offers_are_cut() -> None:
    bodies = "".join(f'[[body]]\nname = "body {k}"\nmass = 1\ninertia = [1, 1, 1]\n' for k in range(100))
    (line,) = refused(changed((BODIES, 'bodies = ["ground", "body 77x"]')) + bodies)
    assert 'did you mean "body 77"?' in line
    assert line.endswith("and 90 more")


def test_a_file_of_monstrous_size_is_refused() -> None:
    assert "use at most" in refused(PENDULUM + "#" * 2_000_000)[0]


def test_a_wrong_count_of_copies_from_outside_is_told() -> None:
    assert refused(PENDULUM, copies=0) == ["--copies: is out of range; give a whole number from 1 to 10000"]
