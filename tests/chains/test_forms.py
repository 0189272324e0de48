"""What the same scene costs by relative and by absolute coordinates: what the documentation says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from codegen.chains.programs import FUSED
from codegen.chains.programs import program as chain_program
from codegen.chains.relative import relative
from codegen.mechanics.chain.model import kept_rows
from codegen.mechanics.system import System
from codegen.scenes.generate import judge
from codegen.scenes.programs import program
from codegen.spec.plane import flattened
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene
from flopcount.count import count

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "chain.md").read_text()
ABSOLUTE = re.findall(
    r"^\| `(\w+)` \| (conventional|parametric) \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|$", PAGE, re.MULTILINE
)
RELATIVE = re.findall(r"^\| `(\w+)` \| relative \| (\d+) \| (\d+) \| (\d+) \| - \|$", PAGE, re.MULTILINE)


def read(name: str) -> Scene:
    return read_scene((ROOT / "examples" / f"{name}.toml").read_text(), name)


def system_of(name: str, form: str) -> System:
    scene = read(name)
    return System(judge(flattened(scene) if scene.motion == "planar" else scene, form).assembly)


def cases() -> list[object]:
    """All but the parametric forms in space, which take minutes to derive."""
    quick = (told for told in ABSOLUTE if told[0] == "four_bar" or told[1] == "conventional")
    return [pytest.param(*told, id="-".join(told[:2])) for told in quick]


def test_the_page_has_every_form_of_three_scenes():
    assert (len(RELATIVE), len(ABSOLUTE)) == (3, 6)


@pytest.mark.parametrize(("name", "unknowns", "rows", "operations"), RELATIVE)
def test_the_page_tells_what_relative_coordinates_cost(name, unknowns, rows, operations):
    chain = relative(read(name)).chain
    assert (len(chain.links), len(kept_rows(chain))) == (int(unknowns), int(rows))
    assert count(chain_program(chain, FUSED)).total == int(operations)


@pytest.mark.parametrize(("name", "form", "unknowns", "rows", "with_gamma", "with_second"), cases())
def test_the_page_tells_what_absolute_coordinates_cost(name, form, unknowns, rows, with_gamma, with_second):
    system = system_of(name, form)
    assert (len(system.assembly.columns), len(system.assembly.rows)) == (int(unknowns), int(rows))
    assert count(program(system, ("phi", "phi_q", "gamma", "force"))).total == int(with_gamma)
    assert count(program(system, ("phi", "phi_q", "phi_q_t_lambda_q", "force"))).total == int(with_second)
