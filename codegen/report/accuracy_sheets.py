"""Tables of measured accuracy: one line for each routine in each build."""

from __future__ import annotations

from codegen.report.sheets import Document, Sheet

_NOTES = (
    "e/S: largest error over the scale of the block, against the given inputs; eta: error over what rounding the",
    "inputs does; floor: what ideal geometry would differ by; ULP: median and 99 of 100. Worst of both states.",
    "Times are advice.",
)


def accuracy_sheet(document: Document, joint: str) -> Sheet:
    """One joint: errors block by block, time and instructions; an asterisk marks the Pareto front."""
    rows = []
    fronts = {tuple(key) for key in document["advice"]["fronts"][joint]}
    for candidate, advice in zip(document["candidates"], document["advice"]["candidates"], strict=True):
        if candidate["joint"] != joint:
            continue
        key = (candidate["routine"], candidate["build"])
        times = [f"{advice['nanoseconds']:.1f}", f"{100 * advice['spread']:.0f} %", str(advice["instructions"] or "-")]
        name = f"{'* ' if key in fronts else ''}{candidate['routine'].removeprefix(f'jg_{joint}_')}"
        for k, cells in enumerate(_blocks(candidate)):
            head = [name, candidate["build"]] if k == 0 else ["", ""]
            rows.append((*head, *cells, *(times if k == 0 else ["", "", ""])))
    columns = (
        "routine",
        "build",
        "block",
        "e/S",
        "mean",
        "eta",
        "floor",
        "ULP",
        "99 %",
        "ns",
        "spread",
        "instructions",
    )
    kind = "scene" if "scene" in document["request"] else "joint"
    title = f"Accuracy of the {joint} {kind}, {document['samples']} poses converged and as many in mid-iteration"
    return Sheet(title, columns, tuple(rows), _NOTES)


def summary_sheet(document: Document) -> Sheet:
    """Every routine in a line."""
    rows = [
        (
            candidate["routine"],
            candidate["build"],
            f"{candidate['error']:.1e}",
            f"{candidate['eta']:.2f}",
            f"{advice['nanoseconds']:.1f}",
            f"{100 * advice['spread']:.0f} %",
        )
        for candidate, advice in zip(document["candidates"], document["advice"]["candidates"], strict=True)
    ]
    title = f"Accuracy of the library, {document['samples']} poses converged and as many in mid-iteration"
    return Sheet(title, ("routine", "build", "e/S", "eta", "ns", "spread"), tuple(rows), _NOTES)


def _blocks(candidate: Document) -> list[tuple[str, ...]]:
    """The figures of each block, the worse of both states."""
    lines: list[tuple[str, ...]] = []
    for states in zip(*candidate["figures"].values(), strict=True):
        worst = {name: max(state[name] for state in states) for name in states[0] if name != "block"}
        lines.append(
            (
                states[0]["block"],
                f"{worst['largest']:.1e}",
                f"{worst['mean']:.1e}",
                f"{worst['eta']:.2f}",
                f"{worst['floor']:.1e}",
                _units(states[-1]["ulp_median"]),
                _units(states[-1]["ulp_99"]),
            )
        )
    return lines


def _units(value: float) -> str:
    return f"{value:.2g}"
