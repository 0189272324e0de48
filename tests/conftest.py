"""Programs are lowered once for all tests, workers and runs of the same sources.

Hundreds of tests look at the routines of the whole library; lowering them takes a minute each time. A program is kept
under the hash of everything it is made from. Tests of the search choose for themselves and are not kept.
"""

from __future__ import annotations

import gc
import pickle
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any
from unittest import mock

import pytest

from codegen import models
from codegen.ir.lower import SymbolicOutput
from codegen.ir.lower.lowering import Choose
from codegen.ir.program import Program
from codegen.mechanics.assembly import Assembly
from codegen.mechanics.system import System
from codegen.scenes import programs as scene_programs
from codegen.spec.request import Variant
from tests.harness.library import digest
from tests.reference.constraints import CATALOGUE_PAIRS
from tests.truth.workshop import fingerprint, forget_old, locked

gc.set_threshold(100_000, 50, 100)  # as the command line does


@pytest.fixture(scope="session", autouse=True)
def kept_programs(request: pytest.FixtureRequest) -> Iterator[None]:
    """Keep what `codegen.models.Model.programs` gives for the library, and `codegen.scenes.programs` for scenes."""
    cache_dir = request.config.cache.mkdir("jointgen-programs")
    folder = cache_dir / fingerprint()
    folder.mkdir(parents=True, exist_ok=True)
    forget_old(cache_dir)
    named, lower, lower_scene = models.Model.program, models.Model.programs, scene_programs.cheapest_of

    def program(model: models.Model, names: Iterable[str]) -> Program:
        """Without deriving the quantities, where the program is kept."""
        wanted = tuple(names)
        kept: Program = _kept(folder, (lowered_variant(model), wanted), lambda: named(model, wanted))
        return kept

    def programs(
        model: models.Model, outputs: tuple[SymbolicOutput, ...], is_substituted: bool | None, choose: Choose
    ) -> list[Program]:
        def made() -> list[Program]:
            return lower(model, outputs, is_substituted, choose)

        what = (lowered_variant(model), [(output.name, output.shape) for output in outputs], is_substituted)
        return _kept(folder, what, made) if choose is models.choices_for else made()

    def cheapest_of(assembly: Assembly | System, names: tuple[str, ...], choose: Choose) -> Program:
        def made() -> Program:
            return lower_scene(assembly, names, choose)

        is_kept = choose in (models.choices_for, scene_programs.estimate)
        return _kept(folder, (assembly, names, choose.__name__), made) if is_kept else made()

    with (
        mock.patch.object(models.Model, "program", program),
        mock.patch.object(models.Model, "programs", programs),
        mock.patch.object(scene_programs, "cheapest_of", cheapest_of),
    ):
        yield


def lowered_variant(model: models.Model) -> Variant:
    """Prepared geometry is split off after lowering; a pair that is a joint of the catalogue has its programs."""
    return replace(
        model.variant, geometry="runtime", joint=CATALOGUE_PAIRS.get(model.variant.joint, model.variant.joint)
    )


def _kept(folder: Path, what: object, made: Callable[[], Any]) -> Any:
    """Read what was made before, by this process or another, or make and keep it."""
    kept = folder / f"{digest(repr(what))}.pickle"
    with locked(kept.with_suffix(".lock")):
        if not kept.exists():
            unfinished = kept.with_suffix(".unfinished")
            unfinished.write_bytes(pickle.dumps(made()))
            unfinished.replace(kept)
    return pickle.loads(kept.read_bytes())
