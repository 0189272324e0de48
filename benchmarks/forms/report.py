"""The results as Markdown."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

_HEAD = (
    "scene",
    "form",
    "unknowns",
    "rows",
    "operations",
    "instructions",
    "ns",
    "to conventional",
    "run, ms",
    "to conventional",
)


def markdown(document: dict[str, Any]) -> str:
    """Write the table with what it means."""
    lines = [
        "# Forms of a scene",
        "",
        f"`make bench-forms`: {document['setting']}.",
        "",
        "Operations, instructions and ns of one evaluation, compiled: phi, phi_q, gamma and the forces at once; of",
        "relative coordinates M and f_C too (`jointgen flops FILE --measure`). Run: processor time of 1 s at a",
        "tolerance of 1e-6, all forms in one process, round by round: absolute coordinates by SUNDIALS, all of it",
        "compiled; relative ones by DOP853, with Newton's method and the reduction to independent coordinates in",
        "Python around compiled routines.",
        "",
        f"| {' | '.join(_HEAD)} |",
        f"|{'---|' * len(_HEAD)}",
        *(f"| {' | '.join(row)} |" for scene in document["scenes"] for row in _rows(scene)),
        "",
    ]
    return "\n".join(lines)


def _rows(scene: dict[str, Any]) -> Iterator[tuple[str, ...]]:
    first = scene["forms"][0]
    for entry in scene["forms"]:
        cost = entry["with_gamma"]
        yield (
            f"`{scene['scene']}`",
            entry["form"],
            str(entry["unknowns"]),
            str(entry["rows"]),
            str(cost["operations"]),
            str(cost["instructions"] or ""),
            _shown(cost["ns"]),
            _shown(cost["ns"] / first["with_gamma"]["ns"]),
            _shown(1e3 * entry["run"]),
            _shown(entry["run"] / first["run"]),
        )


def _shown(value: float) -> str:
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"
