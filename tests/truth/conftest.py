"""The benches of a session, shared between workers and runs through pytest's own cache folder."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

flint = pytest.importorskip("flint")

from codegen.spec.request import Variant  # noqa: E402

from .workshop import Bench, Workshop  # noqa: E402


@pytest.fixture(scope="session")
def workshop(request: pytest.FixtureRequest) -> Workshop:
    """Maker of benches."""
    return Workshop(request.config.cache.mkdir("jointgen-truth"))


@pytest.fixture
def bench(workshop: Workshop, variant: Variant) -> Bench:
    """The routines of the variant that a test is about."""
    return workshop.bench(variant)


@pytest.fixture(autouse=True)
def _precision() -> Iterator[None]:
    """200-bit flint numbers inside each test."""
    before, flint.ctx.prec = flint.ctx.prec, 200
    yield
    flint.ctx.prec = before
