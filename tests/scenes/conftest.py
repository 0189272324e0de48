"""Programs of drawn scenes are made once for all tests, workers and runs of the same sources."""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from unittest import mock

import pytest

from codegen.ir.program import Program
from tests.harness.library import digest
from tests.truth.workshop import fingerprint, forget_old, locked

from . import cases, packages


@pytest.fixture(scope="session", autouse=True)
def kept_scenes(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep what `tests.scenes.cases.program` gives."""
    cache_dir = request.config.cache.mkdir("jointgen-scenes")
    drawing = "".join(path.read_text() for path in sorted(Path(__file__).parent.glob("*.py")))
    folder = cache_dir / digest(fingerprint(), drawing)
    folder.mkdir(parents=True, exist_ok=True)
    forget_old(cache_dir)
    make = cases.program

    @cache
    def program(name: str) -> Program:
        kept = folder / f"{digest(name)}.pickle"
        with locked(kept.with_suffix(".lock")):
            if not kept.exists():
                kept.write_bytes(pickle.dumps(make(name)))
        found: Program = pickle.loads(kept.read_bytes())
        return found

    with mock.patch.object(cases, "program", program):
        yield


@pytest.fixture(scope="session")
def scene_packages(request: pytest.FixtureRequest) -> Path:
    """The folder of the packages of these sources."""
    folder = request.config.cache.mkdir("jointgen-scene-packages")
    forget_old(folder)
    return packages.kept_in(folder)


@pytest.fixture(params=packages.CASES)
def made(request: pytest.FixtureRequest, scene_packages: Path) -> packages.Package:
    """Each package."""
    return packages.package(request.param, scene_packages)
