"""Write the measurements as JSON, as a table and as a plot."""

from __future__ import annotations

import json
import platform
import re
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from benchmarks.scenes.measure import FLAGS, LONGEST, Measured
from codegen.report.svg import drawn

_MARKS = {"straight": "o", "loops": "s", "library": "^"}
_PANELS = (
    ("code", "bytes of the object"),
    ("generation", "generation, s"),
    ("compilation", "compilation, s"),
    ("median", "evaluation, ns per set"),
)


def setting() -> dict[str, Any]:
    """What the measurements were taken with."""
    version = subprocess.run(["gcc", "--version"], capture_output=True, text=True, check=True).stdout.splitlines()[0]
    information = Path("/proc/cpuinfo")
    models = re.findall(r"model name\s*: (.*)", information.read_text()) if information.exists() else []
    return {
        "compiler": version,
        "flags": " ".join(FLAGS),
        "processor": models[0] if models else platform.machine(),
        "scene": "examples/in_line_engine.toml, all of phi, phi_q, phi_q_t_lambda_q and gamma at once",
    }


def read(folder: Path) -> list[Measured]:
    """Read what was measured before."""
    file = folder / "results.json"
    return [Measured(**one) for one in json.loads(file.read_text())["measured"]] if file.exists() else []


def write(folder: Path, found: Sequence[Measured]) -> None:
    """Write ``results.json``, ``results.md`` and ``results.svg``."""
    document = {"setting": setting(), "measured": [one.as_dict() for one in found]}
    (folder / "results.json").write_text(json.dumps(document, indent=1) + "\n")
    (folder / "results.md").write_text("\n".join(_lines(found)) + "\n")
    (folder / "results.svg").write_text(plot(found))


def _lines(found: Sequence[Measured]) -> list[str]:
    told = setting()
    lines = [
        "# Many slider-cranks",
        "",
        f"{told['scene']}. {told['compiler']}, `{told['flags']}`, {told['processor']}.",
        "",
        "- *straight*: every set written out (`--loops never`). *loops*: one set in a loop (`--loops auto`); its",
        "  results are those of *straight*, bit for bit.",
        "- *library*: the library's conventional routine of each joint, called in a loop with run-time geometry, its",
        "  entries added to the same nonzeros of the scene.",
        "- *generation*: processor time from the scene with its forms and rows to the text in C.",
        f"- *compilation*: processor time of the compiler; *too long*: not tried, or over {LONGEST} s.",
        "- *ns per set*: processor time, median of interleaved rounds, in brackets the middle half of them.",
        "",
        "![code size, generation, compilation and evaluation over the number of sets](results.svg)",
        "",
        "| sets | shape | operations | bytes | generation, s | compilation, s | ns per set | ns | than the library |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    references = {one.sets: one.median for one in found if one.shape == "library"}
    return lines + [_line(one, references.get(one.sets)) for one in found]


def _line(one: Measured, reference: float | None) -> str:
    spread = f" ({100 * (one.high - one.low) / one.median:.0f} %)" if one.median and one.high and one.low else ""
    cells = [
        str(one.sets),
        one.shape,
        _number(one.operations, "d"),
        _number(one.code, "d"),
        _number(one.generation, ".2f"),
        _number(one.compilation, ".2f") if one.compilation is not None or one.shape == "library" else "too long",
        f"{_number(one.median, '.3g')}{spread}",
        _number(one.median and one.median * one.sets, ".3g"),
        f"{reference / one.median:.1f} times faster" if reference and one.median and one.shape != "library" else "",
    ]
    return f"| {' | '.join(cells)} |"


def _number(value: float | None, form: str) -> str:
    return "" if value is None else format(value, form)


def plot(found: Sequence[Measured]) -> str:
    """Draw the measurements over the number of sets: the same bytes for the same numbers."""

    def draw(figure: Figure) -> None:
        for axes, (key, words) in zip(figure.subplots(2, 2).flat, _PANELS, strict=True):
            for shape, mark in _MARKS.items():
                points = [(one.sets, getattr(one, key)) for one in found if one.shape == shape]
                points = [(x, y) for x, y in points if y is not None]
                if points:
                    axes.plot(*zip(*points, strict=True), marker=mark, label=shape)
            axes.set(xscale="log", yscale="log", xlabel="sets", ylabel=words)
            axes.grid(alpha=0.3)
            axes.legend()

    return drawn(draw, 8, 6)
