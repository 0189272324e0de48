"""Generate, compile and time the batch routines of one number type."""

from __future__ import annotations

import json
import statistics
import subprocess
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import jinja2

from codegen import build, output
from codegen.spec.request import Options

HERE = Path(__file__).resolve().parent
JOINTS = ("revolute", "translational", "screw", "cylindrical", "universal", "planar", "ball")
QUANTITIES = ("phi", "phi_q", "phi_q_t_lambda_q")
LANES = {"double": 4, "float": 8}
COUNTS = (1, 7, 64, 4096, 1_000_000)
WAYS = ("scalar", "aosoa", "soa", "memory")
"""One joint at a time; groups; arrays; the inputs read and the outputs written, nothing computed."""
FLAGS = ("-std=gnu11", "-O3", "-march=native")

_JOINTS_A_MEASUREMENT = 20_000
_ROUNDS = {1_000_000: 5}


@dataclass(frozen=True, slots=True)
class Timing:
    """Nanoseconds per joint over the rounds of one way.

    Attributes:
        real: number type.
        joint: name in the catalogue.
        count: joints in a call.
        way: one of `WAYS`.
        median: of the rounds.
        low: first quartile.
        high: third quartile.
        bytes: read and written for a joint.
    """

    real: str
    joint: str
    count: int
    way: str
    median: float
    low: float
    high: float
    bytes: int

    def as_dict(self) -> dict[str, Any]:
        """Plain data, times in four digits."""
        return {key: float(f"{v:.4g}") if isinstance(v, float) else v for key, v in asdict(self).items()}


def timings(
    real: str, rounds: int, joints: tuple[str, ...], counts: tuple[int, ...], tell: Callable[[str], None]
) -> Iterator[Timing]:
    """Time every joint and count in one number type."""
    lanes = LANES[real]
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        options = Options(joints, "conventional", None, None, "body", real, (*QUANTITIES, "all"), lanes)
        output.replace(root / "package", build.generate(options))
        for joint in joints:
            tell(f"{real} {joint}")
            entry = _entry(root / "package", joint)
            program = _compiled(root, joint, entry, lanes)
            size = (8 if real == "double" else 4) * sum(a["length"] for a in entry["arguments"])
            for count in counts:
                for way, times in _run(program, count, min(rounds, _ROUNDS.get(count, rounds))).items():
                    low, median, high = statistics.quantiles(times, n=4, method="inclusive")
                    yield Timing(real, joint, count, way, median, low, high, size)


def _entry(package: Path, joint: str) -> dict[str, Any]:
    functions = json.loads((package / "manifest.json").read_text())["functions"]
    entry: dict[str, Any] = next(f for f in functions if f["joint"] == joint and f["output"] == "all")
    return entry


def _compiled(root: Path, joint: str, entry: dict[str, Any], lanes: int) -> Path:
    template = jinja2.Template((HERE / "driver.c.j2").read_text(), undefined=jinja2.StrictUndefined, trim_blocks=True)
    source, program = root / f"{joint}.c", root / joint
    inputs = [a for a in entry["arguments"] if a["direction"] == "in"]
    source.write_text(
        template.render(joint=joint, symbol=entry["symbol"], lanes=lanes, inputs=inputs, arrays=entry["arguments"])
    )
    stem = root / "package" / entry["source"].removesuffix(".c")
    include = f"-I{root / 'package/c/include'}"
    sources = [str(source), f"{stem}.c", f"{stem}_batch{lanes}.c"]
    subprocess.run(["gcc", *FLAGS, include, *sources, "-lm", "-o", str(program)], check=True)
    return program


def _run(program: Path, count: int, rounds: int) -> dict[str, list[float]]:
    calls = max(1, _JOINTS_A_MEASUREMENT // count)
    done = subprocess.run([program, str(count), str(calls), str(rounds)], capture_output=True, text=True, check=True)
    times: dict[str, list[float]] = {way: [] for way in WAYS}
    for line in done.stdout.splitlines():
        way, time = line.split()
        times[WAYS[int(way)]].append(float(time))
    return times
