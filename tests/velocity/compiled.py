"""The emitted C of a platform, compiled and called with arrays of numpy."""

from __future__ import annotations

import ctypes
import json
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

STRICT = (
    *("-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wmissing-prototypes"),
    *("-Wdouble-promotion", "-Werror", "-ffp-contract=off"),
)


def unpacked(files: dict[str, bytes], folder: Path) -> dict[str, Any]:
    """Write a package; give its manifest."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    manifest: dict[str, Any] = json.loads(files["manifest.json"])
    return manifest


def library(folder: Path, sources: Sequence[str], flags: Sequence[str] = ()) -> ctypes.CDLL:
    """Compile sources to a library without a warning."""
    binary = folder / f"{'_'.join(sources)}.so"
    command = [
        "gcc",
        *STRICT,
        "-O1",
        *flags,
        "-shared",
        "-fPIC",
        *(str(folder / s) for s in sources),
        "-o",
        str(binary),
    ]
    subprocess.run([*command, "-lm"], check=True, capture_output=True, text=True)
    return ctypes.CDLL(str(binary))


def call(function: Any, leading: Sequence[int], arrays: Sequence[Any]) -> None:
    """Call a function with counts, then arrays."""
    function.restype = None
    counts = [ctypes.c_long(n) for n in leading]
    function(*counts, *(ctypes.c_void_p(array.ctypes.data) for array in arrays))


def record(manifest: dict[str, Any], symbol: str) -> dict[str, Any]:
    found: dict[str, Any] = next(f for f in manifest["functions"] if f["symbol"] == symbol)
    return found


def zeros(lengths: Sequence[int], count: int, kind: Any) -> list[Any]:
    return [np.zeros((length, count), dtype=kind) for length in lengths]
