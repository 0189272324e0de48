"""Routines that assert the domain of their inputs where ``JG_ASSERT_DOMAIN`` is defined: for debug builds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from codegen.emit.c import Entry, definition
from codegen.emit.declarations import declaration, wrapped
from codegen.emit.environment import render
from codegen.emit.routine import Parameter
from codegen.ir.program import Program


@dataclass(frozen=True, slots=True)
class Guard:
    """The C function that counts the conditions that the inputs of a routine break.

    Attributes:
        symbol: its name.
        name: of the array with the count.
        inputs: the arrays of the routine that it takes.
        text: its definition.
    """

    symbol: str
    name: str
    inputs: tuple[Parameter, ...]
    text: str

    def call(self, ending: str = "") -> str:
        """The call with arrays named as in the signature, and an ending."""
        return f"{self.symbol}({', '.join([*(p.name + ending for p in self.inputs), self.name])});"


def guard(symbol: str, declared: Sequence[Parameter], check: Program) -> Guard:
    """Write the function of a check.

    Args:
        symbol: of the routine.
        declared: its parameters.
        check: gives the number of conditions that are broken.
    """
    (output,) = check.outputs
    taken = {argument.name for argument in check.used_arguments()}
    inputs = tuple(p for p in declared if p.direction == "in" and p.name in taken)
    outside = Parameter(output.name, "out", (1, 1), 1, "column-major", "conditions broken", "1")
    name = f"{symbol}_{output.name}"
    text, _ = definition(name, (*inputs, outside), check, "static void")
    return Guard(name, output.name, inputs, text)


def guarded(entry: Entry, check: Program) -> Entry:
    """Let a function assert what its bounds assume.

    Args:
        entry: the function; those that store dense matrices call it.
        check: of the same arguments, gives the number of conditions that are broken.
    """
    made = guard(entry.symbol, entry.parameters, check)
    head, _, body = entry.text.rpartition("\n{\n")  # functions that loops call come before
    asserted = render("c/guarded.c.j2", check=made.text, head=head, body=body, name=made.name, call=made.call())
    return replace(entry, text=asserted)


def batch_guard(symbol: str, declared: Sequence[Parameter], check: Program) -> str:
    """Write a function that asserts the domain of the first joints of a group, or of as many at any distance.

    Args:
        symbol: of the routine for a group; the function has the ending ``_assert`` and the leading parameters ``count``
            and ``ld``, ``ld`` numbers between two entries of one joint, before the arrays of `guard`.
        declared: parameters of the routine for one joint.
        check: gives the number of conditions that are broken.
    """
    made = guard(symbol, declared, check)
    return render(
        "c/batch_guard.c.j2",
        check=made.text,
        signature=declaration(f"{symbol}_assert", made.inputs, ["long count", "long ld"], "static void"),
        inputs=made.inputs,
        name=made.name,
        call=wrapped([made.call("_one")], indent=8),
    )
