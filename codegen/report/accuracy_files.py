"""What the measured accuracy is written as: data, tables and the Pareto front of each joint."""

from __future__ import annotations

import json

from codegen.report.accuracy_sheets import accuracy_sheet, summary_sheet
from codegen.report.pareto import pareto
from codegen.report.sheets import Document, Sheet
from codegen.report.tables import markdown
from codegen.simulate.limits import run_manifest


def accuracy_sheets(document: Document) -> list[Sheet]:
    """A table for each joint; of the library, one table of all."""
    joints = list(document["advice"]["fronts"])
    if len(joints) > 3:
        return [summary_sheet(document)]
    return [accuracy_sheet(document, joint) for joint in joints]


def accuracy_files(document: Document) -> dict[str, bytes]:
    """Path -> content."""
    joints = list(document["advice"]["fronts"])
    texts = {"manifest.json": run_manifest("accuracy", document["output"])}
    texts["accuracy.json"] = json.dumps(document, indent=1) + "\n"
    sheets = [accuracy_sheet(document, joint) for joint in joints]
    texts["accuracy.md"] = "# Accuracy\n\n" + "\n".join(markdown(sheet) for sheet in [summary_sheet(document), *sheets])
    texts |= {f"pareto_{joint}.svg": pareto(document, joint) for joint in joints}
    return {path: text.encode() for path, text in texts.items()}
