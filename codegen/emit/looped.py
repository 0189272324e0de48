"""Loops in C: a static function for one instance, and a loop that moves its pointers from instance to instance."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.emit.declarations import heading, unpacking, views, wrapped
from codegen.emit.environment import render
from codegen.emit.literals import literal
from codegen.emit.packed import packed
from codegen.emit.routine import Member, Parameter, Subject
from codegen.emit.statements import Statements
from codegen.ir.looped import GEOMETRY, Loop, Looped
from codegen.ir.ops import Constant
from codegen.passes.flatten import Flat, Piece, flatten

_WIDTH = 104


def looped_definition(signature: str, symbol: str, looped: Looped, subject: Subject) -> tuple[str, int]:
    """Write the C functions of loops; gives their text and the largest number of temporaries of an instance.

    Args:
        signature: of the function that runs all loops.
        symbol: its name.
        looped: what it evaluates.
        subject: names the parts of the arrays of an instance.
    """
    texts, body, temporaries = [], list[str](), 0
    for number, loop in enumerate(looped.loops):
        flat = flatten(looped, loop)
        if not flat.outputs:
            continue
        name = f"{symbol}_part_{number + 1}"
        text, own = _part(name, loop, flat, subject)
        texts.append(text)
        body += _run(name, loop, flat, number)
        temporaries = max(temporaries, own)
    body += [f"(void){output.name};" for output in looped.outputs if not output.sparsity.nonzeros]
    texts.append(render("c/function.c.j2", signature=signature, body=body))
    return "\n".join(texts), temporaries


def _part(symbol: str, loop: Loop, flat: Flat, subject: Subject) -> tuple[str, int]:
    declared = [_input(piece, loop, subject) for piece in flat.inputs]
    declared += [_parameter(piece, "out") for piece in flat.outputs]
    if _reads_table(flat):
        declared.insert(0, _parameter(Piece(GEOMETRY, GEOMETRY, 0, len(loop.geometry[0]), 0, 0), "in"))
    statements = Statements(flat.program, views(declared))
    body = unpacking(declared, statements.used_views) + wrapped(statements.lines)
    signature = heading(symbol, declared, flat.program, "static void")
    return render("c/function.c.j2", signature=signature, body=body), statements.temporaries


def _input(piece: Piece, loop: Loop, subject: Subject) -> Parameter:
    last = piece.first + piece.length
    argument = next(a for a in loop.program.arguments if a.name == piece.array)
    members = tuple(
        (name, offset - piece.first, shape, words)
        for name, offset, shape, words in subject.part(loop.kind).argument(argument).members
        if piece.first <= offset and offset + shape[0] * shape[1] <= last
    )
    return _parameter(piece, "in", members)


def _parameter(piece: Piece, direction: str, members: tuple[Member, ...] = ()) -> Parameter:
    return Parameter(piece.name, direction, (piece.length, 1), piece.length, "column-major", "", "", members)


def _reads_table(flat: Flat) -> bool:
    return any(argument.name == GEOMETRY for argument in flat.program.used_arguments())


def _run(symbol: str, loop: Loop, flat: Flat, number: int) -> list[str]:
    """The statements that run a loop."""
    table = f"geometry_{number + 1}"
    is_loop = loop.count > 1
    passed = [_pointer(piece, is_loop) for piece in (*flat.inputs, *flat.outputs)]
    lines = []
    if _reads_table(flat):
        passed.insert(0, f"{table}[k]" if is_loop else f"{table}[0]")
        lines += _table(table, loop.geometry)
    call = wrapped([f"{symbol}({', '.join(passed)});"], 8)
    if not is_loop:
        return lines + call
    return [*lines, f"for (int k = 0; k < {loop.count}; ++k) {{", *(f"    {line}" for line in call), "}"]


def _pointer(piece: Piece, is_loop: bool) -> str:
    start = f" + {piece.start}" if piece.start else ""
    return f"{piece.array}{start}{f' + {piece.stride} * k' if is_loop and piece.stride else ''}"


def _table(name: str, rows: Sequence[Sequence[Constant]]) -> list[str]:
    words = [word for row in rows for word in _braced([literal(value) for value in row])]
    size = f"[{len(rows)}][{len(rows[0])}]"
    lines = packed(words, _WIDTH)
    return [f"static const jg_real {name}{size} = {{", *(f"    {line}" for line in lines), "};"]


def _braced(words: list[str]) -> list[str]:
    first, *rest = words
    return [f"{{{first}", *rest[:-1], f"{rest[-1]}}}"] if rest else [f"{{{first}}}"]
