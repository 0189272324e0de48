"""The JSON schema agrees with the reader, and the examples with the schema."""

from __future__ import annotations

import json
import re
import tomllib
from importlib import resources

import pytest

from codegen.spec.scene_file.entries import kinds_of_tables
from codegen.spec.scene_file.entry import keys_of
from codegen.spec.scene_file.schema import schema_text

from .texts import EXAMPLES, ROOT, changed, refused, scene

jsonschema = pytest.importorskip("jsonschema")

SHIPPED = resources.files("codegen.spec").joinpath("scene.schema.json").read_text()
VALIDATOR = jsonschema.Draft202012Validator(json.loads(SHIPPED))
DOCUMENT = (ROOT / "docs" / "scene.md").read_text()
WORKED = re.findall(r"```toml\n(.*?)```", DOCUMENT, re.DOTALL)


def test_the_shipped_schema_is_the_one_that_the_reader_makes() -> None:
    assert schema_text() == SHIPPED, "run: make schema"
    jsonschema.Draft202012Validator.check_schema(json.loads(SHIPPED))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example_validates(path) -> None:
    VALIDATOR.validate(tomllib.loads(path.read_text()))


def test_the_worked_example_of_the_documentation_is_read_and_validates() -> None:
    whole = [text for text in WORKED if text.startswith("name = ")]
    assert whole
    for text in whole:
        assert scene(text).bodies
        VALIDATOR.validate(tomllib.loads(text))


def test_the_documentation_explains_every_key() -> None:
    for table in kinds_of_tables():
        for name in keys_of(table):
            assert re.search(rf"`[^`\n]*\b{name}\b[^`\n]*`", DOCUMENT), name


# Changes that both the reader and the schema refuse.
REFUSED = {
    "unknown key": ("mass = 1.5", "mass = 1.5\nmas = 1"),
    "no name": ('name = "pendulum"', ""),
    "no identifier": ('name = "pendulum"', 'name = "a-b"'),
    "text for a number": ("mass = 1.5", 'mass = "1.5"'),
    "two components": ("axis = [0.0, 0.0, 1.0]", "axis = [0.0, 1.0]"),
    "joint type": ('type = "revolute"', 'type = "hinge"'),
    "one body": ('bodies = ["ground", "bar"]', 'bodies = ["bar"]'),
    "inertia of two rows": ("inertia = [0.01, 0.2, 0.2]", "inertia = [[1, 0, 0], [0, 1, 0]]"),
    "drive without speed": ("axis = [0.0, 0.0, 1.0]", "axis = [0, 0, 1]\ndrive = { position = 0 }"),
    "drive with another key": (
        "axis = [0.0, 0.0, 1.0]",
        "axis = [0, 0, 1]\ndrive = { position = 0, speed = 1, x = 1 }",
    ),
    "no bodies": ("[[body]]", "[[bdy]]"),
    "copies": ("[[body]]", "[copies]\ncount = 0\n[[body]]"),
    "long name": ('name = "bar"', f'name = "{"b" * 61}"'),
}


@pytest.mark.parametrize("case", REFUSED)
def test_the_schema_refuses_what_the_reader_refuses(case: str) -> None:
    text = changed(REFUSED[case])
    assert refused(text)
    assert not VALIDATOR.is_valid(tomllib.loads(text))


def test_the_schema_takes_what_the_reader_takes() -> None:
    loaded = 'axis = [0, 0, 1]\ntorque = [1]\ndrive = [{}]\nlimit = { lower = -1, stiffness = 2 }\nform = "relative"'
    for change in (("mass = 1.5", "mass = 2"), ("axis = [0.0, 0.0, 1.0]", loaded)):
        text = changed(change)
        assert scene(text)
        VALIDATOR.validate(tomllib.loads(text))
