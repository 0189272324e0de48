"""Whatever stands in a scene file, the reader gives a scene or tells what is wrong: no other exception, no hang.

Sound files are broken at random: tokens are left out, doubled, exchanged, replaced by values of another type, by nasty
text or by monstrous numbers; keys and whole lines wander. ``JOINTGEN_FUZZ`` sets how many files are made.
"""

from __future__ import annotations

import functools
import os
import random
import re
import tomllib
from datetime import timedelta

import pytest
from hypothesis import HealthCheck, Phase, given, note, settings
from hypothesis import strategies as st

from codegen.errors import SpecificationError
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

from .texts import EXAMPLES, PENDULUM

FILES = int(os.environ.get("JOINTGEN_FUZZ", "1000"))
MANY = 10_000
AT_ONCE = 10
"""Files that are made of one drawn number; drawing takes as long as reading."""
DEADLINE = timedelta(seconds=5)

RICH = """\
name = "rich"
gravity = [0.0, -9.81, 0.0]
motion = "spatial"
assemble = true
copies = { count = 2, offset = [0.0, 0.0, 0.1] }
[[body]]
name = "arm"
mass = 1.5
inertia = [[0.01, 0.0, 0.0], [0.0, 0.2, 0.0], [0.0, 0.0, 0.2]]
position = [0.5, 0.0, 0.0]
quaternion = [0.6, 0.0, 0.0, 0.8]
[[joint]]
name = "tube"
type = "cylindrical"
bodies = ["ground", "arm"]
points = [[0.0, 0.0, 0.0], [-0.5, 0.0, 0.0]]
axes = [[0.0, 0.0, 1.0], [0.0, 0.0, 1.0]]
form = "parametric"
torque = [1.0, 2.0]
stiffness = [0.0, 4.0]
rest = [0.0, 0.25]
drive = [{}, { position = 0.0, speed = 6.25 }]
limit = [{ lower = -1.0, upper = 1.0, stiffness = 100.0, damping = 1.0 }, {}]
[[joint]]
name = "thread"
type = "screw"
bodies = ["arm", "ground"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
pitch = 0.01
[[spring]]
bodies = ["ground", "arm"]
points = [[0.0, 0.1, 0.0], [0.0, 0.0, 0.0]]
stiffness = 100.0
damping = 1.0
length = 0.1
[[torque]]
body = "arm"
vector = [0.0, 0.0, 1.0]
[[force]]
body = "arm"
vector = [2.0, 0.0, 0.0]
point = [0.1, 0.2, 0.0]
[output]
quantities = ["phi", "phi_q", "mass"]
rows = "table4"
derivative = "substituted"
"""
TEXTS = [PENDULUM, RICH, *(path.read_text() for path in EXAMPLES if path.stem == "spatial_slider_crank")]
TOKENS = [re.findall(r'"[^"\n]*"|[\w.+-]+|\n|[ \t]+|.', re.sub(r"#.*", "", text)) for text in TEXTS]
WORDS = sorted({token for tokens in TOKENS for token in tokens if re.fullmatch(r'"\w+"|[a-z_0-9]+', token)})


def is_toml(value: str) -> bool:
    """Whether a text may stand behind an equals sign."""
    try:
        tomllib.loads(f"x = {value}")
    except (ValueError, RecursionError):
        return False
    return True


NASTY = [
    '"x]; system(\\"rm -rf\\"); //"', '"a*/"', '"a\\nb"', '"\\u0000\\u001b[31m"', '"{{ 7*7 }}"', '"%s%n"', '"../../x"',
    '"ground"', '"é\\u202e漢字🙂"', '""', "''", '"""', "'''\n'''", f'"{"y" * 500}"', '"\ud7ff"', "\x00", "\r", "\ufeff",
    "\udc80",
]  # fmt: skip
NUMBERS = [
    "0", "-1", "1e-300", "1e300", "1e400", "-1e999999999", "1e-999999999", "1e99999999999999999999", "nan", "-inf",
    "9" * 40, "9" * 5000, "0x" + "f" * 5000, "1" + "_1" * 200, "0." + "0" * 99 + "1", "1e30", "1e-30", "-0.0", "3.0",
    "1.0", "7", "100000000",
]  # fmt: skip
SHAPES = [
    "true", "1979-05-27T07:32:00Z", "[]", "{}", "[[]]", "[1, 2]", "[0, 0, 0]", "[1e30, 1e-30, 1]", "[[1, 0], [0, 1]]",
    "{ a = 1 }", "[" * 80 + "]" * 80, "[" * 3000 + "]" * 3000, "[" * 3000, "{a=" * 3000, "[[body]]\n", "[[joint]]\n",
    "[body]\n", ".".join("a" * 150), ".".join("a" * 5000), "=", "\n", "#", ",", "[0, [1, \"x\", true]]",
]  # fmt: skip
KINDS = ("name", "gravity", "motion", "assemble", "copies", "mass", "inertia", "quaternion", "bodies", "points", "axes",
         "torque", "drive", "limit", "quantities")  # fmt: skip
VALUES = [value for value in (*NASTY, *NUMBERS, *SHAPES) if is_toml(value)]
ANY = [*NASTY, *NUMBERS, *SHAPES, *WORDS]


@functools.cache
def is_value(token: str) -> bool:
    """Whether a token is a number or a text, so that another value in its place is still TOML."""
    return bool(re.fullmatch(r'"[^"\n]*"|-?\d[\w.+-]*', token))


def replacement(chance: random.Random) -> str:
    """Something that stands where it should not, or digits and signs of no meaning."""
    if chance.random() < 0.8:
        return chance.choice(ANY)
    return "".join(chr(chance.choice([chance.randrange(32, 127), chance.randrange(0xD800)])) for _ in range(6))


def broken(chance: random.Random) -> str:
    """A sound file with one to five changes; most of them leave it TOML."""
    tokens = list(chance.choices(TOKENS, [2, 2, 1])[0])
    for _ in range(chance.choice([1, 1, 2, 3, 5])):
        place, length = chance.randrange(len(tokens) + 1), chance.choice([0, 1, 1, 1, 2, 5, 40])
        piece = tokens[place : place + length]
        change = chance.choices(["value", "exchange", "replace", "leave out", "double", "move"], [8, 3, 1, 1, 1, 1])[0]
        values = [k for k, token in enumerate(tokens) if is_value(token)]
        if change == "value" and values:
            tokens[chance.choice(values)] = chance.choice(VALUES)
        elif change == "exchange" and values:
            i, k = chance.choice(values), chance.choice(values)
            tokens[i], tokens[k] = tokens[k], tokens[i]
        elif change == "replace":
            tokens[place : place + length] = [replacement(chance)]
        elif change == "double":
            tokens[place:place] = piece
        elif change in ("leave out", "move"):
            del tokens[place : place + length]
            target = chance.randrange(len(tokens) + 1)
            tokens[target:target] = piece if change == "move" else []
    return "".join(tokens)


def check(text: str) -> None:
    """Read a text: a scene, or mistakes that each stand on one line of bounded length."""
    try:
        assert isinstance(read_scene(text, "scene.toml"), Scene)
    except SpecificationError as error:
        assert 1 <= len(error.mistakes) <= 101
        for line in map(str, error.mistakes):
            assert line.isprintable()
            assert line.startswith("scene.toml: ")
            assert len(line) <= 1000


def fuzz(count: int) -> None:
    """Read so many broken files; without shrinking, which would take longer than the search."""

    @settings(
        max_examples=count // AT_ONCE,
        deadline=DEADLINE,
        database=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(st.integers(0, 2**24 - 1))  # of more bits it would draw small numbers again and again
    def read(seed: int) -> None:
        chance = random.Random(seed)
        for _ in range(AT_ONCE):
            text = broken(chance)
            note(text)
            check(text)

    read()


@pytest.mark.parametrize("text", TEXTS)
def test_the_files_that_are_broken_are_sound(text: str) -> None:
    assert read_scene(text, "scene.toml").bodies


@pytest.mark.parametrize("value", [*NASTY, *NUMBERS, *SHAPES], ids=lambda value: ascii(value)[:20])
def test_every_value_may_be_replaced_by_any_other(value: str) -> None:
    """One by one, at one place of every kind."""
    lines = RICH.splitlines()
    for name in KINDS:
        k = next(k for k, line in enumerate(lines) if line.startswith(f"{name} = "))
        check("\n".join([*lines[:k], f"{name} = {value}", *lines[k + 1 :]]))


def test_a_broken_file_is_read_or_refused() -> None:
    fuzz(FILES)


@pytest.mark.slow
def test_ten_thousand_broken_files_are_read_or_refused() -> None:
    fuzz(MANY)
