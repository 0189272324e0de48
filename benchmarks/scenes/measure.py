"""Compile and time the routines of some sets of slider-cranks."""

from __future__ import annotations

import resource
import statistics
import subprocess
from collections import defaultdict
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import jinja2

from benchmarks.scenes.sets import STEP, Emitted, library_joints
from codegen.mechanics.assembly import Assembly

HERE = Path(__file__).resolve().parent
GENERATED = HERE.parents[1] / "generated" / "c"
FLAGS = ("-std=c99", "-O2")
LONGEST = 60
"""Seconds of processor time that a compilation may take."""

_SETS_A_MEASUREMENT = 20_000
_AGREEMENT = 1e-12


@dataclass(frozen=True, slots=True)
class Measured:
    """One shape of a number of sets.

    Attributes:
        sets: how many.
        shape: ``straight``, ``loops`` or ``library``.
        operations: of the routine; None for the library.
        generation: seconds of processor time from the judged scene to C.
        compilation: seconds of processor time; None where it took too long.
        code: bytes of instructions and of constants.
        median: nanoseconds per set.
        low: first quartile.
        high: third quartile.
    """

    sets: int
    shape: str
    operations: int | None = None
    generation: float | None = None
    compilation: float | None = None
    code: int | None = None
    median: float | None = None
    low: float | None = None
    high: float | None = None

    def as_dict(self) -> dict[str, Any]:
        """Plain data, times in three digits."""
        return {key: float(f"{v:.3g}") if isinstance(v, float) else v for key, v in asdict(self).items()}


def measured(one: Assembly, number: int, shapes: list[Emitted], rounds: int, folder: Path) -> list[Measured]:
    """Compile every shape and time those that compile, and the library, in turns.

    Args:
        one: a set.
        number: of sets.
        shapes: their routine.
        rounds: of timings.
        folder: for sources and objects.
    """
    compiled = {shape.shape: _compiled(shape, folder) for shape in shapes}
    ready = [shape for shape in shapes if compiled[shape.shape] is not None]
    times = _times(_driver(one, number, ready, folder), [shape.shape for shape in ready], number, rounds)
    found = []
    for shape in shapes:
        seconds, code = compiled[shape.shape] or (None, None)
        spread = _quartiles(times[shape.shape]) if shape.shape in times else (None, None, None)
        found.append(Measured(number, shape.shape, shape.operations, shape.seconds, seconds, code, *spread))
    return [*found, Measured(number, "library", None, None, None, None, *_quartiles(times["library"]))]


def _quartiles(times: list[float]) -> tuple[float, float, float]:
    low, median, high = statistics.quantiles(times, n=4, method="inclusive")
    return median, low, high


def _compiled(shape: Emitted, folder: Path) -> tuple[float, int] | None:
    """Seconds and bytes of the object; None if the compiler is not done in time."""
    source, target = folder / f"{shape.shape}.c", folder / f"{shape.shape}.o"
    source.write_text(shape.text)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = ["gcc", *FLAGS, f"-I{GENERATED / 'include'}", "-c", str(source), "-o", str(target)]
    limited = ["sh", "-c", f'ulimit -t {LONGEST}; exec "$@"', "sh", *command]
    if subprocess.run(limited, capture_output=True, check=False).returncode:
        return None
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    listed = subprocess.run(["size", str(target)], capture_output=True, text=True, check=True).stdout
    return seconds, int(listed.splitlines()[1].split()[0])


def _driver(one: Assembly, number: int, shapes: list[Emitted], folder: Path) -> Path:
    joints = library_joints(one)
    arrays: list[dict[str, Any]] = [
        {"name": p.name, "direction": p.direction, "length": p.length} for p in shapes[-1].parameters
    ]
    template = jinja2.Template((HERE / "driver.c.j2").read_text(), undefined=jinja2.StrictUndefined, trim_blocks=True)
    prototypes = [shape.text.split(";", 1)[0].split("\n\n", 1)[1] + ";" for shape in shapes]
    text = template.render(
        count=number,
        symbols=[shape.symbol for shape in shapes],
        prototypes=prototypes,
        arrays=arrays,
        joints=joints,
        bodies=len(one.scene.bodies),
        rows=len(one.rows),
        sizes={a["name"]: a["length"] // number for a in arrays},
        step=float(STEP),
    )
    source, program = folder / "driver.c", folder / "driver"
    source.write_text(text)
    names = dict.fromkeys(joint["symbol"].removeprefix("jg_").removesuffix("_all") for joint in joints)
    sources = [str(GENERATED / "src" / f"{name}.c") for name in names]
    objects = [str(folder / f"{shape.shape}.o") for shape in shapes]
    include = f"-I{GENERATED / 'include'}"
    subprocess.run(["gcc", *FLAGS, include, str(source), *sources, *objects, "-lm", "-o", str(program)], check=True)
    return program


def _times(program: Path, shapes: list[str], number: int, rounds: int) -> dict[str, list[float]]:
    """Nanoseconds per set, round by round.

    Raises:
        ValueError: the shapes do not give the same numbers.
    """
    names = [*shapes, "library"]
    calls = max(1, _SETS_A_MEASUREMENT // number)
    done = subprocess.run([program, str(calls), str(rounds)], capture_output=True, text=True, check=True)
    times: dict[str, list[float]] = defaultdict(list)
    for line in done.stdout.splitlines():
        word, way, value = line.split()
        if word == "time":
            times[names[int(way)]].append(float(value))
        elif float(value) > (_AGREEMENT if names[int(way)] == "library" else 0):
            raise ValueError(f"{names[int(way)]} of {number} sets differs by {value}")
    return times
