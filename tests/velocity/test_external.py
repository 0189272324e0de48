"""Indices as CasADi externals have exact derivatives, those that CasADi finds, also where values are repeated."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import casadi
import numpy as np
import pytest

from codegen.platforms.generate import generate_platform
from codegen.spec.platform_file import read_platform

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")

FILE = Path(__file__).resolve().parents[2] / "examples" / "platforms" / "octahedral.toml"
HOME = (np.array([0.0, 0.0, 1.0]), np.zeros(3))
TURNED = (np.array([0.1, -0.05, 0.9]), np.array([0.2, -0.3, 0.1]))


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    text = FILE.read_text()
    if "[output]" in text:
        text = text[: text.index("[output]")]
    text += '[output]\nquantities = ["lengths", "D", "C"]\nvariant = "smooth"\nattitude = "ZYX"\n'
    folder = tmp_path_factory.mktemp("platform")
    for path, content in generate_platform(read_platform(text, "a.toml")).items():
        (folder / path).parent.mkdir(exist_ok=True)
        (folder / path).write_bytes(content)
    sources = [folder / "octahedral.c", folder / "casadi" / "external.c"]
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O0", "-shared", "-fPIC", f"-I{folder}"]
    subprocess.run(["gcc", *flags, *map(str, sources), "-lm", "-o", str(folder / "external.so")], check=True)
    return folder


@pytest.mark.parametrize("quantity", ["lengths", "D", "C"])
@pytest.mark.parametrize("pose", [HOME, TURNED])
def test_an_external_has_the_jacobian_that_casadi_finds(package: Path, quantity: str, pose: tuple[object, ...]) -> None:
    external = casadi.external(f"jg_octahedral_{quantity}_external", str(package / "external.so"))
    function = casadi.Function.load(str(package / "casadi" / f"{quantity}.casadi"))
    np.testing.assert_allclose(external(*pose), function(*pose), rtol=1e-14)
    for ours, theirs in zip(*(_blocks(f, pose) for f in (external, function)), strict=True):
        assert np.isfinite(theirs).all()
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=1e-12 * max(1.0, np.abs(theirs).max()))


def _blocks(function: casadi.Function, pose: tuple[object, ...]) -> list[np.ndarray]:
    return [np.asarray(block) for block in function.jacobian()(*pose, np.zeros(function.size_out(0)))]
