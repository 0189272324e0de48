"""What takes seconds to make is kept between runs, in the user's cache folder (``XDG_CACHE_HOME``).

Everything there is named after the content of all that makes it: the sources of the generator, the versions of Python
and sympy, and what was asked for. So nothing in it is ever stale, and removing the folder costs time only.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import pickle
import platform
import shutil
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import TypeVar

import codegen

T = TypeVar("T")

_UNUSED_S = 30 * 24 * 3600.0
"""How long what other sources made is kept after its last use."""


def kept(what: object, make: Callable[[], T]) -> T:
    """Give what was made before, or make and keep it.

    Args:
        what: it is; its `repr` decides.
        make: from ``what`` and the sources of the generator alone; the result can be pickled.
    """
    path = cache_folder() / f"{_digest(repr(what).encode())}.pickle"
    with suppress(OSError, EOFError, pickle.UnpicklingError):  # not there, or cut short by a crash of the machine
        found: T = pickle.loads(path.read_bytes())
        return found
    made = make()
    with suppress(OSError):  # no room
        _put(path, pickle.dumps(made))
    return made


def is_kept(what: object) -> bool:
    """Whether `kept` would give what was made before."""
    return (cache_folder() / f"{_digest(repr(what).encode())}.pickle").exists()


def kept_file(what: object, suffix: str, make: Callable[[], bytes]) -> Path:
    """Give a file that was made before, or make and keep it.

    Args:
        what: it is; its `repr` decides.
        suffix: of its name.
        make: its content, from ``what`` and the sources of the generator alone.
    """
    path = cache_folder() / f"{_digest(repr(what).encode())}{suffix}"
    if path.exists() and path.stat().st_size:
        return path
    content = make()
    try:
        _put(path, content)
    except OSError:  # no room
        path = _own_folder() / path.name
        _put(path, content)
    return path


def cache_folder() -> Path:
    """The folder of what these sources made; where none can be written, one that ends with this process."""
    return _folder(os.environ.get("XDG_CACHE_HOME") or "~/.cache")


@cache
def _folder(base: str) -> Path:
    try:
        folder = Path(base).expanduser() / "jointgen" / _fingerprint()
        folder.mkdir(parents=True, exist_ok=True)
        os.utime(folder)
        _forget_unused(folder.parent)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except (OSError, RuntimeError):  # nowhere to write, or no home
        return _own_folder()


@cache
def _own_folder() -> Path:
    folder = tempfile.mkdtemp(prefix="jointgen-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _forget_unused(base: Path) -> None:
    """Remove what other sources made, where nobody has used it for long."""
    for folder in base.iterdir():
        with suppress(FileNotFoundError):  # another process was quicker
            if time.time() - folder.stat().st_mtime > _UNUSED_S:
                shutil.rmtree(folder, ignore_errors=True)


def _put(path: Path, content: bytes) -> None:
    """Write a file that other processes see whole or not at all."""
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as handle:
        unfinished = Path(handle.name)
        try:
            handle.write(content)
            handle.flush()
            unfinished.replace(path)
        except BaseException:
            unfinished.unlink(missing_ok=True)
            raise


@cache
def _fingerprint() -> str:
    """Of the generator, its counter of operations, and what they are run by."""
    root = Path(codegen.__file__).parent
    sources = content_digest(root.parent, [root, root.parent / "flopcount"])
    return _digest(f"{sources} {platform.python_version()} {version('sympy')}".encode())


def content_digest(root: Path, places: Sequence[Path]) -> str:
    """Content hash of the sources, templates and data below folders.

    Args:
        root: names count from here.
        places: folders below it.
    """
    digest = hashlib.sha256()
    for place in places:
        for path in sorted(p for p in place.rglob("*") if p.suffix in (".py", ".json", ".j2")):
            content = path.read_bytes()
            digest.update(f"{path.relative_to(root)} {len(content)}\n".encode() + content)
    return digest.hexdigest()[:24]


def _digest(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()[:24]
