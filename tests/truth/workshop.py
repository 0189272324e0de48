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
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from unittest import mock

from codegen import build
from codegen.emit import package
from codegen.emit.routine import Routine
from codegen.ir.program import Program
from codegen.spec.request import Options, Variant
from tests.harness.library import Library, compile_library, digest

from .cases import COMMITTED, GENERATED, Values, committed_manifest, variant_of

ROOT = Path(__file__).parents[2]
QUICK = ("-O0",)
"""Flags of what is not the committed library in double: compiled without optimisation, to save time."""
SINGLE = (*QUICK, "-DJG_REAL_IS_FLOAT")
KEPT_S = 24 * 3600.0
"""How long the cache of sources that have changed since is kept."""


@dataclass(frozen=True)
class Bench:
    """The routines of one variant.

    Attributes:
        variant: form and options.
        double: compiled as they are.
        single: the same sources compiled with `JG_REAL_IS_FLOAT`.
        programs: output, also ``all`` -> the Program of the routine.
        saved: output -> file of the CasADi function.
    """

    variant: Variant
    double: Library
    single: Library
    programs: dict[str, Program]
    saved: dict[str, Path]

    def entries(self, output: str) -> list[Any]:
        """Manifest entries of one routine: a vector's only one, or those for nonzeros and for dense storage."""
        return self.double.find(output=output)

    def entry(self, output: str, dense: bool = False) -> Any:
        """Manifest entry of one routine: a vector's only one, or that for nonzeros or for dense storage."""
        (found,) = (entry for entry in self.entries(output) if (entry["storage"] == "dense") == dense)
        return found

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
        kept = self._dir / f"{variant.file_stem}.pickle"
        folder = GENERATED if variant in COMMITTED else self._dir / variant.file_stem
        if not kept.exists():
            routines = build.routines(variant) if folder == GENERATED else generated(variant, folder)
            unfinished = kept.with_suffix(".unfinished")
            unfinished.write_bytes(pickle.dumps({routine.output: routine.program for routine in routines}))
            unfinished.replace(kept)
        programs: dict[str, Program] = pickle.loads(kept.read_bytes())
        manifest = committed_manifest() if folder == GENERATED else json.loads((folder / "manifest.json").read_text())
        entries = [entry for entry in manifest["functions"] if variant_of(entry) == variant]
        sources = sorted({entry["source"] for entry in entries})
        objects = self._dir / "compiled"
        saved = [record for record in manifest["casadi"] if variant_of(record) == variant]
        return Bench(
            variant,
            Library(entries, compile_library(folder, sources, objects, [] if folder == GENERATED else QUICK)),
            Library(
                [entry | {"real": "float"} for entry in entries], compile_library(folder, sources, objects, SINGLE)
            ),
            programs,
            {record["output"]: folder / record["file"] for record in saved},
        )


def generated(variant: Variant, folder: Path) -> tuple[Routine, ...]:
    """Generate a package of one variant alone; the routines are those that were emitted.

    The sources of CasADi's externals, a third of the work and not judged here, are left empty.
    """
    seen: list[Routine] = []

    def noted(*arguments: Any) -> tuple[Routine, ...]:
        seen.extend(routines(*arguments))
        return tuple(seen)

    routines = build.routines
    with (
        mock.patch.object(build, "routines", noted),
        mock.patch.object(package, "external_source", lambda *_: "", create=True),
    ):
        files = build.generate(request(variant))
    for path, content in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(content)
    return tuple(seen)


def request(variant: Variant) -> Options:
    """Options of the command line that ask for this variant alone."""
    return Options((variant.joint,), variant.form, variant.rows, variant.derivative, variant.variation)


@cache
def fingerprint() -> str:
    """Content hash of the generator and of the committed package."""
    sources = sorted(
        path
        for folder, pattern in (
            ("codegen", "*.py"),
            ("codegen", "*.json"),
            ("flopcount", "*.py"),
            ("templates", "*.j2"),
            ("generated", "*.c"),
        )
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
        with suppress(FileNotFoundError):  # another worker was quicker
            if time.time() - folder.stat().st_mtime > KEPT_S:
                shutil.rmtree(folder, ignore_errors=True)
