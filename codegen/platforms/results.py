"""The results of a sweep as files."""

from __future__ import annotations

import zipfile
from collections.abc import Sequence
from typing import IO

import numpy as np

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.output import Writer
from codegen.platforms.spool import Spool, pieces

FORMATS = ("csv", "npz")


def check_format(name: str) -> None:
    """Refuse a format that there is not.

    Raises:
        SpecificationError: there is none of that name.
    """
    if name not in FORMATS:
        raise SpecificationError([Mistake("--format", f'there is no "{name}"', nearest(name, FORMATS))])


def results_file(columns: Sequence[str], found: Spool, kind: str) -> dict[str, Writer]:
    """The file of a sweep: ``poses.csv`` (17 digits) or ``poses.npz`` (an array a column), written piece by piece.

    Args:
        columns: their names.
        found: [columns, poses].
        kind: of `FORMATS`.
    """
    write = {"npz": _npz, "csv": _csv}[kind]
    return {f"poses.{kind}": lambda file: write(columns, found, file)}


def _csv(columns: Sequence[str], found: Spool, file: IO[bytes]) -> None:
    file.write((",".join(columns) + "\n").encode())
    for first, last in pieces(found.count):
        np.savetxt(file, found.rows(first, last).T, fmt="%.17g", delimiter=",")


def _npz(columns: Sequence[str], found: Spool, file: IO[bytes]) -> None:
    """As numpy has it: a file a column, of 1980, not compressed."""
    kind = {
        "descr": np.lib.format.dtype_to_descr(np.dtype(np.float64)),
        "fortran_order": False,
        "shape": (found.count,),
    }
    with zipfile.ZipFile(file, "w") as archive:
        for k, name in enumerate(columns):
            with archive.open(zipfile.ZipInfo(f"{name}.npy"), "w", force_zip64=True) as entry:
                np.lib.format.write_array_header_1_0(entry, kind)
                for first, last in pieces(found.count):
                    entry.write(found.column(k, first, last).tobytes())
