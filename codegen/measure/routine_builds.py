"""Compile a routine in many ways, run it over many poses, time it and count its instructions.

Each build is a library with the routine and a loop around it; the compiler sees no more of the loop than a caller's own
would tell it. Lanes of a batch are poses.
"""

from __future__ import annotations

import ctypes
import hashlib
import re
import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from codegen.emit.batch import batch_routine
from codegen.emit.batch_files import batch_headers
from codegen.emit.c import definition
from codegen.emit.declarations import declaration
from codegen.emit.environment import render
from codegen.emit.routine import Parameter, Routine
from codegen.errors import InternalError
from codegen.measure.errors import number_type
from codegen.measure.evaluations import parameters
from codegen.measure.short_trigonometry import short_sincos

SAME_BITS = ("-ffp-contract=off", "-fno-tree-slp-vectorize")
"""Flags under which the bits are those of the Program, with every compiler."""

O2 = ("-O2", *SAME_BITS)
NATIVE = ("-O3", "-march=native")

_TIMED_POSES = 64
_ROUND_NANOSECONDS = 2e5


@dataclass(frozen=True, slots=True)
class Build:
    """A way to compile a routine.

    Attributes:
        name: for readers.
        real: ``double``, ``float`` or ``long double``.
        lanes: poses at once; 1 is the routine for one joint.
        compiler: command.
        flags: besides the language.
        fma: whether the program to compile is the one with fused products and sums.
        trigonometry: ``libm``, ``own`` (polynomials, no calls), ``given``: sines and cosines are inputs, or ``short``.
        degree: of the polynomials, where they are short.
    """

    name: str
    real: str = "double"
    lanes: int = 1
    compiler: str = "gcc"
    flags: tuple[str, ...] = O2
    fma: bool = False
    trigonometry: str = "libm"
    degree: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class Built:
    """A compiled routine.

    Attributes:
        build: how.
        routine: which.
        library: keeps it loaded.
        source: its text on disk.
        command: how it was compiled, without the output.
    """

    build: Build
    routine: Routine
    library: ctypes.CDLL
    source: Path
    command: tuple[str, ...]

    def values(self, inputs: Mapping[str, NDArray[np.floating]]) -> dict[str, NDArray[np.floating]]:
        """Evaluate at poses: argument -> [length, poses] to output -> [nonzeros, poses]."""
        packed, poses = self._packed(inputs)
        declared = parameters(self.routine.straight)
        lengths = [p.length for p in declared if p.direction == "out"]
        out = np.full((packed.shape[0], sum(lengths) * self.build.lanes), np.nan, dtype=packed.dtype)
        self._run(packed, out, 1, out.shape[1])
        found: dict[str, NDArray[np.floating]] = {}
        offset = 0
        for output, length in zip(self.routine.program.outputs, lengths, strict=True):
            part = out[:, offset : offset + length * self.build.lanes]
            lanes = part.reshape(len(out), length, self.build.lanes)
            found[output.name] = np.moveaxis(lanes, 1, 0).reshape(length, len(out) * self.build.lanes)[:, :poses]
            offset += length * self.build.lanes
        return found

    def timer(self, inputs: Mapping[str, NDArray[np.floating]]) -> Any:
        """Give a function that times some rounds and gives nanoseconds a pose."""
        packed, _ = self._packed({name: rows[:, :_TIMED_POSES] for name, rows in inputs.items()})
        out = np.zeros((1, max(1, sum(p.length for p in parameters(self.routine.straight)) * self.build.lanes)))
        out = out.astype(packed.dtype)
        rounds = 1

        def once() -> float:
            nonlocal rounds
            start = time.perf_counter_ns()
            self._run(packed, out, rounds, 0)
            taken = time.perf_counter_ns() - start
            per_pose = taken / (rounds * len(packed) * self.build.lanes)
            if taken < _ROUND_NANOSECONDS:
                rounds = max(rounds + 1, int(rounds * _ROUND_NANOSECONDS / max(taken, 1)))
            return per_pose

        return once

    def instructions(self) -> int | None:
        """Count the instructions of a pose by valgrind, calls into libraries included; None where it cannot."""
        if shutil.which("valgrind") is None:
            return None
        program = self.source.with_suffix(".counted")
        command = [word for word in self.command if word not in ("-shared", "-fPIC", "-march=native")]
        flags = ["-march=x86-64-v3"] if "-march=native" in self.command else []
        done = subprocess.run(
            [*command, *flags, "-DCOUNTED", "-o", str(program), "-lm"], capture_output=True, check=False
        )
        if done.returncode:
            return None
        tool = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"]
        tool.append(f"--toggle-collect={_symbol(self.routine, self.build)}")
        counted = subprocess.run([*tool, str(program)], capture_output=True, text=True, check=False)
        found = re.search(r"Collected *: *(\d+)", counted.stderr)
        return round(int(found[1]) / self.build.lanes) if found and not counted.returncode else None

    def _packed(self, inputs: Mapping[str, NDArray[np.floating]]) -> tuple[NDArray[np.floating], int]:
        """Lay inputs out as the loop takes them: [groups, entries x lanes]."""
        rows = [inputs[a.name] for a in self.routine.program.used_arguments()]
        values = np.concatenate(rows) if rows else np.zeros((0, next(iter(inputs.values())).shape[1]))
        poses, lanes = values.shape[1], self.build.lanes
        values = np.pad(values, ((0, 0), (0, -poses % lanes)), mode="edge")
        groups = values.reshape(len(values), values.shape[1] // lanes, lanes)
        kind = number_type(self.build.real)
        return np.ascontiguousarray(np.moveaxis(groups, 0, 1), dtype=kind).reshape(
            groups.shape[1], len(values) * lanes
        ), poses

    def _run(self, packed: NDArray[Any], out: NDArray[Any], rounds: int, stride: int) -> None:
        self.library.run(
            ctypes.c_void_p(packed.ctypes.data),
            ctypes.c_void_p(out.ctypes.data),
            ctypes.c_long(len(packed)),
            ctypes.c_long(rounds),
            ctypes.c_long(stride),
        )


def built(routine: Routine, build: Build, folder: Path) -> Built:
    """Compile a routine.

    Args:
        routine: its program is the one to compile; see `Build.fma` and `Build.trigonometry`.
        build: how.
        folder: where files of measurements may lie; a build that is there is taken as it is.

    Raises:
        InternalError: the compiler refuses it.
    """
    _write_headers(folder)
    text = _source(routine, build)
    own = ("-DJG_OWN_TRIGONOMETRY",) if build.trigonometry == "own" else ()
    precision = ("-DJG_REAL_IS_FLOAT",) if build.real == "float" else ()
    options = (build.compiler, "-std=gnu99", *build.flags, *own, *precision, "-shared", "-fPIC", f"-I{folder}")
    source = folder / f"{_digest(_version(build.compiler), text, *options)}.c"
    library = source.with_suffix(".so")
    if not library.exists():
        source.write_text(text)
        unfinished = source.with_suffix(".unfinished")
        done = subprocess.run(
            [*options, str(source), "-o", str(unfinished), "-lm"], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise InternalError(f"{build.name}: {done.stderr}")
        unfinished.replace(library)
    return Built(build, routine, ctypes.CDLL(str(library)), source, (*options, str(source)))


@cache
def _version(compiler: str) -> str:
    return subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True).stdout


def _digest(*words: str) -> str:
    return hashlib.sha256("\n".join(words).encode()).hexdigest()[:24]


def _symbol(routine: Routine, build: Build) -> str:
    return "evaluated" if build.lanes == 1 else f"{routine.symbol}_batch{build.lanes}"


def _source(routine: Routine, build: Build) -> str:
    program = routine.straight
    declared = parameters(program)
    symbol = _symbol(routine, build)
    if build.lanes > 1:
        batch = batch_routine(routine, declared, build.lanes)
        head = [f"#define JG_BATCH {build.lanes}", '#include "jointgen/jg_batch.h"']
        text = "\n".join(f"{entry.signature};" for entry in batch.entries) + "\n" + batch.text
        prototype = batch.entries[0].signature
    else:
        header = "long_double.h" if build.real == "long double" else "jointgen/jg_real.h"
        head = [f'#include "{header}"']
        head += [short_sincos(build.degree)] if build.trigonometry == "short" else []
        text, prototype = definition(symbol, declared, program)[0], declaration(symbol, declared)
    return render(
        "measure/poses.c.j2",
        head=head,
        text=text,
        prototype=prototype,
        call=_call(symbol, declared, build.lanes),
        inputs=sum(p.length for p in declared if p.direction == "in") * build.lanes,
        outputs=sum(p.length for p in declared if p.direction == "out") * build.lanes,
    )


def _call(symbol: str, declared: Sequence[Parameter], lanes: int) -> str:
    offsets = {"in": 0, "out": 0}
    words = []
    for p in declared:
        words.append(f"{'x' if p.direction == 'in' else 'y'} + {offsets[p.direction] * lanes}")
        offsets[p.direction] += p.length
    return f"{symbol}({', '.join(words)});"


def _write_headers(folder: Path) -> None:
    include = folder / "jointgen"
    if (include / "jg_batch.h").exists():
        return
    include.mkdir(parents=True, exist_ok=True)
    texts = {
        "jointgen/jg_real.h": render("c/jg_real.h.j2", banner="", real="double", fma=False, batch=4),
        "long_double.h": render("measure/long_double.h.j2"),
    }
    texts |= {path.removeprefix("c/include/"): text for path, text in batch_headers((), 4, "", "").items()}
    for path, text in texts.items():
        (folder / path).write_text(text)
