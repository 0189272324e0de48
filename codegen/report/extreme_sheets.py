"""Tables of extremes as sheets and files."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from codegen.report.sheets import Sheet
from codegen.report.tables import markdown
from codegen.simulate.limits import run_manifest


def extreme_sheets(document: Mapping[str, Any]) -> list[Sheet]:
    """A sheet for each table."""
    return [
        Sheet(
            table["title"],
            tuple(table["rows"][0]),
            tuple(tuple(_cell(value) for value in row.values()) for row in table["rows"]),
            tuple(table["notes"]),
        )
        for table in document.values()
    ]


def extreme_files(document: Mapping[str, Any]) -> dict[str, bytes]:
    """Path -> content."""
    texts = {
        "manifest.json": run_manifest("extremes", "all"),
        "extremes.json": json.dumps(document, indent=1) + "\n",
        "extremes.md": "# Extremes\n\n" + "\n".join(markdown(sheet) for sheet in extreme_sheets(document)),
    }
    return {path: text.encode() for path, text in texts.items()}


def _cell(value: str | float) -> str:
    if isinstance(value, str):
        return value
    return f"{value:.1e}" if 0 < abs(value) < 0.05 or abs(value) >= 1e5 else f"{value:.2f}".rstrip("0").rstrip(".")
