"""The work that every candidate does: arguments, outputs and patterns, read from the manifest of a package of ours."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchmarks.peers.constraint import argument_lengths

OUTPUTS = ("phi", "phi_q", "phi_q_t_lambda_q")


@dataclass(frozen=True, slots=True)
class Pattern:
    """Compressed columns of an output: the structural nonzeros that are stored."""

    rows: int
    columns: int
    starts: tuple[int, ...]
    row_indices: tuple[int, ...]

    @property
    def places(self) -> list[tuple[int, int]]:
        """(row, column) of each stored entry."""
        return [
            (self.row_indices[k], column)
            for column in range(self.columns)
            for k in range(self.starts[column], self.starts[column + 1])
        ]


@dataclass(frozen=True, slots=True)
class Work:
    """One joint: conventional form, body variation, exact derivative.

    Attributes:
        joint: name in the catalogue.
        patterns: output -> pattern, in the order of the routine.
    """

    joint: str
    patterns: dict[str, Pattern]

    @property
    def arguments(self) -> dict[str, int]:
        """Argument -> length."""
        return argument_lengths(self.joint)

    @property
    def lengths(self) -> dict[str, int]:
        """Output -> number of stored entries."""
        return {name: len(pattern.places) for name, pattern in self.patterns.items()}


@dataclass(frozen=True, slots=True)
class Ours:
    """A package of generated routines.

    Attributes:
        folder: of the package.
        functions: joint -> manifest record of the fused routine.
        casadi: joint -> path of its CasADi function.
    """

    folder: Path
    functions: dict[str, dict[str, Any]]
    casadi: dict[str, Path]

    def work(self, joint: str) -> Work:
        """Work of a joint, with the patterns that our routine stores."""
        return Work(joint, {name: _pattern(self.functions[joint], name) for name in OUTPUTS})

    def operations(self, joint: str) -> int:
        """Operations of the routine by its manifest."""
        return int(self.functions[joint]["operations"]["total"])


def read_package(folder: Path) -> Ours:
    """Read what the benchmark needs of a package.

    Raises:
        FileNotFoundError: there is no manifest.
    """
    manifest = json.loads((folder / "manifest.json").read_text())
    functions = {record["joint"]: record for record in manifest["functions"] if _is_the_work(record)}
    casadi = {
        record["joint"]: folder / record["file"]
        for record in manifest["casadi"]
        if record["name"] == functions.get(record["joint"], {}).get("symbol")
    }
    return Ours(folder, functions, casadi)


def _is_the_work(record: dict[str, Any]) -> bool:
    kept: dict[str, object] = {
        "form": "conventional",
        "variation": "body",
        "derivative": "exact",
        "output": "all",
        "storage": "nz",
    }
    kept |= {"real": "double", "outputs": list(OUTPUTS)}
    return all(record[key] == value for key, value in kept.items())


def _pattern(record: dict[str, Any], name: str) -> Pattern:
    argument = next(a for a in record["arguments"] if a["name"] == name)
    rows, columns = argument["shape"]
    sparsity = record["sparsity"].get(name)
    if sparsity is None:
        return Pattern(rows, 1, (0, rows), tuple(range(rows)))
    return Pattern(rows, columns, tuple(sparsity["colind"]), tuple(sparsity["row"]))
