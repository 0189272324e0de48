"""Time and count the fused routines under compiler flags, with and without ``--fma``, and with ``-ffast-math``.

The routine of each joint evaluates phi, phi_q and (phi_q^T lambda)_q at once: conventional form, body variation. Every
build is called in turn, round after round, on the same poses; a time is the median of the rounds. An instruction count
is that of the object code: a routine has no branch, so each is executed once. ``-ffast-math`` is refused by the header;
here its macro is undefined by force, for the comparison.

Run by ``make bench-flags``; writes results.json and results.md beside this file.
"""

from __future__ import annotations

import ctypes
import json
import re
import statistics
import subprocess
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2
import numpy as np

from benchmarks.flags.table import markdown
from codegen import build, output
from codegen.mechanics.joints import JOINTS
from codegen.spec.request import Options

HERE = Path(__file__).resolve().parent
OUTPUTS = ("phi", "phi_q", "phi_q_t_lambda_q", "all")
SAME_BITS = ("-ffp-contract=off", "-fno-tree-slp-vectorize")
NATIVE = ("-O3", "-march=native")
FAST = ("-ffast-math", "-U__FAST_MATH__")
BUILDS: dict[str, tuple[bool, tuple[str, ...]]] = {
    "-O2": (False, ("-O2", *SAME_BITS)),
    "-O3": (False, ("-O3", *SAME_BITS)),
    "-O3 native": (False, (*NATIVE, *SAME_BITS)),
    "-O3 native, compiler's own choice": (False, NATIVE),
    "-O3 native -ffast-math": (False, (*NATIVE, *FAST)),
    "--fma, -O2 (library call)": (True, ("-O2", *SAME_BITS)),
    "--fma, -O2 -mfma": (True, ("-O2", "-mfma", *SAME_BITS)),
    "--fma, -O3 native": (True, (*NATIVE, *SAME_BITS)),
    "--fma, -O3 native, compiler's own choice": (True, NATIVE),
    "--fma, -O3 native -ffast-math": (True, (*NATIVE, *FAST)),
}
POSES, REPETITIONS, ROUNDS = 64, 30, 151
_INSTRUCTION = re.compile(r"^\s+[0-9a-f]+:\s+(\S+)", re.MULTILINE)


@dataclass(frozen=True)
class Built:
    """One build of one routine: its entry point, instructions and calls of library functions."""

    run: Any
    instructions: int
    calls: int


def main() -> None:
    """Measure every joint and write the results."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for fma in (False, True):
            request = Options(form="conventional", variation="body", outputs=OUTPUTS, fma=fma)
            output.replace(folder / f"fma-{fma}", build.generate(request))
        joints = {joint: measured(folder, joint) for joint in JOINTS}
    compiler = subprocess.run(["gcc", "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    document = {"compiler": compiler, "processor": processor(), "flags": flags(), "joints": joints}
    (HERE / "results.json").write_text(json.dumps(document, indent=1) + "\n")
    (HERE / "results.md").write_text(markdown(document))


def flags() -> dict[str, str]:
    """Build -> its flags in full."""
    return {name: " ".join(("--fma;", *words) if fma else words) for name, (fma, words) in BUILDS.items()}


def processor() -> str:
    """What the machine calls its processor."""
    cpu = Path("/proc/cpuinfo")
    match = re.search(r"model name\s*:\s*(.*)", cpu.read_text()) if cpu.exists() else None
    return match[1] if match else "unknown"


def measured(folder: Path, joint: str) -> dict[str, dict[str, Any]]:
    """Nanoseconds a call, their spread (quartiles), instructions and library calls of every build."""
    entries = {fma: entry_of(folder / f"fma-{fma}", joint) for fma in (False, True)}
    builds = {
        name: compiled(folder / f"fma-{fma}", entries[fma], words, folder / f"{joint}-{k}")
        for k, (name, (fma, words)) in enumerate(BUILDS.items())
    }
    inputs, outputs = arrays(entries[False])
    times: dict[str, list[float]] = {name: [] for name in builds}
    for _ in range(ROUNDS):
        for name, built in builds.items():
            start = time.perf_counter_ns()
            built.run(inputs.ctypes.data, outputs.ctypes.data, POSES, REPETITIONS)
            times[name].append((time.perf_counter_ns() - start) / (POSES * REPETITIONS))
    results = {}
    for name, built in builds.items():
        lower, median, upper = statistics.quantiles(times[name], n=4)
        results[name] = {
            "ns": round(median, 2),
            "quartiles": [round(lower, 2), round(upper, 2)],
            "instructions": built.instructions,
            "calls": built.calls,
        }
    return results


def entry_of(package: Path, joint: str) -> dict[str, Any]:
    """Manifest entry of the fused routine that stores nonzeros."""
    functions = json.loads((package / "manifest.json").read_text())["functions"]
    return next(e for e in functions if (e["joint"], e["output"], e["storage"]) == (joint, "all", "nz"))


def arrays(entry: dict[str, Any]) -> tuple[Any, Any]:
    """Random inputs of all poses and room for the outputs of one; the work does not depend on the values."""
    inputs = sum(a["length"] for a in entry["arguments"] if a["direction"] == "in")
    outputs = sum(a["length"] for a in entry["arguments"] if a["direction"] == "out")
    return np.random.default_rng(1).normal(size=POSES * inputs), np.zeros(outputs)


def compiled(package: Path, entry: dict[str, Any], words: tuple[str, ...], target: Path) -> Built:
    """Compile a routine with the flags of a build and the loop around it with others."""
    include = f"-I{package / 'c/include'}"
    loop, routine, library = target.with_suffix(".c"), target.with_suffix(".o"), target.with_suffix(".so")
    loop.write_text(loop_text(entry))
    common = ["gcc", "-std=gnu99", "-fPIC", include]
    subprocess.run([*common, *words, "-c", str(package / entry["source"]), "-o", str(routine)], check=True)
    subprocess.run([*common, "-O2", "-shared", str(loop), str(routine), "-lm", "-o", str(library)], check=True)
    run = ctypes.CDLL(str(library)).run
    run.argtypes, run.restype = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_long, ctypes.c_long], None
    return Built(run, *instructions(routine, entry["symbol"]))


def loop_text(entry: dict[str, Any]) -> str:
    """C source of the loop: each argument is a piece of one array of inputs or of outputs."""
    offsets, words = {"in": 0, "out": 0}, []
    for argument in entry["arguments"]:
        array = "in" if argument["direction"] == "in" else "outputs"
        words.append(f"{array} + {offsets[argument['direction']]}")
        offsets[argument["direction"]] += argument["length"]
    template = jinja2.Template((HERE / "loop.c.j2").read_text(), keep_trailing_newline=True)
    text: str = template.render(
        joint=entry["joint"], symbol=entry["symbol"], stride=offsets["in"], arguments=", ".join(words)
    )
    return text


def instructions(path: Path, symbol: str) -> tuple[int, int]:
    """Instructions of a routine without branches, and how many of them are calls."""
    command = ["objdump", "-d", "--no-show-raw-insn", f"--disassemble={symbol}", str(path)]
    text = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    words = _INSTRUCTION.findall(text)
    words = words[: max(k for k, word in enumerate(words) if word.startswith(("ret", "jmp"))) + 1]
    if any(word.startswith("j") and word != "jmp" for word in words):
        raise SystemExit(f"{symbol}: the code branches, its instructions cannot be counted so")
    return len(words), sum(word.startswith("call") for word in words)


if __name__ == "__main__":
    main()
