"""Write the timings as JSON and as tables."""

from __future__ import annotations

import json
import math
import platform
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.batch.timing import FLAGS, LANES, QUANTITIES, Timing


def setting() -> dict[str, Any]:
    """What the timings were taken with."""
    version = subprocess.run(["gcc", "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    information = Path("/proc/cpuinfo")
    models = re.findall(r"model name\s*: (.*)", information.read_text()) if information.exists() else []
    return {
        "compiler": version,
        "flags": " ".join(FLAGS),
        "processor": models[0] if models else platform.machine(),
        "routine": f"{', '.join(QUANTITIES)} together, conventional, body variation",
        "lanes": LANES,
    }


def write(folder: Path, timings: Sequence[Timing]) -> None:
    """Write ``results.json`` and ``results.md``."""
    document = {"setting": setting(), "unit": "ns per joint", "timings": [timing.as_dict() for timing in timings]}
    (folder / "results.json").write_text(json.dumps(document, indent=1) + "\n")
    (folder / "results.md").write_text("\n".join(_lines(timings)) + "\n")


def _lines(timings: Sequence[Timing]) -> list[str]:
    told = setting()
    lines = [
        "# Batch routines",
        "",
        f"{told['routine']}. {told['compiler']}, `{told['flags']}`, {told['processor']}.",
        "",
        "Nanoseconds of processor time per joint: median of interleaved rounds, in brackets the middle half of them in",
        "per cent.",
        "",
        "- *scalar*: the routine for one joint, in a loop.",
        "- *AoSoA*: `_loop`. *SoA*: `_soa`, its leading dimension no power of two.",
        "- *memory*: the inputs are read and the outputs written, and nothing is computed.",
    ]
    for real in dict.fromkeys(timing.real for timing in timings):
        for count in dict.fromkeys(timing.count for timing in timings):
            chosen = [t for t in timings if t.real == real and t.count == count]
            lines += ["", f"## {real}, {LANES[real]} lanes, {count} joint{'s' if count > 1 else ''}", ""]
            lines += _table(chosen)
    return lines


def _table(timings: Sequence[Timing]) -> list[str]:
    lines = [
        "| joint | scalar | AoSoA | SoA | memory | AoSoA / scalar | SoA / scalar | AoSoA / memory | GB/s of AoSoA |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    ratios: list[tuple[float, float, float]] = []
    for joint in dict.fromkeys(timing.joint for timing in timings):
        by = {t.way: t for t in timings if t.joint == joint}
        scalar, groups, arrays, memory = (by[way] for way in ("scalar", "aosoa", "soa", "memory"))
        ratios.append((groups.median / scalar.median, arrays.median / scalar.median, groups.median / memory.median))
        cells = [joint, *map(_cell, (scalar, groups, arrays, memory)), *(f"{ratio:.2f}" for ratio in ratios[-1])]
        lines.append(f"| {' | '.join([*cells, f'{groups.bytes / groups.median:.1f}'])} |")
    means = [math.exp(sum(math.log(row[k]) for row in ratios) / len(ratios)) for k in range(3)]
    lines.append(f"| geometric mean | | | | | {' | '.join(f'**{mean:.2f}**' for mean in means)} | |")
    return lines


def _cell(timing: Timing) -> str:
    spread = (timing.high - timing.low) / timing.median * 100
    return f"{timing.median:.3g} ({spread:.0f} %)"
