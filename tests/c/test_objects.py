"""What object code needs and defines: no trigonometry in conventional routines, no heap, no writable globals.

The one transcendental function of a conventional routine is ``atan2``: the screw's constraint holds the angle turned.
"""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from .packages import NATIVE, STRICT, Package, have

pytestmark = pytest.mark.skipif(not have("gcc", "nm"), reason="needs gcc and nm")
WRITABLE = frozenset("bBdDcCgGsSuVvWw")


def symbols(path: Path) -> dict[str, str]:
    """Symbol -> type letter of nm."""
    run = subprocess.run(["nm", "-f", "posix", str(path)], capture_output=True, text=True, check=True)
    return {line.split()[0]: line.split()[1] for line in run.stdout.splitlines()}


@pytest.fixture
def objects(generated: Package) -> list[tuple[str, dict[str, str]]]:
    """Source's stem and symbols of each object."""
    compiled = generated.objects(*STRICT, *NATIVE)
    return [(source.stem, symbols(path)) for source, path in zip(generated.sources, compiled, strict=True)]


def test_only_the_mathematics_that_a_routine_is_about_is_called(
    generated: Package, objects: list[tuple[str, dict[str, str]]]
) -> None:
    suffix = "f" if generated.real == "float" else ""
    atan2, *rotations = (name + suffix for name in ("atan2", "sin", "cos", "sincos"))
    for stem, found in objects:
        undefined = {name for name, kind in found.items() if kind == "U"} - {"_GLOBAL_OFFSET_TABLE_"}
        entry = next(entry for entry in generated.entries if Path(entry["source"]).stem == stem)
        if entry["form"] == "conventional":
            assert undefined == ({atan2} if entry["joint"] == "screw" else set()), stem
        else:
            assert undefined <= set(rotations), stem


def test_no_global_can_be_written(objects: list[tuple[str, dict[str, str]]]) -> None:
    for stem, found in objects:
        assert not {name for name, kind in found.items() if kind in WRITABLE}, stem


def test_the_functions_are_those_of_the_manifest(generated: Package, objects: list[tuple[str, dict[str, str]]]) -> None:
    defined = {name for _, found in objects for name, kind in found.items() if kind == "T"}
    patterns = {pattern["function"] for entry in generated.entries for pattern in entry["sparsity"].values()}
    assert defined == {entry["symbol"] for entry in generated.entries} | patterns
    assert {kind for _, found in objects for kind in found.values()} <= set("TtRrU")
