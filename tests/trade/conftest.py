"""Programs that these tests generate are kept in pytest's cache folder."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from codegen.trade import programs


@pytest.fixture(autouse=True, scope="session")
def _own_cache(request: pytest.FixtureRequest) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(request.config.cache.mkdir("jointgen-trade")))
        _forget()
        yield
    _forget()


def _forget() -> None:
    programs.cache_folder.cache_clear()
    programs.builds_folder.cache_clear()
