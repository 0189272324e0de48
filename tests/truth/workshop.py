"""The routines of one variant, ready to call: compiled in double and in float, and as Programs.

What is made is kept under the hash of everything it is made from, so that the workers of a run share it and so do
later runs. A variant outside the committed library is generated into the cache by `codegen.build.generate`.
"""

from __future__ import annotations

import fcntl
import json
import os
import pickle
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from codegen import build
from codegen.ir.program import Program
from codegen.spec.request import Options, Variant
from tests.harness.library import Library, compile_library, digest

from .cases import COMMITTED, GENERATED, Values, committed_manifest, variant_of

ROOT = Path(__file__).parents[2]
KEPT_S = 24 * 3600.0
"""How long the cache of sources that have changed since is kept."""


@dataclass(frozen=True)
class Bench:
    """The routines of one variant.

    Attributes:
        variant: form and options.
        package: folder of the generated package that holds them.
        double: compiled as they are.
        single: the same sources compiled with `JG_REAL_IS_FLOAT`.
        programs: output, also ``all`` -> the Program of the routine.
        saved: output -> file of the CasADi function.
    """

    variant: Variant
    package: Path
    double: Library
    single: Library
    programs: dict[str, Program]
    saved: dict[str, Path]

    @property
    def outputs(self) -> tuple[str, ...]:
        """The routines by what they evaluate."""
        return tuple(self.programs)

    def entry(self, output: str, storage: str | None = None) -> dict[str, Any]:
        """Manifest entry of one routine: of a vector, or of a matrix (or ``all``) in one storage, nonzeros first."""
        entries = self.double.find(output=output)
        return dict(next(entry for entry in entries if storage is None or entry["storage"] == storage))

    def value(self, quantity: str, inputs: dict[str, Any]) -> Values:
        """One quantity by its own routine in C, dense: a vector [n] or a matrix."""
        value = self.double.call(self.entry(quantity)["symbol"], inputs, dense=True)[quantity]
        return value[:, 0] if value.shape[1] == 1 else value


class Workshop:
    """Makes benches, each once for all workers."""

    def __init__(self, cache_dir: Path) -> None:
        self._dir = cache_dir / fingerprint()
        self._dir.mkdir(parents=True, exist_ok=True)
        os.utime(self._dir)
        forget_old(cache_dir)
        self._benches: dict[Variant, Bench] = {}

    def bench(self, variant: Variant) -> Bench:
        """The routines of a variant."""
        if variant not in self._benches:
            with locked(self._dir / f"{variant.file_stem}.lock"):
                self._benches[variant] = self._make(variant)
        return self._benches[variant]

    def _make(self, variant: Variant) -> Bench:
        programs = self._programs(variant)
        package = GENERATED if variant in COMMITTED else self._generated(variant)
        manifest = committed_manifest() if package == GENERATED else json.loads((package / "manifest.json").read_text())
        entries = [entry for entry in manifest["functions"] if variant_of(entry) == variant]
        sources = sorted({entry["source"] for entry in entries})
        objects = self._dir / "compiled"
        saved = [record for record in manifest["casadi"] if variant_of(record) == variant]
        return Bench(
            variant,
            package,
            Library(entries, compile_library(package, sources, objects)),
            Library(
                [entry | {"real": "float"} for entry in entries],
                compile_library(package, sources, objects, ["-DJG_REAL_IS_FLOAT"]),
            ),
            programs,
            {record["output"]: package / record["file"] for record in saved},
        )

    def _programs(self, variant: Variant) -> dict[str, Program]:
        kept = self._dir / f"{variant.file_stem}.pickle"
        if not kept.exists():
            programs = {routine.output: routine.program for routine in build.routines(variant)}
            unfinished = kept.with_suffix(".unfinished")
            unfinished.write_bytes(pickle.dumps(programs))
            unfinished.replace(kept)
            return programs
        found: dict[str, Program] = pickle.loads(kept.read_bytes())
        return found

    def _generated(self, variant: Variant) -> Path:
        package = self._dir / variant.file_stem
        if not package.exists():
            files = build.generate(request(variant))
            with tempfile.TemporaryDirectory(dir=self._dir) as scratch:
                unfinished = Path(scratch) / "package"
                for path, content in files.items():
                    (unfinished / path).parent.mkdir(parents=True, exist_ok=True)
                    (unfinished / path).write_bytes(content)
                unfinished.replace(package)
        return package


def request(variant: Variant) -> Options:
    """Options of the command line that ask for this variant alone."""
    return Options((variant.joint,), variant.form, variant.rows, variant.derivative, variant.variation)


@cache
def fingerprint() -> str:
    """Content hash of the generator and of the committed package."""
    sources = sorted(
        path
        for folder, pattern in (("codegen", "*.py"), ("flopcount", "*.py"), ("templates", "*.j2"), ("generated", "*.c"))
        for path in (ROOT / folder).rglob(pattern)
    )
    names = (str(path.relative_to(ROOT)) for path in sources)
    return digest(*names, *(path.read_bytes() for path in sources), (GENERATED / "manifest.json").read_bytes())


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Hold a lock that other processes respect."""
    with path.open("w") as handle:
        fcntl.flock(handle, fcntl.LOCK_EX)
        yield


def forget_old(cache_dir: Path) -> None:
    """Remove what belongs to sources that have changed and was not used for a day."""
    for folder in cache_dir.iterdir():
        if time.time() - folder.stat().st_mtime > KEPT_S:
            shutil.rmtree(folder, ignore_errors=True)


def as_vector(argument: Any) -> Values:
    """Words of an input, column-major."""
    return np.asarray(argument, dtype=float).ravel(order="F")
