"""Measure what docs/accuracy.md shows: figures into docs/figures, tables beside this file.

Errors and extremes are the same in every run; times are those of this machine. Run by ``make figures-accuracy``.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

from codegen.report.accuracy_sheets import accuracy_sheet
from codegen.report.extreme_sheets import extreme_sheets
from codegen.report.newton_figure import newton_figure
from codegen.report.pareto import pareto
from codegen.report.tables import markdown
from codegen.trade.accuracy import document, measured
from codegen.trade.extreme_table import as_data
from codegen.trade.extremes import extreme_tables
from codegen.trade.newton import PAIRINGS, residuals
from codegen.trade.requests import SAMPLES, AccuracyRequest

HERE = Path(__file__).resolve().parent
FIGURES = HERE.parents[1] / "docs" / "figures"


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.accuracy")
    parser.add_argument("--joint", default="revolute", help="joint of the Pareto front")
    parser.add_argument("--samples", type=int, default=SAMPLES, help="poses in each state")
    words = parser.parse_args()
    FIGURES.mkdir(parents=True, exist_ok=True)
    request = AccuracyRequest((words.joint,), samples=words.samples)
    trade = document(request, measured(request, print))
    extremes = as_data(extreme_tables(print))
    (FIGURES / "pareto.svg").write_text(pareto(trade, words.joint))
    (FIGURES / "newton.svg").write_text(newton_figure({pairing.name: residuals(pairing) for pairing in PAIRINGS}))
    (HERE / "results.json").write_text(json.dumps({"trade": trade, "extremes": extremes}, indent=1) + "\n")
    sheets = [accuracy_sheet(trade, words.joint), *extreme_sheets(extremes)]
    head = f"# Accuracy, speed and extremes\n\nWritten by `make figures-accuracy`; {trade['advice']['compiler']}.\n\n"
    (HERE / "results.md").write_text(head + "\n".join(markdown(sheet) for sheet in sheets))


if __name__ == "__main__":
    main()
