"""Benches of a session, shared by workers and runs through pytest's cache folder; notes of what was measured."""

from __future__ import annotations

from typing import Any

import pytest

from codegen.spec.request import Variant

from .notes import Notes, summary
from .workshop import Bench, Workshop


@pytest.fixture(scope="session")
def workshop(request: pytest.FixtureRequest) -> Workshop:
    """Maker of benches."""
    return Workshop(request.config.cache.mkdir("jointgen-truth"))


@pytest.fixture
def bench(workshop: Workshop, variant: Variant) -> Bench:
    """The routines of the variant that a test is about."""
    return workshop.bench(variant)


@pytest.fixture
def note(request: pytest.FixtureRequest) -> Notes:
    """Keeps what a test measured."""
    return Notes(request.node.user_properties)


def pytest_terminal_summary(terminalreporter: Any) -> None:
    """Print the worst of each claim, when these tests are run by name (`pytest tests/truth`)."""
    lines = summary(report for report in terminalreporter.stats.get("passed", ()) if "/truth/" in report.nodeid)
    if lines:
        terminalreporter.section("the worst of each claim")
        terminalreporter.write_line("\n".join(lines))
