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
    "error, m",
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
        "tolerance of 1e-6, median of rounds of all forms in one process, with start and outputs at both ends;",
        "absolute coordinates by SUNDIALS, relative ones by DOP853, both compiled. Error: largest difference of a",
        "position at the end from the conventional run at 1e-12.",
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
            f"{entry['error']:.1e}",
        )


def _shown(value: float) -> str:
    return f"{value:.0f}" if value >= 100 else f"{value:.3g}"
