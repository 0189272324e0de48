"""The results of a sweep as files."""

from __future__ import annotations

import io
from collections.abc import Sequence

import numpy as np

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.platforms.attitudes import Array

FORMATS = ("csv", "npz")


def check_format(name: str) -> None:
    """Refuse a format that there is not.

    Raises:
        SpecificationError: there is none of that name.
    """
    if name not in FORMATS:
        raise SpecificationError([Mistake("--format", f'there is no "{name}"', nearest(name, FORMATS))])


def results_file(columns: Sequence[str], found: Array, kind: str) -> dict[str, bytes]:
    """The file of a sweep: ``poses.csv`` (17 digits) or ``poses.npz`` (an array a column).

    Args:
        columns: their names.
        found: [columns, poses].
        kind: of `FORMATS`.
    """
    if kind == "npz":
        return {"poses.npz": _npz(columns, found)}
    text = io.StringIO()
    text.write(",".join(columns) + "\n")
    np.savetxt(text, found.T, fmt="%.17g", delimiter=",")
    return {"poses.csv": text.getvalue().encode()}


def _npz(columns: Sequence[str], found: Array) -> bytes:
    """Without the time of writing, which numpy puts as 1980 itself."""
    data = io.BytesIO()
    np.savez(data, **dict(zip(columns, found, strict=True)))
    return data.getvalue()
