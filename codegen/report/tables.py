"""Tables for the terminal, made with rich; plain in a pipe."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence

from rich.console import Console
from rich.table import Table

from flopcount.compare import COLUMNS, ComparisonRow

_PIPE_WIDTH = 160


def console() -> Console:
    """Give the console for results on stdout: as wide as the terminal, or wide enough for every table in a pipe."""
    return Console(width=None if sys.stdout.isatty() else _PIPE_WIDTH, highlight=False)


def comparison_table(rows: Sequence[ComparisonRow], derivative: str) -> Table:
    """S1 Table 7 for one derivative: printed counts, then ours with their rates."""
    table = Table(
        title=f"S1 Table 7, {derivative}: operations as printed and as emitted (rates in % of the conventional form)",
        title_justify="left",
    )
    table.add_column("joint")
    for words in ("paper conv.", "paper param.", "rate"):
        table.add_column(words, justify="right")
    for _, words in COLUMNS:
        table.add_column(words, justify="right", overflow="fold")
    for row in rows:
        if row.derivative == derivative:
            table.add_row(*_cells(row))
    return table


def _cells(row: ComparisonRow) -> list[str]:
    printed = [_number(row.printed_conventional), _number(row.printed_parametric), _percent(row.printed_rate)]
    ours = []
    for column, _ in COLUMNS:
        counts = row.emitted.get(column)
        rate = row.rate(column)
        ours.append("" if counts is None else f"{counts.total}" + (f" ({rate:.0f}%)" if rate is not None else ""))
    return [row.joint, *printed, *ours]


def _number(value: int | None) -> str:
    return "-" if value is None else str(value)


def _percent(value: float | None) -> str:
    return "-" if value is None else f"{value:.1f}%"


def catalogue_table(rows: Sequence[Mapping[str, object]]) -> Table:
    """The catalogue of joints."""
    table = Table(title="Joints", title_justify="left")
    for name in rows[0]:
        table.add_column(name.replace("_", " "), overflow="fold")
    for row in rows:
        table.add_row(*(str(value) for value in row.values()))
    return table
