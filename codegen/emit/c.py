"""Emit C: a header a joint, a source a variant, by the ABI of DESIGN 3.2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from codegen.emit.declarations import WIDTH, declaration, heading, unpacking, views, wrapped
from codegen.emit.environment import render
from codegen.emit.looped import looped_definition
from codegen.emit.packed import packed
from codegen.emit.parameters import parameters
from codegen.emit.routine import Parameter, Routine, Subject
from codegen.emit.statements import Statements
from codegen.ir.looped import Looped
from codegen.ir.program import Program, Result, Sparsity


@dataclass(frozen=True, slots=True)
class Entry:
    """One C function.

    Attributes:
        symbol: its name.
        storage: ``vector``, ``nz`` or ``dense``.
        routine: what it evaluates.
        parameters: of its signature.
        temporaries: number of local values.
        text: its definition.
    """

    symbol: str
    storage: str
    routine: Routine
    parameters: tuple[Parameter, ...]
    temporaries: int
    text: str

    @property
    def signature(self) -> str:
        """Return type, name and parameters, as declared."""
        return declaration(self.symbol, self.parameters)


def entries(routine: Routine) -> tuple[Entry, ...]:
    """Emit the functions of a routine: vectors have one entry, matrices one for nonzeros and one for dense storage."""
    stored = parameters(routine, dense=False)
    text, temporaries = any_definition(routine.symbol, stored, routine.program, routine.subject)
    storage = "nz" if routine.is_matrix else "vector"
    first = Entry(routine.symbol, storage, routine, stored, temporaries, text)
    return (first, _dense_entry(routine, stored)) if routine.is_matrix else (first,)


def any_definition(
    symbol: str, declared: Sequence[Parameter], program: Program | Looped, subject: Subject, kind: str = "void"
) -> tuple[str, int]:
    """Write a C function that evaluates a program, or loops over programs.

    Args:
        symbol: its name.
        declared: its parameters.
        program: what it evaluates; loops have static functions of their own before it.
        subject: names the parts of arrays.
        kind: ``void`` or ``static void``.
    """
    if isinstance(program, Looped):
        return looped_definition(declaration(symbol, declared, kind=kind), symbol, program, subject)
    return definition(symbol, declared, program, kind)


def definition(symbol: str, declared: Sequence[Parameter], program: Program, kind: str = "void") -> tuple[str, int]:
    """Write a C function that evaluates a program and stores nonzeros; gives its text and number of temporaries."""
    statements = Statements(program, views(declared))
    body = unpacking(declared, statements.used_views) + wrapped(statements.lines)
    text = render("c/function.c.j2", signature=heading(symbol, declared, program, kind), body=body)
    return text, statements.temporaries


def sparsity_symbol(routine: Routine, output: Result) -> str:
    """Name of the function that gives the pattern of an output."""
    return f"{routine.subject.stem}_{output.name}_sparsity"


def sparsity_functions(routine: Routine) -> tuple[tuple[str, str, Sparsity], ...]:
    """Symbol, text and pattern of the functions that export the patterns of a single-quantity routine."""
    return tuple(
        (
            sparsity_symbol(routine, output),
            render(
                "c/sparsity.c.j2",
                symbol=sparsity_symbol(routine, output),
                rows=_pattern_rows(output.sparsity),
            ),
            output.sparsity,
        )
        for output in routine.program.outputs
        if output.sparsity.ncol > 1
    )


def _pattern_rows(pattern: Sparsity) -> list[str]:
    numbers = (pattern.nrow, pattern.ncol, *pattern.colind, *pattern.row)
    return packed([str(number) for number in numbers], WIDTH - 8)


def _dense_entry(routine: Routine, stored: tuple[Parameter, ...]) -> Entry:
    dense = parameters(routine, dense=True)
    matrices = [p for p in stored if p.layout == "compressed-columns"]
    text = render(
        "c/dense.c.j2",
        signature=declaration(routine.dense_symbol, dense),
        call=wrapped([f"{routine.symbol}({', '.join(_passed(p, matrices) for p in stored)});"]),
        matrices=[(p.name, p.length, sparsity_symbol(routine, routine.program.output(p.name))) for p in matrices],
    )
    temporaries = sum(p.length for p in matrices)
    return Entry(routine.dense_symbol, "dense", routine, dense, temporaries, text)


def _passed(parameter: Parameter, matrices: Sequence[Parameter]) -> str:
    return f"{parameter.name}_nz" if parameter in matrices else parameter.name
