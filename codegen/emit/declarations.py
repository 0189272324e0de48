"""Declarations in C: signatures, the named parts of arrays, and lines of a readable length."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from codegen.emit.routine import Parameter

WIDTH = 116


def declaration(symbol: str, declared: Sequence[Parameter], leading: Sequence[str] = (), kind: str = "void") -> str:
    """Declaration of a function, with further parameters before; lines break between parameters only."""
    kinds = {"in": "const jg_real *JG_RESTRICT", "out": "jg_real *JG_RESTRICT"}
    words = [*leading, *(f"{kinds[p.direction]} {p.name}" for p in declared)]
    lines = [f"{kind} {symbol}("]
    for k, word in enumerate(words):
        piece = word + (", " if k + 1 < len(words) else ")")
        if len(lines[-1]) + len(piece.rstrip()) > WIDTH:
            lines.append("    ")
        lines[-1] += piece
    return "\n".join(line.rstrip() for line in lines)


def views(declared: Sequence[Parameter]) -> dict[str, tuple[tuple[str, int, int], ...]]:
    """Argument -> (name, offset, length) of the parts of compound arguments."""
    return {
        p.name: tuple((name, offset, shape[0] * shape[1]) for name, offset, shape, _ in p.members)
        for p in declared
        if p.members and p.direction == "in"
    }


def unpacking(declared: Sequence[Parameter], used: set[str]) -> list[str]:
    """Name the parts of compound arguments."""
    lines = []
    for parameter in declared:
        for name, offset, shape, _ in parameter.members:
            if name not in used or parameter.direction != "in":
                continue
            if shape == (1, 1):
                lines.append(f"const jg_real {name} = {parameter.name}[{offset}];")
            else:
                lines.append(f"const jg_real *const {name} = {parameter.name}{f' + {offset}' if offset else ''};")
    return lines


def wrapped(lines: Sequence[str], indent: int = 4) -> list[str]:
    """Break statements that are too long for a line."""
    width = WIDTH - indent
    wrapper = textwrap.TextWrapper(width, subsequent_indent="    ", break_long_words=False, break_on_hyphens=False)
    broken: list[str] = []
    for line in lines:
        broken += [line] if len(line) <= width else wrapper.wrap(line)
    return broken
