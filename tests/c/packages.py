"""The packages that these tests compile: the committed library, a joint at a time, and what exists on request only."""

from __future__ import annotations

import fcntl
import json
import shutil
import subprocess
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from codegen import build, output
from codegen.mechanics.joints import JOINTS, PAIRS
from codegen.spec.request import Options
from tests.harness.library import HarnessError, Library, digest, run_compiler

GENERATED = Path(__file__).resolve().parents[2] / "generated"
STRICT = (
    "-std=c99",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Wmissing-prototypes",
    "-Wdouble-promotion",
    "-Werror",
)
"""The flags of DESIGN 3.2, all of them."""
NATIVE = ("-O1", "-fPIC", "-Wvla")
"""Further flags for the number type that a package is made for. No routine has an array of variable length."""
FLOAT = ("-Wvla", "-DJG_REAL_IS_FLOAT")
DOUBLE = ("-Wvla", "-DJG_REAL_IS_DOUBLE")

REQUESTS: dict[str, Options] = {
    "pairs": Options(tuple(PAIRS), rows="regular", derivative="exact", outputs=("all",)),
    "quaternion": Options(("ball",), rows="quaternion"),
    "world": Options(("screw",), form="parametric", variation="world"),
    "float": Options(("screw", "rigid"), rows="table4", derivative="exact", real="float"),
}
"""Beyond the committed library."""

CASES = (*JOINTS, *REQUESTS)


@dataclass(frozen=True)
class Package:
    """A generated package, or the part of one that is about one joint.

    Attributes:
        root: folder of its manifest.
        joint: the only joint looked at; None for all of them.
        cache: folder for objects, named by their content.
    """

    root: Path
    joint: str | None
    cache: Path

    @cached_property
    def entries(self) -> list[dict[str, Any]]:
        """The manifest's functions."""
        functions = json.loads((self.root / "manifest.json").read_text())["functions"]
        return [function for function in functions if self.joint in (None, function["joint"])]

    @property
    def real(self) -> str:
        """Number type it is made for."""
        return str(self.entries[0]["real"])

    @property
    def sources(self) -> list[Path]:
        """The C sources."""
        return [self.root / name for name in dict.fromkeys(entry["source"] for entry in self.entries)]

    @property
    def externals(self) -> list[Path]:
        """The C sources of CasADi's externals."""
        stems = {source.stem for source in self.sources}
        return [path for path in sorted((self.root / "casadi").rglob("*.c")) if path.stem in stems]

    @property
    def headers(self) -> list[Path]:
        """The headers of its joints, and those that all joints share."""
        include = self.root / "c/include/jointgen"
        own = [self.root / name for name in dict.fromkeys(entry["header"] for entry in self.entries)]
        return [*own, include / "jg_real.h", include / "jointgen.h"]

    def objects(self, *flags: str, externals: bool = False) -> list[Path]:
        """Compile every source (or external); a complaint of the compiler is a `HarnessError`."""
        include = self.root / "c/include"
        texts = b"".join(path.read_bytes() for path in sorted(include.rglob("*.h")))

        def compile_one(source: Path) -> Path:
            target = self.cache / f"{source.stem}-{digest(texts, source.read_bytes(), *flags)}.o"
            if not target.exists():
                compile_silently(["gcc", *flags, f"-I{include}", "-c", str(source), "-o", str(target)])
            return target

        with only_one(self.cache / f"{self.root.name}-{self.joint}.lock"), ThreadPoolExecutor(max_workers=2) as pool:
            return list(pool.map(compile_one, self.externals if externals else self.sources))

    def parse(self, *flags: str) -> None:
        """Let the compiler read every source, without output: whatever it says is a `HarnessError`."""
        for source in self.sources:
            compile_silently(["gcc", *flags, f"-I{self.root / 'c/include'}", "-fsyntax-only", str(source)])

    def library(self) -> Library:
        """Its routines, to be called from Python."""
        objects = self.objects(*STRICT, *NATIVE)
        target = self.cache / f"{digest(*(path.name for path in objects))}.so"
        return Library(self.entries, run_compiler(["gcc", "-shared", *map(str, objects), "-lm"], target))


@contextmanager
def only_one(path: Path) -> Iterator[None]:
    """One test process at a time."""
    with path.open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def compile_silently(command: Sequence[str], text: str | None = None) -> None:
    """Run a compiler on its arguments, or on a text at its standard input; whatever it says is an error."""
    run = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    if run.returncode or run.stdout or run.stderr:
        raise HarnessError(f"{' '.join(command)}\n{(run.stdout + run.stderr)[:2000]}")


def package(case: str, shared: Path) -> Package:
    """Give the package of a case; one that must be generated is made once for all test processes."""
    cache = shared / "objects"
    cache.mkdir(exist_ok=True)
    if case in JOINTS:
        return Package(GENERATED, case, cache)
    root = shared / case
    with only_one(shared / f"{case}.lock"):
        if not root.exists():
            output.replace(root, build.generate(REQUESTS[case]))
    return Package(root, None, cache)


def have(*tools: str) -> bool:
    """Whether every tool is installed."""
    return all(shutil.which(tool) for tool in tools)
