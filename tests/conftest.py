"""Programs are lowered once for all tests, workers and runs of the same sources.

Hundreds of tests look at the routines of the whole library; lowering them takes a minute each time. A program is kept
under the hash of everything it is made from. Tests of the search choose for themselves and are not kept.
"""

from __future__ import annotations

import pickle
from collections.abc import Iterator
from unittest import mock

import pytest

from codegen import build
from codegen.ir.lower import SymbolicOutput
from codegen.ir.lower.lowering import Choose
from codegen.ir.program import Program
from tests.harness.library import digest
from tests.truth.workshop import fingerprint, forget_old, locked


@pytest.fixture(scope="session", autouse=True)
def kept_programs(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep what `codegen.build.Model.programs` gives."""
    cache_dir = request.config.cache.mkdir("jointgen-programs")
    folder = cache_dir / fingerprint()
    folder.mkdir(parents=True, exist_ok=True)
    forget_old(cache_dir)
    lower = build.Model.programs

    def programs(
        model: build.Model, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None, choose: Choose
    ) -> list[Program]:
        if choose is not build.choices_for:
            return lower(model, outputs, is_substituted, choose)
        what = (model.variant, [(output.name, output.shape) for output in outputs], is_substituted)
        kept = folder / f"{digest(repr(what))}.pickle"
        with locked(kept.with_suffix(".lock")):
            if not kept.exists():
                unfinished = kept.with_suffix(".unfinished")
                unfinished.write_bytes(pickle.dumps(lower(model, outputs, is_substituted, choose)))
                unfinished.replace(kept)
        found: list[Program] = pickle.loads(kept.read_bytes())
        return found

    with mock.patch.object(build.Model, "programs", programs):
        yield
