"""Compile the C sources a manifest names; call any routine with numpy arrays, from the manifest entry alone.

Input: `manifest.json` (SPEC of the entry: DESIGN 3.2), paths relative to its folder, headers under
`c/include`. Every argument is `const jg_real *` (in) or `jg_real *` (out), in the order of the C signature;
functions return void.  The cache directory belongs to the caller; objects and libraries in it are named by
content hash, so nothing is stale and several processes may share it.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
Entry = Mapping[str, Any]
STANDARD_FLAGS = ("-std=c99", "-O1", "-fPIC")
REAL = {
    "double": (np.float64, np.uint64, 0x7FF8_DEAD_BEEF_0001),
    "float": (np.float32, np.uint32, 0x7FC0_BEEF),
}
GUARD_WORDS = 16


class HarnessError(AssertionError):
    """A routine broke its contract (guards, inputs, unwritten outputs), or a call is against the manifest."""


@cache
def compiler_version(compiler: str) -> str:
    """First line of `compiler --version`."""
    run = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True)
    return run.stdout.splitlines()[0]


def digest(*parts: str | bytes) -> str:
    """Content hash of the parts, 24 hexadecimal digits."""
    sha = hashlib.sha256()
    for part in parts:
        data = part.encode() if isinstance(part, str) else part
        sha.update(str(len(data)).encode() + b":" + data)
    return sha.hexdigest()[:24]


def run_compiler(command: Sequence[str], target: Path) -> Path:
    """Run `command -o target` through a temporary file beside it; HarnessError quotes the compiler."""
    if target.exists():
        return target
    handle, name = tempfile.mkstemp(suffix=target.suffix, dir=target.parent)
    os.close(handle)
    run = subprocess.run([*command, "-o", name], capture_output=True, text=True, check=False)
    if run.returncode != 0:
        os.unlink(name)
        raise HarnessError(f"{' '.join(command)}\n{run.stderr}")
    os.replace(name, target)
    return target


def compile_library(
    root: Path, sources: Sequence[str], cache_dir: Path, flags: Sequence[str] = (), compiler: str = "gcc"
) -> Path:
    """Shared object in `cache_dir` of sources (relative to `root`); flags come after -std=c99 -O1 -fPIC."""
    cache_dir.mkdir(parents=True, exist_ok=True)
    include = root / "c" / "include"
    headers = b"".join(path.read_bytes() for path in sorted(include.rglob("*.h")))
    options = [compiler, *STANDARD_FLAGS, *flags, f"-I{include}"]
    stem = (compiler_version(compiler), " ".join(options), headers)

    def compile_one(source: str) -> Path:
        target = cache_dir / f"{digest(*stem, (root / source).read_bytes())}.o"
        return run_compiler([*options, "-c", str(root / source)], target)

    with ThreadPoolExecutor(max_workers=os.cpu_count()) as pool:
        objects = list(pool.map(compile_one, sources))
    target = cache_dir / f"{digest(*(path.name for path in objects), ' '.join(flags))}.so"
    return run_compiler([compiler, "-shared", *flags, *map(str, objects), "-lm"], target)


def expand(values: Array, sparsity: Mapping[str, Any]) -> Array:
    """Dense [nrow, ncol] matrix of compressed columns: values in the order of {nrow, ncol, colind, row}."""
    colind, row = sparsity["colind"], sparsity["row"]
    if len(values) != len(row) or len(colind) != sparsity["ncol"] + 1 or colind[-1] != len(row):
        raise HarnessError(f"{len(values)} values do not fit the sparsity pattern of {len(row)} entries")
    dense = np.zeros((sparsity["nrow"], sparsity["ncol"]), dtype=values.dtype)
    for column in range(sparsity["ncol"]):
        part = slice(colind[column], colind[column + 1])
        dense[row[part], column] = values[part]
    return dense


class Buffer:
    """One argument: `length` words between two walls of guard words; outputs start as a recognisable NaN."""

    def __init__(self, argument: Mapping[str, Any], real: str, values: Array | None) -> None:
        self.name, self.length = argument["name"], int(argument["length"])
        kind, word, pattern = REAL[real]
        self.pattern = word(pattern)
        self.words = np.full(self.length + 2 * GUARD_WORDS, self.pattern, dtype=word)
        self.data = self.words[GUARD_WORDS : GUARD_WORDS + self.length].view(kind)
        self.is_input = values is not None
        if values is not None:
            self.data[:] = values
        self.before = self.words.copy() if self.is_input else self.words

    def check(self) -> list[str]:
        """What the call did to this buffer that it should not have done."""
        inside = slice(GUARD_WORDS, GUARD_WORDS + self.length)
        broken = []
        for side, part in (("before", slice(0, inside.start)), ("behind", slice(inside.stop, None))):
            if np.any(self.words[part] != self.pattern):
                broken.append(f"{self.name}: wrote {side} the array of {self.length}")
        if self.is_input and np.any(self.words[inside] != self.before[inside]):
            broken.append(f"{self.name}: input changed")
        untouched = np.flatnonzero(self.words[inside] == self.pattern)
        if not self.is_input and untouched.size:
            broken.append(f"{self.name}: entries {untouched.tolist()} not written")
        return broken


def flatten(argument: Mapping[str, Any], value: Any) -> Array:
    """Argument words [length] from a vector or matrix of the manifest's shape, or an already flat vector."""
    array = np.asarray(value)
    if array.ndim > 1:
        if array.shape != tuple(argument["shape"]):
            raise HarnessError(f"{argument['name']}: shape {array.shape}, manifest says {argument['shape']}")
        array = array.ravel(order="F" if argument["layout"] == "column-major" else "C")
    if array.shape != (argument["length"],):
        raise HarnessError(f"{argument['name']}: {array.size} words, manifest says {argument['length']}")
    return array


def restore(entry: Entry, argument: Mapping[str, Any], words: Array, dense: bool) -> Array:
    """Output in its natural shape: compressed columns stay values [nnz] unless `dense`."""
    layout = argument["layout"]
    if layout == "compressed-columns":
        return expand(words, entry["sparsity"][argument["name"]]) if dense else words.copy()
    return words.reshape(argument["shape"], order="F" if layout == "column-major" else "C").copy()


class Library:
    """The compiled routines of one manifest."""

    def __init__(self, entries: Sequence[Entry], path: Path) -> None:
        self.entries = {entry["symbol"]: entry for entry in entries}
        if len(self.entries) != len(entries):
            raise HarnessError("the manifest names a symbol twice")
        self.path = path
        self._object = ctypes.CDLL(str(path))

    @classmethod
    def build(
        cls,
        manifest: Path,
        cache_dir: Path,
        *,
        flags: Sequence[str] = (),
        compiler: str = "gcc",
        select: Callable[[Entry], bool] | None = None,
    ) -> Library:
        """Compile the sources of the (selected) entries of `manifest`; flags follow the standard ones."""
        entries = [entry for entry in json.loads(manifest.read_text())["functions"] if select is None or select(entry)]
        sources = sorted({entry["source"] for entry in entries})
        return cls(entries, compile_library(manifest.parent, sources, cache_dir, flags, compiler))

    def find(self, **fields: Any) -> list[Entry]:
        """Entries whose fields have the given values, e.g. find(joint="ball", storage="nz")."""
        return [e for e in self.entries.values() if all(e.get(name) == value for name, value in fields.items())]

    def call(
        self, symbol: str, inputs: Mapping[str, Any], *, canary: bool = False, dense: bool = False
    ) -> dict[str, Array]:
        """Outputs by name; inputs by the manifest's names, matrices [row, column]; extra inputs are ignored.

        canary: check guard words round every argument, inputs unchanged, every output word written.
        dense: compressed columns expanded to matrices.
        """
        entry = self.entries[symbol]
        buffers = []
        for argument in entry["arguments"]:
            if argument["direction"] not in ("in", "out"):
                raise HarnessError(f"{symbol}: {argument['name']}: direction {argument['direction']!r}")
            values = None
            if argument["direction"] == "in":
                if argument["name"] not in inputs:
                    raise HarnessError(f"{symbol}: no input {argument['name']!r}")
                values = flatten(argument, inputs[argument["name"]])
            buffers.append(Buffer(argument, entry["real"], values))
        function = getattr(self._object, symbol)
        function.restype, function.argtypes = None, [ctypes.c_void_p] * len(buffers)
        function(*(buffer.data.ctypes.data for buffer in buffers))
        broken = [message for buffer in buffers for message in buffer.check()] if canary else []
        if broken:
            raise HarnessError(f"{symbol}: " + "; ".join(broken))
        pairs = zip(entry["arguments"], buffers, strict=True)
        return {a["name"]: restore(entry, a, b.data, dense) for a, b in pairs if a["direction"] == "out"}
