"""The files of ``generated/flops``: tables as Markdown and JSON, charts as SVG, and one page that holds them all."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from functools import partial

from codegen.emit.environment import render
from codegen.parallel import parallel
from codegen.report.charts import bar_chart
from codegen.report.sheets import (
    Document,
    Sheet,
    by_kind,
    emitted,
    glance,
    left_out,
    per_step,
    printed_and_rules,
    printed_and_rules_2,
    switches,
)
from codegen.report.tables import markdown

_DERIVATIVES = ("phi_q", "phi_q_t_lambda_q")


def flop_files(documents: Mapping[str, Document], banner: str) -> dict[str, bytes]:
    """Write the comparison as files.

    Args:
        documents: ``table2`` and ``table7`` of :func:`codegen.comparison.tables`.
        banner: first line of every generated file.

    Returns:
        Path below the package's folder -> content.
    """
    table_2, table_7 = documents["table2"], documents["table7"]
    joints = list(dict.fromkeys(row["joint"] for row in table_7["rows"]))
    drawn = parallel(partial(bar_chart, table_7), joints, lambda _: None)
    charts = dict(zip(joints, drawn, strict=True))
    page = render(
        "report/flops.html.j2",
        banner=banner,
        sheets=[*sheets_2(table_2)[:1], *sheets_7(table_7)],
        charts=[(joint, svg[svg.index("<svg") :]) for joint, svg in charts.items()],
    )
    texts = {
        "flops/table2.json": _json(table_2),
        "flops/table7.json": _json(table_7),
        "flops/table2.md": _page("S1 Table 2", banner, sheets_2(table_2)),
        "flops/table7.md": _page("S1 Table 7", banner, sheets_7(table_7)),
        "flops/index.html": page,
        **{f"flops/{joint}.svg": svg for joint, svg in charts.items()},
    }
    return {path: text.encode() for path, text in texts.items()}


def sheets_2(document: Document) -> list[Sheet]:
    """All sheets of Table 2."""
    return [printed_and_rules_2(document), *(emitted(document, d) for d in _DERIVATIVES), by_kind(document)]


def sheets_7(document: Document) -> list[Sheet]:
    """All sheets of Table 7, the one to read first."""
    return [
        glance(document),
        printed_and_rules(document),
        *(emitted(document, derivative) for derivative in _DERIVATIVES),
        per_step(document),
        left_out(document),
        by_kind(document),
        switches(document["switches"]),
    ]


def _json(document: Document) -> str:
    return json.dumps(document, indent=1) + "\n"


def _page(title: str, banner: str, sheets: Sequence[Sheet]) -> str:
    return "\n".join([f"# {title}: operation counts\n", f"{banner}\n", *(markdown(sheet) for sheet in sheets)])
