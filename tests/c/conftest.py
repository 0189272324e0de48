"""Fixtures: one folder that all test processes share, and the package of each case."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from .packages import CASES, Package, package


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    base = tmp_path_factory.getbasetemp()
    folder = (base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "c-packages"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(params=CASES)
def generated(request: pytest.FixtureRequest, shared: Path) -> Package:
    """Each joint of the committed library, and each package on request."""
    return package(request.param, shared)
