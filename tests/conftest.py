"""What the generator keeps between runs, it keeps in pytest's cache folder: for all tests, workers and runs.

Hundreds of tests look at the routines of the whole library; lowering them takes a minute each time. Tests of the
search choose for themselves, and what they choose is not kept.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator

import pytest

gc.set_threshold(100_000, 50, 100)  # as the command line does


@pytest.fixture(scope="session", autouse=True)
def kept_between_runs(request: pytest.FixtureRequest) -> Iterator[None]:
    """Let this process and those that it starts keep what they make below pytest's cache folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(request.config.cache.mkdir("jointgen")))
        yield
