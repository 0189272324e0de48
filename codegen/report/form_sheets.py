"""A scene by absolute and by relative coordinates as a table: unknowns, rows, operations and, if measured, times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from codegen.chains.beside import FormCost
from codegen.measure.evaluations import Evaluation, Measurement, Task, measured
from codegen.report.flop_commands import FlopResult
from codegen.report.sheets import Sheet
from flopcount.count import count

_NOTES = (
    "At once: phi, phi_q, the forces, and gamma or (phi_q^T lambda)_q; relative: J, M and f_C too, no second",
    "derivative. Conventional: of all joints on whose coordinates nothing acts.",
    "Unknowns and rows say how large the linear system is, which the operations leave out.",
)


def form_result(name: str, costs: Sequence[FormCost], is_measured: bool) -> FlopResult:
    """Tell what each form of a scene costs.

    Args:
        name: of the scene.
        costs: form by form.
        is_measured: whether evaluations are timed on this machine.

    Raises:
        SpecificationError: nothing can be measured, there is no C compiler.
    """
    programs = [[found for found in (cost.with_gamma, cost.with_second) if found is not None] for cost in costs]
    taken = measured([Task([one]) for found in programs for one in found], "double") if is_measured else None
    evaluations = iter(taken.evaluations if taken else ())
    data = []
    for cost, found in zip(costs, programs, strict=True):
        entry: dict[str, Any] = {"form": cost.form, "unknowns": cost.unknowns, "rows": cost.rows}
        for key, one in zip(("with_gamma", "with_second"), found, strict=False):
            entry[key] = {"operations": count(one).total, **(_times(next(evaluations)) if taken else {})}
        data.append(entry)
    lines = (
        [f"Measured on {taken.machine} with {taken.compiler}, medians of evaluations timed in turn."] if taken else []
    )
    return FlopResult({"scene": name, "forms": data}, lines, [_sheet(name, data, taken)])


def _times(evaluation: Evaluation) -> dict[str, Any]:
    return {"ns": evaluation.nanoseconds, "spread": evaluation.spread, "instructions": evaluation.instructions}


def _sheet(name: str, data: Sequence[dict[str, Any]], taken: Measurement | None) -> Sheet:
    heads = ["form", "unknowns", "rows"]
    kinds = {"with_gamma": "with gamma", "with_second": "with (phi_q^T lambda)_q"}
    units = {"operations": "operations", **({"ns": "ns"} if taken else {})}
    units |= {"instructions": "instructions"} if taken and not taken.uncounted else {}
    heads += [f"{unit} {words}" for unit in units.values() for words in kinds.values()]
    rows = []
    for entry in data:
        cells = [entry["form"], str(entry["unknowns"]), str(entry["rows"])]
        cells += [f"{entry[kind][unit]:.4g}" if kind in entry else "-" for unit in units for kind in kinds]
        rows.append(tuple(cells))
    return Sheet(f"{name}: one evaluation of the equations of motion, by form", tuple(heads), tuple(rows), _NOTES)
