"""Numbers of a sweep in a file, so that memory holds a few pieces of it, however many poses there are."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np

from codegen.errors import Mistake, OutputError
from codegen.platforms.attitudes import Array

CHUNK = 10_000
"""Poses of one piece: the arrays of a call stay in the caches of a core; no power of two, which would be slow."""

_BYTES = 8


@dataclass(frozen=True)
class Spool:
    """Doubles [columns, poses] in a file without a name, gone with the last who holds it.

    Attributes:
        columns: how many.
        count: of poses.
        file: column after column.
    """

    columns: int
    count: int
    file: IO[bytes]

    def put(self, first: int, values: Array) -> None:
        """Store values [columns, n] of the poses from the first on; threads may do so at once.

        Raises:
            OutputError: there is no room.
        """
        try:
            for k, row in enumerate(np.ascontiguousarray(values, dtype=np.float64)):
                os.pwrite(self.file.fileno(), row.tobytes(), self._place(k, first))
        except OSError as error:
            what = f"{self.count} poses cannot be stored ({error.strerror or error})"
            raise OutputError([Mistake("results", what, "make room, or give fewer poses")]) from error

    def rows(self, first: int, last: int) -> Array:
        """The values [columns, n] of some poses."""
        return np.array([self.column(k, first, last) for k in range(self.columns)])

    def column(self, k: int, first: int = 0, last: int | None = None) -> Array:
        """Values of a column, read from the file when they are looked at."""
        length = (self.count if last is None else last) - first
        return np.memmap(self.file, np.float64, "r", self._place(k, first), (length,)) if length else np.empty(0)

    def _place(self, k: int, pose: int) -> int:
        return _BYTES * (k * self.count + pose)


def spool(columns: int, count: int, folder: Path | None = None) -> Spool:
    """An empty spool in a folder, or in that for temporary files."""
    return Spool(columns, count, tempfile.TemporaryFile(dir=folder))  # noqa: SIM115: it lives as long as the spool


def pieces(count: int) -> Iterator[tuple[int, int]]:
    """First pose and end of each piece."""
    return ((first, min(first + CHUNK, count)) for first in range(0, count, CHUNK))
