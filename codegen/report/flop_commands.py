"""What ``jointgen flops`` answers: sheets, lines or data, from a validated request."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from codegen import comparison
from codegen.errors import Mistake, SpecificationError, nearest
from codegen.measure.operation_costs import operation_costs
from codegen.report import flop_files
from codegen.report.explanations import explanation
from codegen.report.sheets import (
    Document,
    Sheet,
    emitted,
    glance,
    per_step,
    printed_and_rules,
    printed_and_rules_2,
    switches,
)
from flopcount.compare import paper_table_2, paper_table_7
from flopcount.models import MODELS, measured
from flopcount.paper import DERIVATIVES
from flopcount.rules import SWITCHES, UnknownNameError

_RULES = ("program", "paper")
_TABLES = ("2", "7", "all")
_MODELS = (*MODELS, "measured")


@dataclass(frozen=True, slots=True)
class FlopRequest:
    """The options of the command.

    Attributes:
        rules: ``program`` or ``paper``.
        table: ``2``, ``7`` or ``all``.
        model: name of a price model.
        explain: joint or basic constraint to derive, or None.
        assume: switches of the paper's rules.
    """

    rules: str
    table: str
    model: str
    explain: str | None
    assume: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class FlopResult:
    """The answer: lines and sheets to show, and the same as data."""

    data: Any
    lines: list[str] = field(default_factory=list)
    sheets: list[Sheet] = field(default_factory=list)


def check(request: FlopRequest) -> None:
    """Refuse unknown names and options that do not go together.

    Raises:
        SpecificationError: all mistakes at once.
    """
    choices = [
        ("--rules", request.rules, _RULES),
        ("--table", request.table, _TABLES),
        ("--model", request.model, _MODELS),
    ]
    choices += [("--assume", switch, tuple(SWITCHES)) for switch in request.assume]
    mistakes = [
        Mistake(option, f'there is no "{value}"', nearest(value, known))
        for option, value, known in choices
        if value not in known
    ]
    if request.rules == "program" and (request.explain or request.assume):
        option = "--explain" if request.explain else "--assume"
        mistakes.append(Mistake(option, "belongs to the paper's rules", "add --rules paper"))
    if request.rules == "paper" and request.model != "paper":
        mistakes.append(Mistake("--model", "the paper's rules price every operation the same", "leave --model out"))
    if mistakes:
        raise SpecificationError(mistakes)


def steps(request: FlopRequest) -> int:
    """How many times the progress is told."""
    return len(comparison.counted_variants()) if request.rules == "program" else 0


def result(request: FlopRequest, progress: Callable[[str], None]) -> FlopResult:
    """Answer the request.

    Raises:
        SpecificationError: the joint to explain is unknown, or nothing can be measured.
    """
    if request.explain is not None:
        return _explained(request.explain, request)
    if request.rules == "paper":
        return _by_rules(request)
    models = dict(MODELS)
    if request.model == "measured":
        models["measured"] = measured(operation_costs())
    documents = comparison.tables(progress, models)
    chosen = _chosen(request, documents["table2"], documents["table7"])
    sheets: list[Sheet] = []
    for document in chosen.values():
        if document["table"] == "7":
            sheets.append(glance(document))
        if request.table == "all" and request.model == "paper":
            sheets += (flop_files.sheets_7 if document["table"] == "7" else flop_files.sheets_2)(document)
        else:
            sheets += [emitted(document, derivative, request.model) for derivative in DERIVATIVES]
            sheets += [per_step(document)] if document["table"] == "7" and request.model == "paper" else []
    lines = _cost_lines(models["measured"].prices) if request.model == "measured" else []
    return FlopResult(chosen, lines, list(dict.fromkeys(sheets)))


def _cost_lines(prices: Any) -> list[str]:
    return ["Cost of an operation on this machine, in additions: " + ", ".join(f"{k} {v:g}" for k, v in prices.items())]


def _explained(name: str, request: FlopRequest) -> FlopResult:
    try:
        lines = list(explanation(name, request.table, request.assume))
    except UnknownNameError as error:
        raise SpecificationError(
            [Mistake("--explain", f'there is no {error.kind} "{name}"', nearest(name, error.known))]
        ) from error
    return FlopResult(lines, lines)


def _by_rules(request: FlopRequest) -> FlopResult:
    chosen = _chosen(request, paper_table_2(request.assume), paper_table_7(request.assume))
    sheets = [
        printed_and_rules(document) if document["table"] == "7" else printed_and_rules_2(document)
        for document in chosen.values()
    ]
    return FlopResult(chosen, sheets=[*sheets, switches(paper_table_7()["switches"])])


def _chosen(request: FlopRequest, table_2: Document, table_7: Document) -> dict[str, Document]:
    tables = {"2": table_2, "7": table_7}
    return {f"table{key}": table for key, table in tables.items() if request.table in (key, "all")}
