"""The commands of the measured trade between speed and accuracy."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from codegen.progress import progress


@click.command()
@click.argument("joint", nargs=-1)
@click.option("--form", help="conventional or parametric; both if left out.")
@click.option("--rows", help="Rows of the parametric form: regular, table4, or quaternion (rot3 only).")
@click.option("--derivative", help="exact or substituted.")
@click.option("--output", default="all", show_default=True, help="Which routine: a quantity, a product, or all.")
@click.option("--samples", type=int, default=4096, show_default=True, help="Poses in each of the two states.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("-o", "folder", type=click.Path(path_type=Path), help="Write accuracy.json, tables and Pareto fronts.")
def accuracy(joint: tuple[str, ...], as_json: bool, folder: Path | None, **options: Any) -> None:
    """Measure errors and times of the routines of JOINT..., in many builds; without arguments all, in two."""
    from codegen import output
    from codegen.report.accuracy_files import accuracy_files, accuracy_sheets
    from codegen.trade.accuracy import AccuracyRequest, document, measured

    request = AccuracyRequest(joint, **options)
    variants = request.variants()
    if folder is not None:
        output.check_target(folder)
    with progress(len(variants), "measuring") as advance:
        result = document(request, measured(request, advance))
    if folder is not None:
        output.replace(folder, accuracy_files(result))
        click.echo(f"{folder}: {len(result['candidates'])} routines measured")
    elif as_json:
        click.echo(json.dumps(result, indent=1))
    else:
        from codegen.report import tables

        tables.show(accuracy_sheets(result))


COMMANDS = (accuracy,)
