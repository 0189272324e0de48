"""Short polynomials of sine and cosine are as good as their degree, on every quarter of a turn."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest

from codegen.measure.routine_builds import Build, built
from codegen.measure.short_trigonometry import DEGREES
from codegen.spec.request import Variant
from codegen.trade.extreme_table import routine_of

LARGEST = {5: 3e-5, 7: 2e-7, 9: 1e-9, 11: 1e-11}
"""Errors of interpolation up to an eighth of a turn, with room to spare."""


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
@pytest.mark.parametrize("degree", DEGREES)
def test_the_error_falls_with_the_degree(degree: int, tmp_path: Path) -> None:
    """The rotational rows of a revolute joint with unit frames hold sine and cosine of the angle."""
    routine = routine_of(Variant("revolute", "parametric", "table4"), "phi")
    angles = np.linspace(-20.0, 20.0, 401)
    unit = np.repeat(np.eye(3).ravel()[:, None], len(angles), axis=1)
    nothing = np.zeros((3, len(angles)))
    given = {"r_i": nothing, "A_i": unit, "r_j": nothing, "A_j": unit, "alpha": angles[None, :]}
    given["geometry"] = np.concatenate([nothing, unit, nothing, unit])
    exact = built(routine, Build("libm"), tmp_path).values(given)["phi"]
    short = built(routine, Build("short", trigonometry="short", degree=degree), tmp_path).values(given)["phi"]
    np.testing.assert_allclose(exact[5], 1 - np.cos(angles), atol=1e-15)
    error = np.max(np.abs(short - exact))
    assert LARGEST[degree] / 1000 < error < LARGEST[degree]
