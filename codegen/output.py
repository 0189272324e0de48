"""Write a package whole or not at all, and compare one with what is on disk.

The files are written to a new folder beside the target, which then takes the target's place. Whatever interrupts the
writing leaves the previous output as it was.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from codegen.errors import Mistake, OutputError

MANIFEST = "manifest.json"


def check_target(target: Path) -> None:
    """Refuse a target that cannot be replaced, before any work is done.

    Raises:
        OutputError: it is a file, holds something that is not ours, or its parent cannot be written.
    """
    if target.exists() and not target.is_dir():
        raise OutputError([Mistake(str(target), "is a file, not a directory", "name another directory with -o")])
    if target.is_dir() and any(target.iterdir()) and not _is_ours(target):
        what = f"is not empty and holds no {MANIFEST} of jointgen"
        raise OutputError([Mistake(str(target), what, "remove it, or name another directory with -o")])
    parent = _existing_parent(target)
    if not parent.is_dir() or not os.access(parent, os.W_OK | os.X_OK):
        raise OutputError(
            [
                Mistake(
                    str(target),
                    f"{parent} is not a directory that can be written",
                    "name another directory with -o",
                )
            ]
        )


def _is_ours(target: Path) -> bool:
    try:
        document = json.loads((target / MANIFEST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return False
    return isinstance(document, dict) and "generator" in document


def functions_lost(target: Path, files: Mapping[str, bytes]) -> int:
    """Count the functions of the package in the target that the new package lacks."""
    path = target / MANIFEST
    if not path.is_file():
        return 0
    symbols = [
        {function["symbol"] for function in json.loads(text).get("functions", [])}
        for text in (path.read_bytes(), files[MANIFEST])
    ]
    return len(symbols[0] - symbols[1])


def _existing_parent(target: Path) -> Path:
    parent = target.absolute().parent
    while not parent.exists() and parent != parent.parent:
        parent = parent.parent
    return parent


def replace(target: Path, files: Mapping[str, bytes]) -> None:
    """Put the files in the place of the target directory.

    Raises:
        OutputError: the target cannot be replaced; it is as it was.
    """
    check_target(target)
    target = target.absolute()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with _staging(target) as staged:
            _write(staged, files)
            _swap(staged, target)
    except OSError as error:
        what = f"cannot be written ({error.strerror or error})"
        raise OutputError([Mistake(str(target), what, "name another directory with -o")]) from error


@contextlib.contextmanager
def _staging(target: Path) -> Iterator[Path]:
    """A new folder beside the target, on the same file system; it is gone in the end."""
    folder = Path(tempfile.mkdtemp(prefix=f".{target.name}.", dir=target.parent))
    try:
        staged = folder / "new"
        staged.mkdir()
        yield staged
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _write(folder: Path, files: Mapping[str, bytes]) -> None:
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def _swap(staged: Path, target: Path) -> None:
    """Two renames; if the second fails, the first is undone."""
    previous = staged.parent / "previous"
    if target.exists():
        target.rename(previous)
    try:
        staged.rename(target)
    except BaseException:
        if previous.exists():
            previous.rename(target)
        raise


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
