"""Markdown in which text from a scene file stays text."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence


class Code(str):
    """A cell that is shown as code; never text from a file."""

    __slots__ = ()


def table(head: Sequence[str], lines: Iterable[Sequence[str]]) -> str:
    """Write a table."""
    rows = [head, ["---"] * len(head), *([_cell(cell) for cell in line] for line in lines)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _cell(text: str) -> str:
    return f"`{text}`" if isinstance(text, Code) else escaped(text)


def escaped(text: str) -> str:
    """Take the meaning that Markdown gives to signs away."""
    return re.sub(r"([\\`*_\[\]<>|#!&~$@])", r"\\\1", " ".join(text.split()))


def as_code(line: str) -> str:
    """A line of an indented block of code: without breaks, its own indentation kept."""
    indent = len(line) - len(line.lstrip(" "))
    return " " * indent + " ".join(line.split())
