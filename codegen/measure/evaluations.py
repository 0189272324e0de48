"""Measure how long programs take on this machine, as C: instructions and nanoseconds for each evaluation.

Everything is compiled into one binary, function by function; what is compared is timed in turn, over and over, so that
what else the machine does falls on all alike. Instructions are counted by valgrind where it is installed.
"""

from __future__ import annotations

import json
import re
import shutil
import statistics
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from codegen.emit.c import definition
from codegen.emit.declarations import declaration
from codegen.emit.environment import render
from codegen.emit.routine import Parameter
from codegen.errors import SpecificationError
from codegen.ir.program import Program
from codegen.measure.compile import C_FLAGS, compile_sources, compiler_version

_COUNTABLE = ("-march=native", "-mno-avx512f")
"""What valgrind can run on processors with instructions that it does not know."""


@dataclass(frozen=True, slots=True)
class Task:
    """What is timed as one evaluation.

    Attributes:
        programs: evaluated one after the other, each over arrays of its own.
        additions: of entries of the results, afterwards.
    """

    programs: Sequence[Program]
    additions: int = 0


@dataclass(frozen=True, slots=True)
class Evaluation:
    """What an evaluation takes.

    Attributes:
        nanoseconds: median.
        spread: half of all times lie within this part of the median.
        instructions: executed; None where they could not be counted.
    """

    nanoseconds: float
    spread: float
    instructions: int | None


@dataclass(frozen=True, slots=True)
class Measurement:
    """What was measured, and on what.

    Attributes:
        evaluations: task by task.
        machine: its processor.
        compiler: name, version and flags.
        uncounted: why there are no instructions; empty where there are.
    """

    evaluations: tuple[Evaluation, ...]
    machine: str
    compiler: str
    uncounted: str


def measured(tasks: Sequence[Task], real: str) -> Measurement:
    """Measure tasks.

    Args:
        tasks: what is compared.
        real: number type, ``double`` or ``float``.

    Raises:
        SpecificationError: there is no compiler.
    """
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        sources = _write(folder, tasks, real)
        flags = _compiled(sources, folder / "timed", ("-march=native",), ())
        times = json.loads(_output([str(folder / "timed")]))
        counted = [_instructions(sources, folder, k) for k in range(len(tasks))]
    columns = [[line[k] for line in times] for k in range(len(tasks))]
    evaluations = tuple(
        Evaluation(statistics.median(column), _spread(column), number)
        for column, number in zip(columns, counted, strict=True)
    )
    uncounted = "" if None not in counted else _why_not()
    return Measurement(evaluations, _machine(), f"{compiler_version()} {' '.join(flags)}", uncounted)


def _write(folder: Path, tasks: Sequence[Task], real: str) -> list[Path]:
    """Write the sources: the programs, each once, and what calls them."""
    programs = list({id(program): program for task in tasks for program in task.programs}.values())
    names = {id(program): f"program_{k}" for k, program in enumerate(programs)}
    texts = [definition(names[id(program)], parameters(program), program)[0] for program in programs]
    prototypes = [declaration(names[id(program)], parameters(program)) for program in programs]
    calls = [
        _Call(names[id(program)], f"array_{number}_{k}", program)
        for number, task in enumerate(tasks)
        for k, program in enumerate(task.programs)
    ]
    ends = [sum(len(task.programs) for task in tasks[:number]) for number in range(len(tasks) + 1)]
    told = [
        {"calls": [call.text for call in calls[ends[k] : ends[k + 1]]], "additions": task.additions}
        for k, task in enumerate(tasks)
    ]
    arrays = [array for call in calls for array in call.arrays]
    header = render("c/jg_real.h.j2", banner="", real=real, fma=False, batch=None)
    (folder / "jg_real.h").write_text(header)
    (folder / "programs.c").write_text(render("measure/programs.c.j2", prototypes=prototypes, texts=texts))
    (folder / "timed.c").write_text(
        render("measure/evaluations.c.j2", prototypes=prototypes, arrays=arrays, tasks=told)
    )
    return [folder / "programs.c", folder / "timed.c"]


@dataclass(frozen=True, slots=True)
class _Call:
    """A call of a program over arrays of its own."""

    function: str
    stem: str
    program: Program

    @property
    def arrays(self) -> list[tuple[str, int, bool]]:
        """Name and length of each array, and whether it is read."""
        declared = parameters(self.program)
        return [(f"{self.stem}_{k}", max(p.length, 1), p.direction == "in") for k, p in enumerate(declared)]

    @property
    def text(self) -> str:
        """The statement."""
        return f"{self.function}({', '.join(name for name, _, _ in self.arrays)});"


def parameters(program: Program) -> tuple[Parameter, ...]:
    """The arrays of a program without words."""
    inputs = [Parameter(a.name, "in", a.shape, a.length, "", "", "") for a in program.used_arguments()]
    outputs = [Parameter(o.name, "out", (len(o.values), 1), len(o.values), "", "", "") for o in program.outputs]
    return (*inputs, *outputs)


def _compiled(sources: Sequence[Path], program: Path, *choices: Sequence[str]) -> tuple[str, ...]:
    """Compile with the first flags that the compiler takes; say which."""
    *others, last = choices
    for choice in others:
        try:
            compile_sources(sources, program, (*C_FLAGS, *choice))
        except SpecificationError:
            continue
        return (*C_FLAGS, *choice)
    compile_sources(sources, program, (*C_FLAGS, *last))
    return (*C_FLAGS, *last)


def _instructions(sources: Sequence[Path], folder: Path, task: int) -> int | None:
    """Count the instructions of one evaluation."""
    if shutil.which("valgrind") is None:
        return None
    program = folder / "counted"
    if not program.exists():
        _compiled(sources, program, _COUNTABLE, ("-march=native",), ())
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", "--collect-atstart=no"]
    done = subprocess.run(
        [*command, f"--toggle-collect=task_{task}", str(program), str(task)],
        capture_output=True,
        text=True,
        check=False,
        cwd=folder,
    )
    found = re.search(r"Collected *: *(\d+)", done.stderr)
    return int(found[1]) if found and done.returncode == 0 else None


def _why_not() -> str:
    return "valgrind could not run it" if shutil.which("valgrind") else "there is no valgrind"


def _spread(times: Sequence[float]) -> float:
    first, median, third = statistics.quantiles(times, n=4)
    return (third - first) / median


def _machine() -> str:
    try:
        found = re.search(r"model name\s*: *(.+)", Path("/proc/cpuinfo").read_text())
    except OSError:
        found = None
    return found[1].strip() if found else "this machine"


def _output(command: Sequence[str]) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout
