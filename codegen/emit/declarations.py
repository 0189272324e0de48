"""Declarations in C: signatures, the named parts of arrays, and lines of a readable length."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

from codegen.emit.registers import is_better_read_again
from codegen.emit.routine import Parameter
from codegen.emit.statements import TOGETHER
from codegen.ir.program import Program

WIDTH = 116


def declaration(symbol: str, declared: Sequence[Parameter], leading: Sequence[str] = (), kind: str = "void") -> str:
    """Declaration of a function, with further parameters before; lines break between parameters only."""
    return _signature(symbol, declared, leading, kind, "*JG_RESTRICT ")


def heading(symbol: str, declared: Sequence[Parameter], program: Program, kind: str = "void") -> str:
    """Head of the definition of a declared function.

    Where it is better that the compiler reads inputs again, it does not repeat that arrays do not overlap.

    Args:
        symbol: its name.
        declared: its parameters.
        program: what it evaluates.
        kind: ``void`` or ``static void``.
    """
    pointer = "*" if is_better_read_again(program, TOGETHER) else "*JG_RESTRICT "
    return _signature(symbol, declared, (), kind, pointer)


def _signature(symbol: str, declared: Sequence[Parameter], leading: Sequence[str], kind: str, pointer: str) -> str:
    kinds = {"in": f"const jg_real {pointer}", "out": f"jg_real {pointer}"}
    words = [*leading, *(f"{kinds[p.direction]}{p.name}" for p in declared)]
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
