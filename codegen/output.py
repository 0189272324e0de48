"""Write a package whole or not at all, and compare one with what is on disk.

The files are written to a new folder beside the target, which then takes the target's place. Whatever interrupts the
writing leaves the previous output as it was. Where the system can exchange two folders in one step (Linux) that holds
for a process that is killed too; elsewhere the previous output may then be left in the folder beside the target.
"""

from __future__ import annotations

import contextlib
import ctypes
import json
import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import IO

from codegen.errors import Mistake, OutputError

MANIFEST = "manifest.json"

Writer = Callable[[IO[bytes]], None]
"""Writes a file that is too large to be held in memory."""

Content = bytes | Writer
"""Of a file."""


def check_target(target: Path) -> None:
    """Refuse a target that cannot be replaced, before any work is done.

    Raises:
        OutputError: it is a file, holds something that is not ours, or its parent cannot be written.
    """
    try:
        what = _obstacle(Path(os.path.realpath(target)))
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
    if what:
        remedy = f"{'remove it, or ' if MANIFEST in what else ''}name another directory with -o"
        raise OutputError([Mistake(str(target), what, remedy)])


def _obstacle(target: Path) -> str | None:
    if target.exists() and not target.is_dir():
        return "is a file, not a directory"
    if target.is_dir() and any(target.iterdir()) and _symbols(target) is None:
        return f"is not empty and holds no {MANIFEST} of jointgen"
    if Path.cwd().is_relative_to(target):
        return "is the current directory or holds it, and cannot be replaced from inside"
    parent = room(target)
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        return f"{parent} is not a directory that can be written"
    return None


def room(target: Path) -> Path:
    """The nearest folder above the target that exists: on the same disk."""
    parent = Path(os.path.realpath(target)).parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    return parent


def _symbols(target: Path) -> set[str] | None:
    """Functions of the package in a folder; None if there is no package of ours, or a damaged one."""
    try:
        document = json.loads((target / MANIFEST).read_text(encoding="utf-8"))
        if "generator" not in document:
            return None
        return {str(function["symbol"]) for function in document["functions"]}
    except (OSError, ValueError, LookupError, TypeError):
        return None


def functions_lost(target: Path, files: Mapping[str, bytes]) -> int:
    """Count the functions of the package in the target that the new package lacks."""
    new = {function["symbol"] for function in json.loads(files[MANIFEST])["functions"]}
    return len((_symbols(target) or set()) - new)


def replace(target: Path, files: Mapping[str, Content]) -> None:
    """Put the files in the place of the target directory; a link stays a link to the new content.

    Raises:
        OutputError: the target cannot be replaced; it is as it was.
    """
    check_target(target)
    real = Path(os.path.realpath(target))
    try:
        real.parent.mkdir(parents=True, exist_ok=True)
        with _staging(real) as folder:
            _write(folder / "new", files)
            if real.exists() and _exchanged(folder / "new", real):
                return
            if real.exists():
                real.rename(folder / "previous")
            (folder / "new").rename(real)
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise OutputError([Mistake(str(target), what, "name another directory with -o")]) from error


def replace_file(target: Path, content: bytes) -> None:
    """Put a file in the place of the target, whole or not at all.

    Raises:
        OutputError: the target cannot be written; it is as it was.
    """
    real = Path(os.path.realpath(target))
    try:
        if real.is_dir():
            raise OutputError([Mistake(str(target), "is a directory, not a file", "name a file with -o")])
        real.parent.mkdir(parents=True, exist_ok=True)
        with _staging(real) as folder:
            _write(folder, {"new": content})
            (folder / "new").replace(real)
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise OutputError([Mistake(str(target), what, "name another file with -o")]) from error


_HERE, _EXCHANGE = -100, 2
"""``AT_FDCWD`` and ``RENAME_EXCHANGE`` of Linux."""


def _exchanged(first: Path, second: Path) -> bool:
    """Exchange two folders in one step, so that not even a killed process leaves neither; false where it cannot be."""
    try:
        rename = ctypes.CDLL(None).renameat2
    except (AttributeError, OSError, TypeError):
        return False
    return int(rename(_HERE, os.fsencode(first), _HERE, os.fsencode(second), _EXCHANGE)) == 0


@contextlib.contextmanager
def _staging(target: Path) -> Iterator[Path]:
    """A new folder beside the target, on the same file system; it is gone in the end.

    What was moved out of the target's place goes back if nothing took that place, whatever happened in between.
    """
    folder = target.with_name(f".{target.name[:100]}.{os.getpid()}")
    try:
        folder.mkdir()
        yield folder
    finally:
        previous = folder / "previous"
        if previous.exists() and not target.exists():
            previous.rename(target)
        shutil.rmtree(folder, ignore_errors=True)


def _write(folder: Path, files: Mapping[str, Content]) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(content, bytes):
            path.write_bytes(content)
        else:
            with path.open("wb") as file:
                content(file)


def differences(target: Path, files: Mapping[str, bytes]) -> list[str]:
    """List the files of a package that are missing, stale or not part of it, as ``path: what``."""
    present = {
        path.relative_to(target).as_posix() for path in (target.rglob("*") if target.is_dir() else ()) if path.is_file()
    }
    found = []
    for name in sorted(present | set(files)):
        if name not in files:
            found.append(f"{name}: not generated any more")
        elif name not in present:
            found.append(f"{name}: missing")
        elif (target / name).read_bytes() != files[name]:
            found.append(f"{name}: stale")
    return found
