"""Compile the routine of a chain and the table-driven recursion into one program; check, count and time both."""

from __future__ import annotations

import json
import re
import subprocess
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from benchmarks.chain_speed import pinocchio
from codegen.chains.generate import generate_chain
from codegen.chains.programs import FUSED
from codegen.measure.compile import compile_sources
from codegen.mechanics.chain.grouping import Inertia, of_link
from codegen.mechanics.chain.model import kept_rows
from codegen.mechanics.chain.tree import Node, Tree
from codegen.mechanics.chain.vectors import ZERO
from codegen.spec.chain import Chain

HERE = Path(__file__).parent
FLAGS = ("-std=c99", "-O2", "-march=x86-64-v3")
_TYPES = {"revolute": 0, "prismatic": 1, "fixed": 2}


@dataclass(frozen=True, slots=True)
class Side:
    """What one evaluation takes."""

    nanoseconds: float
    instructions: int


@dataclass(frozen=True, slots=True)
class Result:
    """The routine beside the recursion, and beside Pinocchio where it is."""

    chain: str
    operations: int
    routine: Side
    recursion: Side
    pinocchio: Side | None
    difference: float


def measured(chain: Chain, folder: Path) -> Result:
    """Measure one chain, in the pose of its file.

    Args:
        chain: its cuts are closed, their C frames stand on the base.
        folder: for what is compiled.
    """
    files = generate_chain(chain)
    for path in (f"{chain.name}.h", f"{chain.name}.c", "jg_real.h", "manifest.json"):
        (folder / path).write_bytes(files[path])
    for name in ("driver.c", "table.h"):
        (folder / name).write_text(rendered(f"{name}.j2", chain))
    for name in ("table_driven.h", "table_driven.c"):
        (folder / name).write_text((HERE / name).read_text())
    sources = [folder / name for name in ("driver.c", "table_driven.c", f"{chain.name}.c")]
    compile_sources(sources, folder / "timed", FLAGS)
    routine, recursion = (json.loads(_output([str(folder / "timed"), str(k)])) for k in range(2))
    entry = fused_entry(files, chain)
    timed = [str(folder / "timed")]
    times = np.array(json.loads(_output(timed)))
    sides = [Side(float(np.median(times[:, k])), _instructions([*timed, str(k)], k)) for k in range(2)]
    difference = _difference(chain, entry, routine, recursion)
    other = None
    if pinocchio.prefix() is not None:
        (folder / "table").write_text(pinocchio.table(chain, *_state(chain)))
        command = [str(pinocchio.compiled(folder.parent)), str(folder / "table")]
        difference = max(difference, _difference(chain, entry, routine, json.loads(_output([*command, "once"]))))
        nanoseconds = float(np.median(json.loads(_output(command))))
        other = Side(nanoseconds, _instructions([*command, "once"], 0))
    return Result(chain.name, entry["operations"]["total"], sides[0], sides[1], other, difference)


def fused_entry(files: Mapping[str, bytes], chain: Chain) -> Any:
    """What the manifest says of the routine of all six quantities."""
    manifest = json.loads(files["manifest.json"])
    return next(f for f in manifest["functions"] if f["symbol"] == f"jg_{chain.name}_all")


def _state(chain: Chain) -> tuple[Sequence[Any], Sequence[float]]:
    """Coordinates of the file, and velocities."""
    return [link.coordinate for link in chain.links], [1 + k / 8 for k in range(len(chain.links))]


def rendered(template: str, chain: Chain, **more: Any) -> str:
    """A source of this folder for a chain."""
    tree = Tree(chain)
    inertias = [of_link(link) for link in chain.links] + [Inertia()] * (2 * len(chain.cuts))
    environment = jinja2.Environment(trim_blocks=True, lstrip_blocks=True, undefined=jinja2.StrictUndefined)
    return environment.from_string((HERE / template).read_text()).render(
        name=chain.name,
        links=len(chain.links),
        cuts=len(chain.cuts),
        gravity=_numbers(chain.gravity),
        frames=[_row(node, inertia) for node, inertia in zip(tree.nodes, inertias, strict=False)],
        q=_numbers(_state(chain)[0]),
        qd=_numbers(_state(chain)[1]),
        **more,
    )


def _row(node: Node, inertia: Inertia) -> str:
    turn = node.turn if node.type == "revolute" else node.fixed_turn
    entries = [_numbers(value for row in matrix for value in row) for matrix in (turn, inertia.I)]
    vectors = [_numbers(vector) for vector in (node.arm, inertia.S or ZERO)]
    fields = f"{{{entries[0]}}}, {{{vectors[0]}}}, {float(inertia.m)!r}, {{{vectors[1]}}}, {{{entries[1]}}}"
    return f"{{{node.parent}, {_TYPES[node.type]}, {fields}}}"


def _numbers(values: Any) -> str:
    return ", ".join(repr(float(value)) for value in values)


def _difference(chain: Chain, entry: Any, routine: Any, recursion: Any) -> float:
    """Largest difference of the two, relative to the largest value of each quantity."""
    rows, size = list(kept_rows(chain)), len(chain.links)
    found = 0.0
    for name in FUSED:
        truth = np.array(recursion[name])
        truth = truth.reshape(-1, size) if name in ("J", "M") else truth
        truth = truth[rows] if name in ("phi", "J", "gamma_R") else truth
        pattern = entry["sparsity"].get(name)
        value = _dense(routine[name], pattern) if pattern else np.array(routine[name])[: len(truth)]
        found = max(found, float(np.abs(value - truth).max() / max(1.0, np.abs(truth).max())))
    return found


def _dense(values: Sequence[float], pattern: Any) -> np.ndarray[Any, Any]:
    dense = np.zeros((pattern["nrow"], pattern["ncol"]))
    for column in range(pattern["ncol"]):
        for k in range(pattern["colind"][column], pattern["colind"][column + 1]):
            dense[pattern["row"][k], column] = values[k]
    return dense


def _output(command: Sequence[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def _instructions(command: Sequence[str], task: int) -> int:
    """Instructions of one evaluation, by valgrind."""
    valgrind = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"]
    valgrind.append(f"--toggle-collect=task_{task}")
    done = subprocess.run([*valgrind, *command], capture_output=True, text=True, check=True)
    found = re.search(r"Collected *: *(\d+)", done.stderr)
    assert found, done.stderr
    return int(found[1])
