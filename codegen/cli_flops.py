"""The command of operation counts: the paper's tables, or a mechanism by absolute and by relative coordinates."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from codegen.errors import Mistake, SpecificationError
from codegen.progress import progress


@click.command()
@click.argument("file", required=False, type=click.Path(path_type=Path))
@click.option("--rules", help="Whose counts: program (as emitted) or paper.  [default: program]")
@click.option("--table", help="The paper's table: 2, 7 or all.  [default: 7]")
@click.option("--model", help="Prices: paper, multiply, fma or measured.  [default: paper]")
@click.option("--explain", help="Derive the counts of a joint or basic constraint term by term (--rules paper).")
@click.option("--assume", multiple=True, help="Set a switch of the paper's rules; may be repeated.")
@click.option("--measure", is_flag=True, help="Of a FILE: time the evaluations on this machine.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def flops(file: Path | None, measure: bool, as_json: bool, **options: Any) -> None:
    """Compare the paper's Tables 2 and 7 with its own rules and with the operations of the emitted routines.

    With a scene FILE: compare its conventional, parametric and relative forms.
    """
    result = _of_tables(measure, options) if file is None else _of_scene(file, measure, options)
    if as_json:
        click.echo(json.dumps(result.data, indent=1))
        return
    for line in result.lines:
        click.echo(line)
    if result.sheets:
        from codegen.report import tables

        tables.show(result.sheets)


def _of_tables(measure: bool, options: dict[str, Any]) -> Any:
    from codegen.report import flop_commands

    if measure:
        remedy = "name one, or take --model measured"
        raise SpecificationError([Mistake("--measure", "times the forms of a scene file", remedy)])
    defaults = {"rules": "program", "table": "7", "model": "paper"}
    given = {name: value for name, value in options.items() if value is not None}
    request = flop_commands.FlopRequest(**({**defaults, "explain": None} | given))
    flop_commands.check(request)
    with progress(flop_commands.steps(request), "counting") as advance:
        return flop_commands.result(request, advance)


def _of_scene(file: Path, measure: bool, options: dict[str, Any]) -> Any:
    from codegen.chains.beside import ABSOLUTE, forms_beside
    from codegen.cli_chain import read_told
    from codegen.measure.compile import compiler
    from codegen.report.form_sheets import form_result

    what = "is for the paper's tables, not for a scene file"
    mistakes = [Mistake(f"--{name}", what, "leave it out") for name, value in options.items() if value]
    if mistakes:
        raise SpecificationError(mistakes)
    read = read_told(file, None)
    if measure:
        compiler()
    with progress(len(ABSOLUTE) + 1, "deriving") as advance:
        costs = forms_beside(read, advance)
    return form_result(read.name, costs, measure)
