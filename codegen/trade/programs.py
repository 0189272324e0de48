"""Routines of a variant, kept between runs: their generation takes seconds, their measurement less.

They are kept under the content hash of the sources that make them, in the user's cache folder (``XDG_CACHE_HOME``).
"""

from __future__ import annotations

import hashlib
import os
import pickle
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path
from typing import TypeVar

import codegen
from codegen import build
from codegen.emit.environment import template_folder
from codegen.emit.routine import Routine
from codegen.spec.request import Variant

T = TypeVar("T")

_MAKERS = ("build.py", "records.json", "errors.py", "emit", "ir", "measure", "mechanics", "passes", "scenes", "spec")
"""What programs and the rows of scenes depend on, below the package."""

_HEADERS = ("c", "measure")
"""Templates that compiled routines depend on."""


def routines(variant: Variant, outputs: Sequence[str] = (), fma: bool = False) -> tuple[Routine, ...]:
    """Give the routines of a variant as `codegen.build.routines` does, from the cache where it has them."""
    return kept((variant, tuple(outputs), fma), lambda: build.routines(variant, outputs, fma))


def kept(what: object, make: Callable[[], T]) -> T:
    """Give what was made before, or make and keep it.

    Args:
        what: it is; its text decides.
        make: from these sources alone.
    """
    name = hashlib.sha256(repr(what).encode()).hexdigest()[:24]
    path = cache_folder() / f"{name}.pickle"
    if path.exists():
        found: T = pickle.loads(path.read_bytes())
        return found
    made = make()
    _keep(path, pickle.dumps(made))
    return made


@cache
def builds_folder() -> Path:
    """Where routines are kept that were compiled with the headers that these templates give."""
    folder = cache_folder() / f"builds-{_digest(template_folder(), [template_folder() / part for part in _HEADERS])}"
    folder.mkdir(exist_ok=True)
    return folder


def _keep(path: Path, content: bytes) -> None:
    """Write a file that other processes see whole or not at all."""
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as handle:
        handle.write(content)
    Path(handle.name).replace(path)


@cache
def cache_folder() -> Path:
    """The folder of what these sources made; other sources have another."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(base) / "jointgen" / _fingerprint()
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _fingerprint() -> str:
    root = Path(codegen.__file__).parent
    return _digest(root, [root / maker for maker in _MAKERS])


def _digest(root: Path, places: Sequence[Path]) -> str:
    """Content hash of files, and of those in folders."""
    digest = hashlib.sha256()
    for place in places:
        for path in [place] if place.is_file() else sorted(p for p in place.rglob("*") if p.suffix in (".py", ".j2")):
            content = path.read_bytes()
            digest.update(f"{path.relative_to(root)} {len(content)}\n".encode() + content)
    return digest.hexdigest()[:24]
