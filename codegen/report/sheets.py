"""Sheets: tables as headings and cells, ready to be shown on a terminal or written as Markdown.

Input: the documents of :mod:`flopcount.compare`. What a table shows is decided here and nowhere else.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

Document = Mapping[str, Any]

_WORDS = {"phi_q": "phi_q", "phi_q_t_lambda_q": "(phi_q^T lambda)_q"}
_KINDS = ("add", "mul", "div", "sqrt", "sincos", "sin", "cos", "atan2", "neg")


@dataclass(frozen=True, slots=True)
class Sheet:
    """A table.

    Attributes:
        title: what it shows.
        columns: headings; the first column holds names.
        rows: cells, one string for each heading.
        notes: lines below it.
    """

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()


def glance(document: Document) -> Sheet:
    """Table 7's rates beside the rates of a fair count: the one table to read."""
    rows = []
    for row in document["rows"]:
        if "printed" in row:
            rates = [row[key]["rate_percent"] for key in ("printed", "rules", "vectors_first", "fair")]
            rows.append((row["joint"], _WORDS[row["derivative"]], *(f"{rate:.1f} %" for rate in rates)))
    return Sheet(
        "S1 Table 7 at a glance: parametric over conventional",
        ("joint", "derivative", "printed", "by the paper's rules", "vectors first", "everything counted, as emitted"),
        tuple(rows),
        (
            "By the paper's rules: both sides by rules R0 to R5. Vectors first: the same formulas, products evaluated",
            "from the vector. As emitted: the paper's own rows and derivative (table4, substituted; regular where they",
            "are the same), A_ij(alpha), sines and cosines included, over the conventional routine in body variation.",
        ),
    )


def printed_and_rules(document: Document) -> Sheet:
    """Table 7's counts as printed and as the paper's rules give them."""
    rows = []
    for row in document["rows"]:
        if "printed" not in row:
            continue
        cells = [row["joint"], _WORDS[row["derivative"]]]
        for side in ("conventional", "parametric"):
            cells += [str(row[key][side]) for key in ("printed", "rules", "vectors_first")]
            cells.append(row["rules"][f"{side}_status"])
        rows.append(tuple(cells))
    heads = ("printed", "rules", "vectors first", "verdict")
    columns = ("joint", "derivative", *(f"{side} {head}" for side in ("conv.", "param.") for head in heads))
    return Sheet("S1 Table 7: printed and by the paper's rules", columns, tuple(rows), tuple(document["footnotes"]))


def emitted(document: Document, derivative: str, model: str = "paper") -> Sheet:
    """Our counts for one derivative, with rates in percent of the conventional routine."""
    key = "joint" if document["table"] == "7" else "constraint"
    rows = []
    for row in document["rows"]:
        if row["derivative"] == derivative:
            cells = [_printed_cell(row), *(_priced(row["emitted"], column, model) for column in document["columns"])]
            rows.append((row[key], *cells))
    words = document["models"][model]
    return Sheet(
        f"S1 Table {document['table']}, {_WORDS[derivative]}: printed and as emitted ({words})",
        (key, "printed", *document["columns"].values()),
        tuple(rows),
        ("Rates are in percent of the conventional routine in body variation. Everything is counted.",),
    )


def per_step(document: Document) -> Sheet:
    """What prepared geometry leaves of our counts: operations of a step."""
    rows = tuple(
        (row["joint"], _WORDS[row["derivative"]], *(str(row["per_step"].get(name, "")) for name in document["columns"]))
        for row in document["rows"]
    )
    return Sheet(
        f"S1 Table {document['table']} as emitted, operations a step with prepared geometry",
        ("joint", "derivative", *document["columns"].values()),
        rows,
        ("What depends on the geometry alone is computed once (jointgen generate --geometry prepared).",),
    )


def _printed_cell(row: Document) -> str:
    printed = row.get("printed")
    if printed is None:
        return "-"
    if isinstance(printed, int):
        return str(printed)
    return f"{printed['conventional']} | {printed['parametric']} ({printed['rate_percent']:.1f} %)"


def _priced(kinds: Document, column: str, model: str) -> str:
    if column not in kinds:
        return ""
    price, rates = kinds[column]["prices"][model], kinds[column]["rates_percent"]
    rate = f" ({rates[model]:.0f} %)" if model in rates else ""
    return f"{price:.1f}{rate}" if price != int(price) else f"{price:.0f}{rate}"


def by_kind(document: Document) -> Sheet:
    """Our counts kind by kind."""
    key = "joint" if document["table"] == "7" else "constraint"
    rows = []
    for row in document["rows"]:
        for column, words in document["columns"].items():
            counts = row["emitted"].get(column)
            if counts is not None:
                numbers = [str(counts[kind]) for kind in ("total", *_KINDS)]
                rows.append((row[key], _WORDS[row["derivative"]], words, *numbers))
    title = f"S1 Table {document['table']} as emitted, by kind of operation (a change of sign is free)"
    return Sheet(title, (key, "derivative", "routine", "total", *_KINDS), tuple(rows))


def left_out(document: Document) -> Sheet:
    """What the paper takes as given, as emitted."""
    names = ("d_ij", "A_ij", "A_ij(alpha)", "dA_ij/dalpha")
    rows = []
    for row in document["rows"]:
        if row["derivative"] == "phi_q":
            parts = [row["left_out"].get(name) for name in names]
            totals = [str(counts["total"] - _angles(counts)) if counts else "0" for counts in parts]
            rows.append((row["joint"], *totals, str(_angles(row["left_out"]["A_ij(alpha)"]))))
    return Sheet(
        "Operations that the paper leaves out",
        (
            "joint",
            "d_ij",
            "A_ij (conv.)",
            "A_ij(alpha) (param.)",
            "its derivatives (param.)",
            "sine-cosine pairs (param.)",
        ),
        tuple(rows),
    )


def _angles(counts: Document) -> int:
    return int(counts["sincos"] + counts["sin"] + counts["cos"])


def printed_and_rules_2(document: Document) -> Sheet:
    """Table 2's counts as printed and as the paper's rules give them."""
    rows = tuple(
        (
            row["constraint"],
            _WORDS[row["derivative"]],
            *(str(row[key]) for key in ("printed", "rules", "vectors_first")),
            row["status"],
        )
        for row in document["rows"]
    )
    columns = ("constraint", "derivative", "printed", "by the paper's rules", "vectors first", "verdict")
    return Sheet("S1 Table 2: printed and by the paper's rules", columns, rows)


def switches(documents: Sequence[Document]) -> Sheet:
    """The assumptions that would explain printed numbers which the rules do not give."""
    rows = tuple((d["name"], d["assumption"], d["justification"], "; ".join(d["explains"])) for d in documents)
    columns = ("switch", "assumption", "justification", "explains")
    return Sheet("Assumptions, off by default (jointgen flops --rules paper --assume NAME)", columns, rows)
