"""The figures as tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

Row = dict[str, Any]

OTHERS_WORDS = (
    '- *In the plane*: the same engine with `motion = "planar"`, which halves the unknowns.',
    "- *CasADi idas*: the equations of the conventional form, derived by CasADi and interpreted; SUNDIALS too.",
    "- *MuJoCo*: a tree with three coordinates an engine; an equality constraint closes the loop. It is soft, here as",
    "  stiff as the step allows; integrated by RK4.",
    "- *Exudyn*: absolute coordinates, generalised alpha, which is of second order: it needs 5e3 steps for this error.",
)


def markdown(document: dict[str, Any]) -> str:
    """Write ``results.md``."""
    sizes = sorted({int(sets) for row in document["others"]["rows"] for sets in row["seconds"]})
    parts = [
        "# In-line engine",
        "",
        f"`examples/in_line_engine.toml` in space with gravity, {document['setting']}.",
        "Index 2, stabilised; processor seconds of the integration, median of interleaved rounds.",
        "",
        "## S1, Fig. 4: the piston",
        "",
        "![velocity and acceleration of the piston](piston.svg)",
        "",
        "Over 1 s at a tolerance of 1e-8. Largest difference of two curves over their range:",
        "",
        *_table(
            ("curves", "velocity", "acceleration"),
            [(words, f"{row['v']:.1e}", f"{row['a']:.1e}") for words, row in document["piston"].items()],
        ),
        "",
        "## Work and precision",
        "",
        "![error against time and tolerance](work_precision.svg)",
        "",
        "Largest error over 2 s against the engine as one degree of freedom, integrated to 1e-13; drift of all",
        "constraints.",
        "",
        *_work(document["work_precision"]),
        "",
        "## What terms of the Jacobian are worth",
        "",
        "2 s at a tolerance of 1e-8, without terms of the Jacobian.",
        "",
        *_terms(document["without_terms"]),
        "",
        "## S1, Table 8: time by size",
        "",
        "1 s at a tolerance of 1e-6, sets side by side in one system. The ratio is parametric over conventional.",
        "",
        *_sizes(document["by_size"]),
        "",
        "Steps, Newton iterations and evaluations, conventional / parametric:",
        "",
        *_counts(document["by_size"]),
        "",
        "## Other programs",
        "",
        "1 s at an error of 1e-6 m: at the loosest setting (tolerance, or step in s) with that error for one engine.",
        "All programs in one process, round by round. Where a cell is empty a run takes longer than 4 s.",
        "",
        *_others(document["others"], sizes),
        "",
        *OTHERS_WORDS,
        "",
    ]
    return "\n".join(parts)


def _table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    lines = [f"| {' | '.join(head)} |", f"|{'---|' * len(head)}"]
    return lines + [f"| {' | '.join(row)} |" for row in rows]


def _work(rows: list[Row]) -> list[str]:
    head = ("tolerance", "form", "position, m", "velocity, m/s", "acceleration, m/s²", "drift, m", "steps", "s")
    cells: list[Sequence[str]] = []
    for row in rows:
        words: Sequence[str]
        if "failure" in row:
            words = (row["failure"], "", "", "", "")
        else:
            numbers = (f"{row[key]:.1e}" for key in ("position", "velocity", "acceleration", "drift"))
            words = (*numbers, str(row["steps"]))
        cells.append((f"{row['tolerance']:.0e}", row["form"], *words, f"{row['seconds']:.4f}"))
    return _table(head, cells)


def _terms(rows: list[Row]) -> list[str]:
    counters = ("steps", "newton_iterations", "jacobians", "error_test_failures", "convergence_failures")
    head = ("form", "left out", *(name.replace("_", " ") for name in counters), "s", "time reached, s")
    return _table(
        head,
        [
            (
                row["form"],
                f"`{row['left_out']}`" if "_" in row["left_out"] else row["left_out"],
                *(str(row[name]) for name in counters),
                f"{row['seconds']:.3f}",
                f"{row['time_reached']:g}",
            )
            for row in rows
        ],
    )


def _sizes(rows: list[Row]) -> list[str]:
    head = ("sets", "conventional, s", "parametric, s", "ratio", "per set, ms", "S1, s", "S1, ratio")
    cells = []
    for row in rows:
        printed = row["printed"]
        paper = (f"{printed[0]:.2f} / {printed[1]:.2f}", f"{printed[1] / printed[0]:.2f}") if printed else ("", "")
        per_set = " / ".join(f"{1e3 * row[form] / row['sets']:.2f}" for form in ("conventional", "parametric"))
        times = (f"{row['conventional']:.4f}", f"{row['parametric']:.4f}", f"{row['ratio']:.2f}")
        cells.append((str(row["sets"]), *times, per_set, *paper))
    return _table(head, cells)


def _counts(rows: list[Row]) -> list[str]:
    names = ("steps", "newton_iterations", "residuals", "jacobians", "error_test_failures")
    head = ("sets", *(name.replace("_", " ") for name in names))
    cells = [
        (str(row["sets"]), *(" / ".join(str(count[name]) for count in row["counts"].values()) for name in names))
        for row in rows
    ]
    return _table(head, cells)


def _others(found: Row, sizes: Sequence[int]) -> list[str]:
    first = found["rows"][0]["seconds"]
    head = (
        "program",
        "setting",
        "error, m",
        *(f"{sets} sets, ms" for sets in sizes),
        "to ours",
        "least error, m",
    )
    cells = []
    for row in found["rows"]:
        times = (f"{1e3 * row['seconds'][str(n)]:.1f}" if str(n) in row["seconds"] else "" for n in sizes)
        ratio = " / ".join(f"{seconds / first[n]:.1f}" for n, seconds in row["seconds"].items())
        finest = f"{row['finest']['error']:.1e} at {row['finest']['setting']:.1e}"
        cells.append((row["program"], f"{row['setting']:.1e}", f"{row['error']:.1e}", *times, ratio, finest))
    missing = [f"Not installed: {', '.join(found['missing'])}.", ""] if found["missing"] else []
    return [*missing, *_table(head, cells)]
