"""Routines that assert the domain of their inputs where ``JG_ASSERT_DOMAIN`` is defined: for debug builds."""

from __future__ import annotations

from dataclasses import replace

from codegen.emit.c import Entry, definition
from codegen.emit.environment import render
from codegen.emit.routine import Parameter
from codegen.ir.program import Program


def guarded(entry: Entry, check: Program) -> Entry:
    """Let a function assert what its bounds assume.

    Args:
        entry: the function; those that store dense matrices call it.
        check: of the same arguments, gives the number of conditions that are broken.
    """
    (output,) = check.outputs
    taken = {argument.name for argument in check.used_arguments()}
    inputs = [p for p in entry.parameters if p.direction == "in" and p.name in taken]
    outside = Parameter(output.name, "out", (1, 1), 1, "column-major", "conditions broken", "1")
    symbol = f"{entry.symbol}_{output.name}"
    text, _ = definition(symbol, (*inputs, outside), check, "static void")
    head, _, body = entry.text.partition("\n{\n")
    call = f"{symbol}({', '.join([*(p.name for p in inputs), output.name])});"
    asserted = render("c/guarded.c.j2", check=text, head=head, body=body, name=output.name, call=call)
    return replace(entry, text=asserted)
