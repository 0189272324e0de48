"""Build and run the harness in C over the candidates of one joint: outputs, instructions, times."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.peers.candidates import BUILD, HERE
from benchmarks.peers.compile import Compiled
from benchmarks.peers.oracle import POSES, Truth
from benchmarks.peers.work import Work

Values = NDArray[np.float64]
FOLDER = BUILD / "harness" / str(os.getpid())
"""Of this process; two runs do not meet."""

_BOUND = os.environ | {"LD_BIND_NOW": "1"}
"""Calls of libm are resolved before the first one, which would otherwise be charged for it."""

_ALIGNMENT = 8
"""Doubles: no wider than Eigen aligns its matrices."""


def _places(lengths: Sequence[int], alignment: int) -> tuple[list[int], int]:
    """Aligned offsets of arrays one after the other, and the length of all."""
    places, end = [], 0
    for length in lengths:
        places.append(end)
        end += -(-length // alignment) * alignment
    return places, end


@dataclass(frozen=True, slots=True)
class Harness:
    """A compiled harness.

    Attributes:
        work: what its candidates do.
        candidates: in order.
        program: the executable.
        poses: the file of inputs.
    """

    work: Work
    candidates: tuple[Compiled, ...]
    program: Path
    poses: Path

    def outputs(self) -> list[dict[str, Values]]:
        """Stored outputs of each candidate: output -> [poses, entries]."""
        places, stride = _places(list(self.work.lengths.values()), 8)
        done = subprocess.run([str(self.program), "check", str(self.poses)], capture_output=True, check=True)
        values = np.frombuffer(done.stdout).reshape(len(self.candidates), POSES, stride)
        lengths = self.work.lengths.items()
        return [
            {name: block[:, place : place + length] for (name, length), place in zip(lengths, places, strict=True)}
            for block in values
        ]

    def times(self, rounds: int, passes: int) -> Values:
        """Nanoseconds per call [rounds, candidates], candidates interleaved."""
        command = [str(self.program), "time", str(self.poses), str(rounds), str(passes)]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
        return np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])

    def instructions(self) -> list[float] | None:
        """Instructions per call of each candidate with all that it calls; None where they cannot be counted.

        By callgrind, or by single steps where callgrind does not know the processor's instructions.
        """
        return self._instructions_by_callgrind() or self._instructions_by_steps()

    def _instructions_by_callgrind(self) -> list[float] | None:
        if not shutil.which("valgrind"):
            return None
        report = self.program.with_suffix(".callgrind")
        report.unlink(missing_ok=True)
        command = ["valgrind", "--tool=callgrind", "--compress-strings=no", "--compress-pos=no"]
        command += [f"--callgrind-out-file={report}", str(self.program), "count", str(self.poses)]
        done = subprocess.run(command, capture_output=True, env=_BOUND, check=False)
        if done.returncode or not report.exists():
            return None
        costs = _inclusive(report.read_text())
        return [costs[c.candidate.symbol] / POSES for c in self.candidates]

    def _instructions_by_steps(self) -> list[float] | None:
        command = [str(self.program), "step", str(self.poses)]
        done = subprocess.run(command, capture_output=True, text=True, env=_BOUND, check=False)
        return None if done.returncode else [float(line) for line in done.stdout.split()]


def _inclusive(report: str) -> dict[str, int]:
    """Inclusive cost of each function called from ``call_all``."""
    costs: dict[str, int] = {}
    for part in re.split(r"^fn=", report, flags=re.MULTILINE)[1:]:
        if part.split("\n", 1)[0].strip() == "call_all":
            for called in re.finditer(r"^cfn=(\S+)\ncalls=.*\n\S+ (\d+)", part, flags=re.MULTILINE):
                costs[called[1]] = costs.get(called[1], 0) + int(called[2])
    return costs


def build(work: Work, candidates: Sequence[Compiled], truth: Truth, name: str) -> Harness:
    """Link a harness of compiled candidates, in their order."""
    folder = FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    places, stride = _places(list(work.arguments.values()), _ALIGNMENT)
    inputs = np.zeros((POSES, stride))
    for (argument, length), place in zip(work.arguments.items(), places, strict=True):
        inputs[:, place : place + length] = truth.inputs[argument]
    inputs.tofile(folder / "poses")
    output_places, output_stride = _places(list(work.lengths.values()), 8)
    symbols = [c.candidate.symbol for c in candidates]
    (folder / "table.h").write_text(
        f"#define POSES {POSES}\n#define STRIDE {stride}\n#define OUTPUT_STRIDE {output_stride}\n"
        f"#define CANDIDATES {len(symbols)}\n"
        f"static const int PLACE[] = {{{', '.join(map(str, places))}}};\n"
        f"static const int OUTPUT_PLACE[] = {{{', '.join(map(str, output_places))}}};\n"
        "typedef void routine(const double *, const double *, const double *, const double *, const double *, "
        "const double *, double *, double *, double *);\n"
        + "".join(f"extern routine {symbol};\n" for symbol in symbols)
        + "static routine *const candidates[] = {"
        + ", ".join(symbols)
        + "};\n"
    )
    program = folder / "harness"
    objects = [str(c.object) for c in candidates]
    libraries = ["-lstdc++"] if any(c.candidate.source.suffix == ".cpp" for c in candidates) else []
    command = ["gcc", "-std=gnu11", "-O2", f"-I{folder}", str(HERE / "harness.c"), *objects, *libraries]
    subprocess.run([*command, "-lm", "-o", str(program)], check=True)
    return Harness(work, tuple(candidates), program, folder / "poses")
