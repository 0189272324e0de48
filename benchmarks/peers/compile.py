"""Compile candidates, and count the operations of what was written in the unoptimised object code.

Every candidate is a translation unit of its own, compiled with the same flags. The dialect is GNU's for all of them, in
which the compiler may contract a product and a sum to one fused operation where the target has it.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import shutil
import subprocess
import tempfile
from collections import Counter
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from benchmarks.peers.candidates import BUILD, Candidate

DIALECT = {".c": "-std=gnu11", ".cpp": "-std=gnu++17"}
COMPILERS = {"gcc": {".c": "gcc", ".cpp": "g++"}, "clang": {".c": "clang", ".cpp": "clang++"}}
FLAGS = {"O3-native": ("-O3", "-march=native"), "O2": ("-O2",)}
_OPERATIONS = {"addsd": "add", "subsd": "add", "mulsd": "mul", "divsd": "div", "sqrtsd": "sqrt"}
_COUNTING = ("-O0", "-ffp-contract=off")
_COUNTING_TEMPLATES = (
    *("-O2", "-ffp-contract=off", "-fno-tree-vectorize"),
    *("-DEIGEN_DONT_VECTORIZE", "-DEIGEN_UNROLLING_LIMIT=1000", "-DINLINED=__attribute__((flatten))"),
)


@dataclass(frozen=True, slots=True)
class Setting:
    """A compiler with its flags."""

    compiler: str
    flags: tuple[str, ...]

    def __str__(self) -> str:
        return f"{self.compiler} {' '.join(self.flags)}"

    @property
    def short(self) -> str:
        """For the head of a column."""
        return str(self).replace("-march=", "").replace(" -", " ")


@dataclass(frozen=True, slots=True)
class Compiled:
    """An object file and the processor seconds that its compilation took."""

    candidate: Candidate
    object: Path
    seconds: float


class CompilationError(Exception):
    """The compiler refuses a candidate, or there is no compiler of its language."""


def settings(names: Sequence[str]) -> list[Setting]:
    """Every compiler that is here, with each of the named flag sets."""
    present = [name for name, commands in COMPILERS.items() if shutil.which(commands[".c"])]
    return [Setting(compiler, FLAGS[name]) for compiler in present for name in names]


def compile_all(candidates: Sequence[Candidate], settings: Sequence[Setting]) -> None:
    """Compile on all processors what is asked for one by one later, for timing and for counting.

    What does not compile is left out; `compiled` says why.
    """
    made = [(candidate, setting) for setting in settings for candidate in candidates]
    made += [(candidate, _counting(candidate)) for candidate in candidates]
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(_compiled_if_possible, *zip(*made, strict=True)))


def _compiled_if_possible(candidate: Candidate, setting: Setting) -> None:
    with suppress(CompilationError):
        compiled(candidate, setting)


def compiled(candidate: Candidate, setting: Setting) -> Compiled:
    """Compile a candidate, or take the object of an earlier run.

    Raises:
        CompilationError: see there.
    """
    command = _command(candidate, setting)
    key = hashlib.sha256(" ".join(command).encode() + candidate.source.read_bytes())
    for folder in candidate.includes:
        for header in sorted(Path(folder).glob("jointgen/*.h")):
            key.update(header.read_bytes())
    place = BUILD / "objects" / f"{candidate.symbol}_{key.hexdigest()[:16]}.o"
    record = place.with_suffix(".json")
    if not record.exists():
        place.parent.mkdir(parents=True, exist_ok=True)
        _, seconds = _run([*command, "-o", str(place)])
        _keep_symbol(place, candidate.symbol)
        record.write_text(json.dumps({"seconds": seconds}))
    return Compiled(candidate, place, json.loads(record.read_text())["seconds"])


def _keep_symbol(place: Path, symbol: str) -> None:
    """Make every other symbol local, or the linker would let candidates share templates of the same name."""
    whole = place.with_suffix(".whole.o")
    _run(["ld", "-r", "--force-group-allocation", str(place), "-o", str(whole)])
    _run(["objcopy", f"--keep-global-symbol={symbol}", str(whole), str(place)])
    whole.unlink()


def _command(candidate: Candidate, setting: Setting) -> list[str]:
    ending = candidate.source.suffix
    compiler = COMPILERS[setting.compiler][ending]
    if not shutil.which(compiler):
        raise CompilationError(f"there is no {compiler}")
    includes = [f"-I{folder}" for folder in candidate.includes]
    return [compiler, DIALECT[ending], *setting.flags, "-DNDEBUG", *includes, "-c", str(candidate.source)]


def _run(command: list[str]) -> tuple[str, float]:
    """What a command writes, and its processor seconds; those of other commands that run meanwhile are not counted."""
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        process = subprocess.Popen(command, stdout=out, stderr=err)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        if process.returncode:
            lines = [line for line in err if "error" in line] or ["the compiler fails"]
            raise CompilationError(lines[0].rstrip())
        return out.read(), usage.ru_utime + usage.ru_stime


def operations(candidate: Candidate) -> dict[str, int] | None:
    """Count additions, multiplications, divisions, roots and calls of libm; changes of sign are free, fma is two.

    Read off the object code without optimisation, so that it is what the text says. Templates of Eigen mean nothing
    before they are inlined: there it is the optimised code, scalar and without fused operations.

    Returns:
        Kind -> number, or None where the machine or the code does not allow it (a loop).
    """
    if not shutil.which("objdump") or not shutil.which("gcc"):
        return None
    is_eigen = candidate.name == "eigen"
    try:
        listed = _disassembly(candidate)
    except CompilationError:
        return None
    if "x86-64" not in listed:
        return None
    bodies = _functions(listed)
    if is_eigen and any(_jumps_back(line) for body in bodies.values() for line in body):
        return None
    total = _count(candidate.symbol, bodies)
    return dict(sorted(total.items())) | {"total": sum(total.values())}


def _counting(candidate: Candidate) -> Setting:
    return Setting("gcc", _COUNTING_TEMPLATES if candidate.name == "eigen" else _COUNTING)


def _disassembly(candidate: Candidate) -> str:
    made = compiled(candidate, _counting(candidate))
    return _run(["objdump", "-dr", "--no-show-raw-insn", str(made.object)])[0]


def _functions(listed: str) -> dict[str, list[str]]:
    parts = re.split(r"^[0-9a-f]+ <(\S+)>:\n", listed, flags=re.MULTILINE)
    return {name: body.splitlines() for name, body in zip(parts[1::2], parts[2::2], strict=True)}


def _count(symbol: str, bodies: dict[str, list[str]]) -> Counter[str]:
    total: Counter[str] = Counter()
    called = ""
    for line in bodies[symbol]:
        words = line.split()
        relocation = re.search(r"R_X86_64_\w+\s+(?:\.text\.)?([\w.$]+)", line)
        if relocation and called:
            called = relocation[1]
        elif len(words) > 1:
            _add_call(total, called, bodies)
            called = words[-1].strip("<>") if words[1] == "call" else ""
            kind = _OPERATIONS.get(words[1].removeprefix("v"))
            total.update([kind] if kind else [])
    _add_call(total, called, bodies)
    return total


def _add_call(total: Counter[str], called: str, bodies: dict[str, list[str]]) -> None:
    if called in bodies:
        total.update(_count(called, bodies))
    elif called == "fma":
        total.update(["add", "mul"])
    elif called in ("atan2", "sin", "cos", "sqrt", "sincos", "pow"):
        total[called] += 1


def _jumps_back(line: str) -> bool:
    found = re.match(r"\s*([0-9a-f]+):\s+j\w+\s+([0-9a-f]+)", line)
    return bool(found and int(found[2], 16) < int(found[1], 16))
