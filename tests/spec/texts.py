"""Texts of scene files for tests: a sound one, and changes to it."""

from __future__ import annotations

from pathlib import Path

import pytest

from codegen.errors import SpecificationError
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.toml"))

PENDULUM = """\
name = "pendulum"
gravity = [0.0, -9.81, 0.0]

[[body]]
name = "bar"
mass = 1.5
inertia = [0.01, 0.2, 0.2]
position = [0.5, 0.0, 0.0]
quaternion = [1.0, 0.0, 0.0, 0.0]

[[joint]]
name = "pin"
type = "revolute"
bodies = ["ground", "bar"]
point = [0.0, 0.0, 0.0]
axis = [0.0, 0.0, 1.0]
"""

TWO_BARS = """\
name = "bars"
[[body]]
name = "a"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
[[body]]
name = "b"
mass = 1.0
inertia = [1.0, 1.0, 1.0]
position = [1.0, 0.0, 0.0]
"""


def changed(*changes: tuple[str, str], text: str = PENDULUM) -> str:
    """The text with some of its parts replaced, each of which stands in it once."""
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def joined(joint: str, text: str = TWO_BARS) -> str:
    """Two bars with a joint between them, of which these lines say the type and the rest."""
    return f'{text}[[joint]]\nname = "pin"\nbodies = ["a", "b"]\n{joint}\n'


def scene(text: str, copies: int | None = None) -> Scene:
    """Read a text that is sound."""
    return read_scene(text, "scene.toml", copies)


def refused(text: str, copies: int | None = None) -> list[str]:
    """The mistakes of a text, one line each."""
    with pytest.raises(SpecificationError) as caught:
        read_scene(text, "scene.toml", copies)
    lines = [str(mistake) for mistake in caught.value.mistakes]
    assert all(line.isprintable() and line.startswith(("scene.toml", "--copies")) for line in lines)
    assert all(len(line) <= 1000 for line in lines)
    return lines
