"""Doxygen comments: shapes, frames, units, equations and counts of every function."""

from __future__ import annotations

import textwrap

from codegen.emit.c import Entry
from codegen.emit.routine import Parameter

_WIDTH = 112


def comment(entry: Entry) -> list[str]:
    """Write the comment of one function as lines."""
    routine = entry.routine
    lines = _wrapped(f"@brief {routine.subject.brief(routine.output)}")
    details = routine.subject.details(routine.output, routine.program, routine.preparation)
    lines += ["", *_wrapped(" ".join(details))]
    lines += [line for parameter in entry.parameters for line in _parameter(parameter)]
    lines += [f"@note Operations: {routine.counts}; temporaries: {entry.temporaries}."]
    lines += _wrapped(f"@see {routine.equations}")
    return lines


def _parameter(parameter: Parameter) -> list[str]:
    rows, columns = parameter.shape
    shape = f"[{rows}]" if columns == 1 else f"[{rows} x {columns}] {parameter.layout}"
    stored = f", {parameter.length} nonzeros" if parameter.layout == "compressed-columns" else ""
    lines = _wrapped(
        f"@param[{parameter.direction}] {parameter.name} {shape}{stored}; {parameter.frame}; {parameter.unit}"
    )
    for name, offset, (nrow, ncol), meaning in parameter.members:
        size = f"[{nrow}]" if ncol == 1 else f"[{nrow} x {ncol}]"
        count, stride = parameter.repeats.get(offset, (1, 0))
        again = f"; {count} times, every {stride} entries" if count > 1 else ""
        lines += _wrapped(f"  [{offset}] {name} {size} {meaning}{again}")
    return lines


def _wrapped(text: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False)
