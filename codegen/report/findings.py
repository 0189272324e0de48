"""Results on disk: what a command or benchmark left in a folder, for the report.

Input: folders. Output: for each folder below them that holds results, its texts, tables and pictures.
"""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from codegen.errors import Mistake, SpecificationError

_SUMMARY = "summary.json"
_ANIMATION = "animation.html"
_SKIPPED = {"node_modules", "build", "dist", "__pycache__"}


@dataclass(frozen=True, slots=True)
class Finding:
    """The results in one folder.

    Attributes:
        title: the folder as it was named, and the way down from there.
        texts: Markdown.
        pictures: file name -> SVG.
        summary: of a run; None where there is none.
        animation: page that plays a run; empty where there is none.
    """

    title: str
    texts: tuple[str, ...]
    pictures: dict[str, str]
    summary: dict[str, Any] | None
    animation: str


def findings(folders: Iterable[Path]) -> list[Finding]:
    """Find the results in folders and in what is below them; a folder holds results if it holds a JSON file.

    Raises:
        SpecificationError: a folder that is not there, a file that cannot be read, or no results at all.
    """
    folders = list(folders)
    mistakes = [
        Mistake(str(folder), "is no folder", "name folders that jointgen or a benchmark wrote")
        for folder in folders
        if not folder.is_dir()
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    found = [finding for folder in folders for finding in _below(folder)]
    if not found:
        places = ", ".join(map(str, folders)) or "."
        raise SpecificationError([Mistake(places, "holds no results", "run jointgen generate first, or name folders")])
    return found


def _below(root: Path) -> Iterator[Finding]:
    for place, names, files in os.walk(root):
        names[:] = sorted(name for name in names if not name.startswith(".") and name not in _SKIPPED)
        if any(name.endswith(".json") for name in files):
            finding = _finding(Path(place), sorted(files))
            if finding.texts or finding.pictures or finding.summary:
                yield finding


def _finding(folder: Path, files: list[str]) -> Finding:
    summary = json.loads(_read(folder / _SUMMARY)) if _SUMMARY in files else None
    return Finding(
        folder.as_posix(),
        tuple(_read(folder / name) for name in files if name.endswith(".md")),
        {name: _read(folder / name) for name in files if name.endswith(".svg")},
        summary if isinstance(summary, dict) else None,
        _read(folder / _ANIMATION) if _ANIMATION in files else "",
    )


def _read(path: Path) -> str:
    try:
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".json":
            json.loads(text)
    except (OSError, ValueError) as error:
        raise SpecificationError([Mistake(str(path), f"cannot be read ({error})", "write the results anew")]) from error
    return text
