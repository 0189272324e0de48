"""The comparisons of S1 Tables 2 and 7 as plain data: printed, by the paper's rules, vectors first, as emitted.

Input: operations of programs. Output: documents of numbers and strings, which :mod:`codegen.report` shows as tables,
files and charts.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from flopcount.models import MODELS, Model, Operations
from flopcount.paper import BASIC_CONSTRAINTS, DERIVATIVES, FOOTNOTES, JOINTS, TABLE_2, TABLE_7, Derivative
from flopcount.rules import SWITCHES, Cell, Form, tally, verdict

Document = dict[str, Any]
Emitted = Mapping[tuple[str, Derivative], Mapping[str, Operations]]
"""(joint or basic constraint, derivative) -> kind of routine -> its operations."""

PerStep = Mapping[tuple[str, Derivative], Mapping[str, int]]
"""The same -> operations that are left for each step when the geometry is prepared."""

LeftOut = Mapping[str, Mapping[str, Operations]]
"""Joint -> what the paper takes as given -> its operations."""

COLUMNS: dict[str, str] = {
    "conventional": "conventional",
    "conventional_world": "conventional, world variation",
    "parametric": "parametric, regular rows, exact",
    "parametric_substituted": "parametric, regular rows, substituted",
    "parametric_table4": "parametric, table4 rows, exact",
    "parametric_table4_substituted": "parametric, table4 rows, substituted",
}
"""Kinds of routine: the symbol less its joint, and words."""

BASE = "conventional"

PAPERS_OWN = ("parametric_table4_substituted", "parametric_substituted")
"""The paper's own method as emitted: table4 rows, or the regular rows where they are the same."""


def paper_table_7(assume: Collection[str] = ()) -> Document:
    """Table 7 as printed and by the paper's rules.

    Args:
        assume: switches of :mod:`flopcount.rules` to set.

    Raises:
        UnknownNameError: there is no such switch.
    """
    return {
        "table": "7",
        "assume": list(assume),
        "rows": [_paper_row_7(joint, derivative, assume) for joint in JOINTS for derivative in DERIVATIVES],
        "footnotes": [str(FOOTNOTES["planar"]), str(FOOTNOTES["ball-rate"])],
        "switches": [
            {
                "name": switch.name,
                "assumption": switch.assumption,
                "justification": switch.justification,
                "explains": [str(cell) for cell in switch.explains],
                "also_changes": [str(cell) for cell in switch.also_changes],
            }
            for switch in SWITCHES.values()
        ],
    }


def _paper_row_7(joint: str, derivative: Derivative, assume: Collection[str]) -> Document:
    line = TABLE_7[joint]
    forms: tuple[Form, Form] = ("conventional", "parametric")
    printed = (line.conventional.of(derivative), line.proposed.of(derivative))
    ruled = [tally(joint, derivative, form, switches=assume) for form in forms]
    vectors = [tally(joint, derivative, form, order="vectors") for form in forms]
    return {
        "joint": joint,
        "derivative": derivative,
        "printed": _pair(*printed),
        "rules": _pair(*ruled)
        | {
            f"{form}_status": _status(Cell(form, joint, derivative), number, paper)
            for form, number, paper in zip(forms, ruled, printed, strict=True)
        },
        "vectors_first": _pair(*vectors),
    }


def _status(cell: Cell, number: int, printed: int) -> str:
    """Exact, or what would explain the printed number."""
    if number == printed:
        return "exact"
    return verdict(cell).status


def paper_table_2(assume: Collection[str] = ()) -> Document:
    """Table 2 as printed and by the paper's rules; the arguments are those of `paper_table_7`."""
    rows = []
    for name in BASIC_CONSTRAINTS:
        for derivative in DERIVATIVES:
            printed, number = TABLE_2[name].of(derivative), tally(name, derivative, "basic", switches=assume)
            rows.append(
                {
                    "constraint": name,
                    "derivative": derivative,
                    "printed": printed,
                    "rules": number,
                    "status": _status(Cell("basic", name, derivative), number, printed),
                    "vectors_first": tally(name, derivative, "basic", order="vectors"),
                }
            )
    return {"table": "2", "assume": list(assume), "rows": rows, "footnotes": []}


def table_7(
    emitted: Emitted, left_out: LeftOut, models: Mapping[str, Model] = MODELS, per_step: PerStep | None = None
) -> Document:
    """Compare every joint of the library with Table 7; a joint that is not in the paper has our numbers only.

    Args:
        emitted: operations of the routines.
        left_out: operations that the paper does not count on either side.
        models: how to price them.
        per_step: operations of a step on prepared geometry.
    """
    document = paper_table_7()
    of_paper = {(row["joint"], row["derivative"]): row for row in document["rows"]}
    rows = []
    for (joint, derivative), kinds in emitted.items():
        row = of_paper.get((joint, derivative), {"joint": joint, "derivative": derivative})
        own = next(column for column in PAPERS_OWN if column in kinds)
        rows.append(
            row
            | {
                "emitted": _emitted(kinds, models),
                "fair": _pair(kinds[BASE].counts.total, kinds[own].counts.total),
                "per_step": dict((per_step or {}).get((joint, derivative), {})),
                "left_out": {name: operations.counts.as_dict() for name, operations in left_out[joint].items()},
            }
        )
    return document | _headings(models, COLUMNS) | {"rows": rows}


def table_2(emitted: Emitted, models: Mapping[str, Model] = MODELS) -> Document:
    """Compare the basic constraints of the conventional form with Table 2."""
    document = paper_table_2()
    columns = {column: words for column, words in COLUMNS.items() if column.startswith(BASE)}
    rows = [
        row | {"emitted": _emitted(emitted[row["constraint"], row["derivative"]], models)} for row in document["rows"]
    ]
    return document | _headings(models, columns) | {"rows": rows}


def _headings(models: Mapping[str, Model], columns: Mapping[str, str]) -> Document:
    return {"columns": dict(columns), "models": {name: model.words for name, model in models.items()}}


def _pair(conventional: int, parametric: int) -> Document:
    return {
        "conventional": conventional,
        "parametric": parametric,
        "rate_percent": round(100.0 * parametric / conventional, 1),
    }


def _emitted(kinds: Mapping[str, Operations], models: Mapping[str, Model]) -> Document:
    base = {name: model.price(kinds[BASE]) for name, model in models.items()}
    return {
        column: operations.counts.as_dict()
        | {
            "prices": {name: round(model.price(operations), 1) for name, model in models.items()},
            "rates_percent": {
                name: round(100.0 * model.price(operations) / base[name], 1) for name, model in models.items()
            },
        }
        for column, operations in kinds.items()
    }
