"""Read a mechanism from a file: a scene file, a URDF or an MJCF, by the ending of its name."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from codegen.errors import Mistake, SpecificationError
from codegen.spec.mjcf import read_mjcf
from codegen.spec.scene import Scene
from codegen.spec.scene_file import read_scene
from codegen.spec.urdf import read_urdf

_LARGEST = 64 * 1024 * 1024
"""Bytes of a file."""

_READERS = {".toml": "a scene file", ".urdf": "a URDF", ".xml": "an MJCF"}

_PARTS = (".xml", ".mjcf", ".stl", ".obj", ".msh")
"""Endings of the files that a model may be made of."""


def read(file: Path, copies: int | None = None) -> tuple[Scene, Sequence[str]]:
    """Read a mechanism.

    Args:
        file: its path.
        copies: how often a scene file's mechanism is repeated.

    Returns:
        The scene, and what the file holds that is not modelled, line by line.

    Raises:
        SpecificationError: the file cannot be read, or holds mistakes; all of them at once.
    """
    ending = file.suffix.lower()
    if ending not in _READERS:
        known = ", ".join(f"{name} ({words})" for name, words in _READERS.items())
        raise SpecificationError([Mistake(str(file), "is no kind of file that can be read", f"known: {known}")])
    if copies is not None and ending != ".toml":
        raise SpecificationError([Mistake("--copies", "only scene files are repeated", "leave it out")])
    if ending == ".toml":
        return read_scene(text_of(file), str(file), copies), ()
    content = _content(file)
    if ending == ".urdf":
        imported = read_urdf(content, str(file))
    else:
        imported = read_mjcf(content, str(file), files=_beside(file))
    return imported.scene, [str(part) for part in imported.left_out]


def text_of(file: Path) -> str:
    """Read a text file.

    Raises:
        SpecificationError: it cannot be read, is too large, or is no text.
    """
    try:
        return _content(file).decode()
    except UnicodeDecodeError as error:
        what = f"is not UTF-8 text (byte {error.start})"
        raise SpecificationError([Mistake(str(file), what, "save it as UTF-8")]) from error


def _content(file: Path) -> bytes:
    try:
        if file.stat().st_size > _LARGEST:
            raise SpecificationError([Mistake(str(file), "is larger than 64 MiB", "give a smaller file")])
        return file.read_bytes()
    except OSError as error:
        what = f"cannot be read ({error.strerror or error})"
        raise SpecificationError([Mistake(str(file), what, "name a file that can")]) from error


def _beside(file: Path) -> dict[str, bytes]:
    """The files of the folder of a model: it may include them."""
    found = {}
    for path in sorted(file.parent.rglob("*")):
        if path.is_file() and path.suffix.lower() in _PARTS and path.stat().st_size <= _LARGEST:
            found[path.relative_to(file.parent).as_posix()] = path.read_bytes()
    return found
