"""Write the results of the flag benchmark as Markdown tables."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any


def markdown(document: Mapping[str, Any]) -> str:
    """Two tables, times and instructions, and what the flags of each column are."""
    builds = list(document["flags"])
    lines = [
        "# Compiler flags, `--fma` and `-ffast-math`",
        "",
        f"phi, phi_q and (phi_q^T lambda)_q at once, conventional form, body variation. {document['compiler']},",
        f"{document['processor']}. Written by `make bench-flags`; what is measured and how: [measure.py](measure.py).",
        "",
        *(f"- ({k}) {name}: `{document['flags'][name]}`" for k, name in enumerate(builds, 1)),
        "",
        "## Time of a call",
        "",
        "Nanoseconds, median of interleaved rounds; the last line is the geometric mean of the ratios to (1).",
        "",
        *_table(document, builds, "ns"),
        "",
        "## Instructions of a call",
        "",
        "In the routine itself; `+n` are calls into the mathematical library, whose instructions are not counted.",
        "",
        *_table(document, builds, "instructions"),
    ]
    return "\n".join(lines) + "\n"


def _table(document: Mapping[str, Any], builds: list[str], key: str) -> list[str]:
    rows = ["| joint | " + " | ".join(f"({k})" for k in range(1, len(builds) + 1)) + " |"]
    rows.append("|---" * (len(builds) + 1) + "|")
    for joint, results in document["joints"].items():
        rows.append(f"| {joint} | " + " | ".join(_cell(results[name], key) for name in builds) + " |")
    means = [_mean(document, name, builds[0], key) for name in builds]
    return [*rows, "| ratio | " + " | ".join(f"{mean:.2f}" for mean in means) + " |"]


def _cell(result: Mapping[str, Any], key: str) -> str:
    if key == "ns":
        return f"{result['ns']:.1f}"
    return f"{result['instructions']}" + (f" +{result['calls']}" if result["calls"] else "")


def _mean(document: Mapping[str, Any], name: str, base: str, key: str) -> float:
    ratios = [results[name][key] / results[base][key] for results in document["joints"].values()]
    return math.exp(sum(map(math.log, ratios)) / len(ratios))
