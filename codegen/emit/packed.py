"""Lists of words in lines, for tables and patterns: as `textwrap` would break them, in a fraction of the time."""

from __future__ import annotations

from collections.abc import Sequence


def packed(words: Sequence[str], width: int) -> list[str]:
    """Put words into lines of at most ``width`` columns, with commas between them.

    Args:
        words: without spaces, none as long as a line.
        width: of a line.
    """
    lines: list[str] = []
    line: list[str] = []
    used = 0
    for position, word in enumerate(words):
        is_last = position + 1 == len(words)
        if line and used + len(word) + (0 if is_last else 1) > width:
            lines.append(", ".join(line) + ",")
            line, used = [], 0
        line.append(word)
        used += len(word) + 2
    return [*lines, ", ".join(line)] if line else lines
