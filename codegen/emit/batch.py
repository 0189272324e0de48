"""Emit the batch routines: the program of a routine over vectors, one lane a joint, or a pose.

One kernel a routine, with a stride between the entries of an array, serves both layouts: groups (AoSoA), where the
stride is the number of lanes, and whole arrays (SoA), where it is the leading dimension.
"""

from __future__ import annotations

import hashlib
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from codegen.emit.declarations import declaration, views, wrapped
from codegen.emit.environment import render
from codegen.emit.guarded import Guard, batch_guard, guard
from codegen.emit.routine import Parameter, Routine
from codegen.emit.statements import Notation, Statements
from codegen.ir.program import Program

VECTORS = Notation(
    number="jg_vector",
    read="JG_IN({array}, {index})",
    store="JG_OUT({array}, {index})",
    constant="jg_splat({literal})",
    suffix="_batch",
    together=1,
)

_WIDTH = 112

GROUPS = "aosoa"
ARRAYS = "soa"

LAYOUTS: dict[str, str] = {
    GROUPS: "entry k of joint j at [lanes * (length * (j / lanes) + k) + j % lanes]: groups of `lanes` joints",
    ARRAYS: "entry k of joint j at [k * ld + j], ld >= count",
}
"""How the manifest tells where a number stands."""


@dataclass(frozen=True, slots=True)
class BatchEntry:
    """One C function for many joints.

    Attributes:
        symbol: its name.
        scalar: name of the routine for one joint.
        layout: ``aosoa`` or ``soa``.
        leading: parameters before the arrays, by name.
        parameters: the arrays, as for one joint.
        comment: lines for the header.
    """

    symbol: str
    scalar: str
    layout: str
    leading: tuple[str, ...]
    parameters: tuple[Parameter, ...]
    comment: tuple[str, ...]

    @property
    def signature(self) -> str:
        """Return type, name and parameters, as declared."""
        return declaration(self.symbol, self.parameters, [f"long {name}" for name in self.leading])


@dataclass(frozen=True, slots=True)
class BatchRoutine:
    """The functions of one routine for many joints, and the text that defines them."""

    entries: tuple[BatchEntry, ...]
    text: str


def batch_routine(
    routine: Routine,
    declared: tuple[Parameter, ...],
    lanes: int,
    thing: str = "joint",
    check: Program | None = None,
) -> BatchRoutine:
    """Emit a routine for groups of ``lanes`` joints, for many such groups, and for arrays of joints.

    Args:
        routine: of which the program is evaluated; matrices as nonzeros.
        declared: parameters of the routine for one joint.
        lanes: joints in a group.
        thing: what there are many of.
        check: gives the conditions on the inputs of one that are asserted in debug builds.
    """
    symbol = f"{routine.symbol}_batch{lanes}"
    functions = _entries(routine.symbol, symbol, declared, lanes, thing)
    statements = Statements(routine.straight, views(declared), VECTORS)
    is_empty = not any(output.values for output in routine.straight.outputs)
    unused = ["(void)stride;"] if is_empty else []
    text = render(
        "c/batch_functions.c.j2",
        symbol=symbol,
        kernel=_static("JG_KERNEL", f"{symbol}_kernel", declared, "long stride"),
        strided=_static("static JG_OUT_OF_LINE", f"{symbol}_strided", declared, "long ld"),
        few=_static("static JG_OUT_OF_LINE", f"{symbol}_few", declared, "long count", "long ld"),
        signatures=[entry.signature for entry in functions],
        body=wrapped(_unpacking(declared, statements.used_views) + statements.lines + unused, indent=8),
        calls=_calls(symbol, declared),
        guard="" if check is None else batch_guard(symbol, declared, check),
        asserted={} if check is None else _assertions(symbol, guard(symbol, declared, check)),
        parameters=declared,
    )
    return BatchRoutine(functions, text)


def batch_record(entry: BatchEntry, text: str, header: str, source: str, lanes: int) -> dict[str, Any]:
    """Describe one function for the manifest.

    Args:
        entry: the function.
        text: definition of all functions of its routine.
        header: path of its header, from the folder of the manifest.
        source: path of its source, from the folder of the manifest.
        lanes: joints in a group.
    """
    return {
        "symbol": entry.symbol,
        "routine": entry.scalar,
        "header": header,
        "source": source,
        "lanes": lanes,
        "layout": entry.layout,
        "counts": list(entry.leading),
        "arguments": [{"name": p.name, "direction": p.direction, "length": p.length} for p in entry.parameters],
        "sha256": hashlib.sha256(text.encode()).hexdigest(),
    }


def _entries(
    scalar: str, symbol: str, declared: tuple[Parameter, ...], lanes: int, thing: str
) -> tuple[BatchEntry, ...]:
    same = f"The arrays are those of {scalar}"
    count = f"@param[in] count number of {thing}s"
    ld = f"@param[in] ld {thing}s between two entries of one {thing}, at least count; a power of two is slow"
    group = _comment(f"{scalar} for a group of {lanes} {thing}s", f"{same}: entry k of {thing} l at [{lanes} * k + l].")
    filling = "All of the last group is read and written, also where it is not full."
    loop = _comment(
        f"{scalar} for groups of {lanes} {thing}s", f"{same}, group after group as {symbol} has them. {filling}", count
    )
    arrays = _comment(f"{scalar} for arrays of {thing}s", f"{same}: entry k of {thing} j at [k * ld + j].", count, ld)
    return (
        BatchEntry(symbol, scalar, GROUPS, (), declared, group),
        BatchEntry(f"{symbol}_loop", scalar, GROUPS, ("count",), declared, loop),
        BatchEntry(f"{symbol}_soa", scalar, ARRAYS, ("count", "ld"), declared, arrays),
    )


def _comment(brief: str, words: str, *parameters: str) -> tuple[str, ...]:
    lines = [*textwrap.wrap(f"@brief {brief}.", _WIDTH), "", *textwrap.wrap(words, _WIDTH)]
    return (*lines, *parameters)


def _static(kind: str, symbol: str, declared: Sequence[Parameter], *leading: str) -> str:
    return declaration(symbol, declared, leading, f"{kind} void")


def _calls(symbol: str, declared: Sequence[Parameter]) -> dict[str, list[str]]:
    """The calls between the functions of a routine, as lines."""
    names = [p.name for p in declared]
    arguments: dict[str, tuple[str, list[str]]] = {
        "group": ("kernel", ["JG_BATCH", *names]),
        "loop": ("", [f"{p.name} + {p.length} * first" for p in declared]),
        "inside": ("kernel", ["JG_BATCH", *(f"{p.name} + {p.length} * first" for p in declared)]),
        "strided": ("kernel", ["ld", *names]),
        "few": ("", [f"{name}_group" for name in names]),
        "first": ("strided", ["ld", *(f"{name} + first" for name in names)]),
        "last": ("strided", ["ld", *(f"{name} + last" for name in names)]),
        "rest": ("few", ["count", "ld", *names]),
    }
    return {call: _call(symbol, *called) for call, called in arguments.items()}


def _assertions(symbol: str, made: Guard) -> dict[str, list[str]]:
    """The calls that assert the domain, as lines."""
    names = [p.name for p in made.inputs]
    arguments = {
        "group": ["JG_BATCH", "JG_BATCH", *names],
        "loop": [
            "left < JG_BATCH ? left : JG_BATCH",
            "JG_BATCH",
            *(f"{p.name} + {p.length} * first" for p in made.inputs),
        ],
        "strided": ["JG_BATCH", "ld", *names],
    }
    return {place: _call(symbol, "assert", passed) for place, passed in arguments.items()}


def _call(symbol: str, function: str, passed: Sequence[str]) -> list[str]:
    return wrapped([f"{symbol}{f'_{function}' if function else ''}({', '.join(passed)});"], indent=12)


def _unpacking(declared: Sequence[Parameter], used: set[str]) -> list[str]:
    """Name the parts of compound arguments."""
    lines = []
    for parameter in (p for p in declared if p.direction == "in"):
        for name, offset, shape, _ in parameter.members:
            if name in used and shape == (1, 1):
                place = VECTORS.read.format(array=parameter.name, index=offset)
                lines.append(f"const jg_vector {name} = {place};")
            elif name in used:
                place = f" + {offset} * stride" if offset else ""
                lines.append(f"const jg_real *const {name} = {parameter.name}{place};")
    return lines
