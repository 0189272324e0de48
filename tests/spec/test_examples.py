"""The examples close, start with velocities that their joints admit, and have the freedom that their README tells."""

from __future__ import annotations

import re
import tomllib
from fractions import Fraction

import numpy as np
import pytest

from .mobility import Mechanism
from .texts import EXAMPLES, ROOT, scene

FREEDOM = {
    "in_line_engine": 1,
    "in_line_engine_parametric": 1,
    "four_bar": 1,
    "spatial_slider_crank": 1,
    "bricard": 1,
    "bennett": 1,
    "stewart": 6,
}


def mechanism(name: str, copies: int | None = None) -> Mechanism:
    return Mechanism(scene((ROOT / "examples" / f"{name}.toml").read_text(), copies))


def test_every_example_is_named_like_its_file() -> None:
    names = [path.stem for path in EXAMPLES]
    assert sorted(FREEDOM) == names
    assert names == [tomllib.loads(path.read_text())["name"] for path in EXAMPLES]


@pytest.mark.parametrize("name", FREEDOM)
def test_an_example_closes_to_1e_12(name: str) -> None:
    assert np.abs(mechanism(name).residual()).max() < 1e-12


@pytest.mark.parametrize("name", FREEDOM)
def test_the_velocities_of_an_example_are_consistent(name: str) -> None:
    example = mechanism(name)
    assert np.abs(example.jacobian() @ example.velocity()).max() < 1e-8


@pytest.mark.parametrize("name", FREEDOM)
def test_an_example_has_the_freedom_that_the_readme_tells(name: str) -> None:
    assert mechanism(name).freedom() == FREEDOM[name]
    rows = re.findall(
        r"^\| `(\w+)\.toml` \|.*\| (\d+) \|$", (ROOT / "examples" / "README.md").read_text(), re.MULTILINE
    )
    assert dict(rows) == {key: str(value) for key, value in FREEDOM.items()}


def test_bricards_linkage_moves_although_its_count_says_that_it_locks() -> None:
    example = mechanism("bricard")
    assert example.jacobian().shape == (30, 30)
    start, path = example, 0.0
    direction = np.linalg.svd(example.jacobian())[2][-1]
    for _ in range(3):
        example = example.moved(0.05 * direction)
        for _ in range(4):
            example = example.moved(-np.linalg.pinv(example.jacobian(), rcond=1e-6) @ example.residual())
        assert np.abs(example.residual()).max() < 1e-12
        assert example.freedom() == 1
        following = np.linalg.svd(example.jacobian())[2][-1]
        direction = following * np.sign(following @ direction)
        path = max(path, float(np.abs(example.positions["bar 3"] - start.positions["bar 3"]).max()))
    assert path > 0.02


def test_engines_in_a_row_have_one_freedom_each() -> None:
    engines = mechanism("in_line_engine", copies=3)
    assert [body.name for body in engines.scene.bodies[:4]] == ["crank_1", "rod_1", "piston_1", "crank_2"]
    assert engines.scene.body("piston_3").position == (Fraction("0.4"), 0, Fraction("0.2"))
    assert np.abs(engines.residual()).max() < 1e-12
    assert engines.freedom() == 3


def test_the_slider_of_the_spatial_slider_crank_stands_where_pythagoras_puts_it() -> None:
    slider = mechanism("spatial_slider_crank").scene.body("slider")
    assert abs(slider.position[0] ** 2 - (Fraction("0.27") ** 2 - Fraction("0.1") ** 2 - Fraction("0.2") ** 2)) < 1e-19
