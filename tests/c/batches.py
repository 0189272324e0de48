"""Batch routines called from Python: arrays in both layouts, with walls around them."""

from __future__ import annotations

import ctypes
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen import build, output
from codegen.spec.request import Options
from tests.harness.library import REAL, digest, run_compiler

from .packages import STRICT, compile_silently, only_one

Array = NDArray[Any]
Entry = Mapping[str, Any]
WALL = 16
OUTPUTS = ("all",)
SAME_BITS = ("-O1", "-fPIC", "-ffp-contract=off", "-fno-tree-slp-vectorize", "-DJG_OWN_TRIGONOMETRY")
"""Flags under which a routine gives the same bits alone and in a batch."""
PADDING = 3
"""Places between the last joint and the leading dimension."""


@dataclass(frozen=True)
class BatchPackage:
    """A generated package with batch routines."""

    root: Path

    @cached_property
    def manifest(self) -> dict[str, Any]:
        document: dict[str, Any] = json.loads((self.root / "manifest.json").read_text())
        return document

    @property
    def lanes(self) -> int:
        return int(self.manifest["batch"]["lanes"])

    @property
    def sources(self) -> list[Path]:
        entries = [*self.manifest["functions"], *self.manifest["batch"]["functions"]]
        return [self.root / name for name in dict.fromkeys(entry["source"] for entry in entries)]

    def compiled(self, *flags: str, compiler: str = "gcc") -> Routines:
        """Compile the package strictly and silently, once for each set of flags."""
        target = self.root / f"{digest(compiler, *flags)}.so"
        with only_one(self.root.parent / f"{self.root.name}.lock"):
            if not target.exists():
                include = f"-I{self.root / 'c/include'}"
                objects = [str(target.with_suffix(f".{source.stem}.o")) for source in self.sources]
                for source, compiled in zip(self.sources, objects, strict=True):
                    compile_silently([compiler, *STRICT, *flags, include, "-c", str(source), "-o", compiled])
                run_compiler([compiler, "-shared", *objects, "-lm"], target)
        return Routines(self, target)


def batch_package(folder: Path, options: Options) -> BatchPackage:
    """Generate a package, once for all test processes."""
    root = folder / f"batch-{digest(repr(options))}"
    with only_one(folder / f"{root.name}.making"):
        if not root.exists():
            output.replace(root, build.generate(options))
    return BatchPackage(root)


class Routines:
    """The routines of a compiled package, for one joint and for many."""

    def __init__(self, package: BatchPackage, library: Path) -> None:
        self.lanes = package.lanes
        self.kind, self.word, self.pattern = REAL[package.manifest["real"]]
        self.scalar: dict[str, Entry] = {entry["symbol"]: entry for entry in package.manifest["functions"]}
        self.batch: list[Entry] = package.manifest["batch"]["functions"]
        self._object = ctypes.CDLL(str(library))

    def inputs(self, entry: Entry, count: int, rng: np.random.Generator) -> dict[str, Array]:
        """Random inputs [entries, joints]; some angles are beyond those that our own sine takes."""
        drawn = {
            a["name"]: rng.normal(size=(a["length"], count)).astype(self.kind)
            for a in entry["arguments"]
            if a["direction"] == "in"
        }
        if "alpha" in drawn:
            drawn["alpha"] *= rng.choice([0.0, 1.0, 100.0, 1e6], size=drawn["alpha"].shape).astype(self.kind)
        return drawn

    def one_by_one(self, symbol: str, inputs: Mapping[str, Array], count: int) -> dict[str, Array]:
        """Outputs [entries, joints] of the routine for one joint."""
        entry = self.scalar[symbol]
        results = {a["name"]: self._unset(a["length"], count) for a in entry["arguments"] if a["direction"] == "out"}
        for joint in range(count):
            columns = [np.ascontiguousarray((inputs | results)[a["name"]][:, joint]) for a in entry["arguments"]]
            self._call(symbol, [], columns)
            for a, column in zip(entry["arguments"], columns, strict=True):
                if a["direction"] == "out":
                    results[a["name"]][:, joint] = column
        return results

    def at_once(self, entry: Entry, inputs: Mapping[str, Array], count: int) -> dict[str, Array]:
        """Outputs [entries, joints] of a batch routine; what it writes elsewhere is an error."""
        ld = count + PADDING
        grouped = entry["layout"] == "aosoa"
        joints = -(-count // self.lanes) * self.lanes if grouped else ld
        walled, places = [], []
        for a in entry["arguments"]:
            whole = self._unset(a["length"], joints)
            if a["direction"] == "in":
                whole[:, :count] = inputs[a["name"]]
                whole[:, count:] = 1.0 if grouped else whole[:, count:]
            words = np.full(whole.size + 2 * WALL, self.pattern, dtype=self.word)
            words[WALL : WALL + whole.size] = self._ordered(whole, grouped).view(self.word)
            walled.append(words)
            places.append(words[WALL : WALL + whole.size])
        before = [words.copy() for words in walled]
        counts = {"count": count, "ld": ld}
        self._call(entry["symbol"], [counts[name] for name in entry["counts"]], places)
        results = {}
        for a, words, place, earlier in zip(entry["arguments"], walled, places, before, strict=True):
            assert (words[:WALL] == self.pattern).all(), f"{entry['symbol']}: wrote before {a['name']}"
            assert (words[len(words) - WALL :] == self.pattern).all(), f"{entry['symbol']}: wrote behind {a['name']}"
            if a["direction"] == "in":
                assert (words == earlier).all(), f"{entry['symbol']}: changed {a['name']}"
                continue
            whole = self._restored(place.view(self.kind), a["length"], joints, grouped)
            if not grouped:
                beyond = np.ascontiguousarray(whole[:, count:]).view(self.word)
                assert (beyond == self.pattern).all(), f"{entry['symbol']}: wrote between the joints and ld"
            results[a["name"]] = whole[:, :count]
        return results

    def _unset(self, entries: int, joints: int) -> Array:
        return np.full((entries, joints), self.pattern, dtype=self.word).view(self.kind)

    def _ordered(self, whole: Array, grouped: bool) -> Array:
        """[entries, joints] in the order of the memory."""
        if not grouped:
            return whole.ravel()
        return whole.reshape(whole.shape[0], whole.shape[1] // self.lanes, self.lanes).transpose(1, 0, 2).ravel()

    def _restored(self, place: Array, entries: int, joints: int, grouped: bool) -> Array:
        if not grouped:
            return place.reshape(entries, joints)
        return place.reshape(joints // self.lanes, entries, self.lanes).transpose(1, 0, 2).reshape(entries, joints)

    def _call(self, symbol: str, counts: list[int], arrays: list[Array]) -> None:
        function = getattr(self._object, symbol)
        function.restype = None
        function(*map(ctypes.c_long, counts), *(ctypes.c_void_p(array.ctypes.data) for array in arrays))


def different_bits(a: Array, b: Array, word: Any) -> int:
    """Numbers that differ in a bit; one NaN is as good as another."""
    bits = [np.ascontiguousarray(values).view(word) for values in (a, b)]
    return int(((bits[0] != bits[1]) & ~(np.isnan(a) & np.isnan(b))).sum())
