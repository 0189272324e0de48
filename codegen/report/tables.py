"""Show sheets: on the terminal with rich, or as Markdown."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table

from codegen.report.sheets import Sheet

_PIPE_WIDTH = 160


def console() -> Console:
    """Give the console for results on stdout: as wide as the terminal, or wide enough for every table in a pipe."""
    return Console(width=None if sys.stdout.isatty() else _PIPE_WIDTH, highlight=False)


def show(sheets: Sequence[Sheet]) -> None:
    """Print sheets to stdout."""
    out = console()
    for sheet in sheets:
        table = Table(title=sheet.title, title_justify="left", caption="\n".join(sheet.notes), caption_justify="left")
        for k, heading in enumerate(sheet.columns):
            is_number = k > 0 and all(_is_number(row[k]) for row in sheet.rows)
            table.add_column(heading, justify="right" if is_number else "left", overflow="fold")
        for row in sheet.rows:
            table.add_row(*row)
        out.print(table)


def _is_number(cell: str) -> bool:
    return not cell or cell == "-" or cell[0].isdigit()


def markdown(sheet: Sheet) -> str:
    """Write a sheet as a Markdown section."""
    lines = [f"## {sheet.title}", ""]
    lines.append(f"| {' | '.join(_escaped(heading) for heading in sheet.columns)} |")
    lines.append("|" + "---|" * len(sheet.columns))
    lines += [f"| {' | '.join(_escaped(cell) for cell in row)} |" for row in sheet.rows]
    lines += ["", *sheet.notes] if sheet.notes else []
    return "\n".join(lines) + "\n"


def _escaped(text: str) -> str:
    return text.replace("|", "\\|")


def catalogue(rows: Sequence[Mapping[str, object]]) -> Sheet:
    """The catalogue of joints."""
    cells = tuple(
        tuple(", ".join(value) if isinstance(value, list) else str(value) for value in row.values()) for row in rows
    )
    return Sheet("Joints", tuple(name.replace("_", " ") for name in rows[0]), cells)
