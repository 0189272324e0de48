"""A CSV of numbers as a table that is mapped: memory holds a few thousand lines of it, however long it is."""

from __future__ import annotations

import tempfile
from itertools import chain, islice
from pathlib import Path

import numpy as np

from codegen.platforms.attitudes import Array
from codegen.platforms.headings import is_pose
from codegen.platforms.spool import CHUNK


def table_of_csv(file: Path) -> Array:
    """Read numbers [rows, columns] piece by piece into a file without a name, which is gone with the table.

    Args:
        file: a line of names or none, then lines of numbers with commas between.

    Raises:
        OSError: it cannot be read, or there is no room for the numbers.
        ValueError: a line is none of numbers, or has another number of them than the first.
    """
    rows = columns = 0
    with tempfile.TemporaryFile() as numbers:
        with file.open(encoding="utf-8") as lines:
            first = next(lines, "")
            left = chain([first] if is_pose(first) else [], lines)
            while piece := list(islice(left, CHUNK)):
                written = [line for line in piece if line.strip()]
                if not written:
                    continue
                table = _read(written, rows)
                columns = columns or table.shape[1]
                if table.shape[1] != columns:
                    raise ValueError(f"row {rows + 1} has {table.shape[1]} columns, the first one has {columns}")
                numbers.write(table.tobytes())
                rows += len(table)
        numbers.flush()
        return np.memmap(numbers, np.float64, "r", 0, (rows, columns)) if rows else np.empty((0, 0))


def _read(lines: list[str], before: int) -> Array:
    try:
        return np.loadtxt(lines, delimiter=",", comments=None, ndmin=2)
    except ValueError as error:
        raise ValueError(f"{error}, counted from row {before}" if before else str(error)) from error
