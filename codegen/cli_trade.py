"""The commands of the measured trade between speed and accuracy."""

from __future__ import annotations

import json
import shlex
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
    """Measure errors and times of the routines of JOINT..., in many builds; without arguments all, in two.

    A scene FILE in the place of joints: the routines of that mechanism.
    """
    from codegen import output
    from codegen.report.accuracy_files import accuracy_files, accuracy_sheets
    from codegen.trade.accuracy import document, measured

    request = _request(joint, "", options)
    cases = request.cases()
    if folder is not None:
        output.check_target(folder)
    with progress(len(cases), "measuring") as advance:
        result = document(request, measured(request, advance))
    if folder is not None:
        output.replace(folder, accuracy_files(result))
        click.echo(f"{folder}: {len(result['candidates'])} routines measured")
    elif as_json:
        click.echo(json.dumps(result, indent=1))
    else:
        from codegen.report import tables

        tables.show(accuracy_sheets(result))


@click.command()
@click.argument("target")
@click.option("--max-error", "largest", type=float, required=True, help="Largest error over the scale of a block.")
@click.option("--domain", "bounds", default="", help='Bounds of the inputs, such as "r=1 s=0.2 angle=3.2".')
@click.option("--form", help="conventional or parametric; the cheaper one if left out.")
@click.option("--rows", help="Rows of the parametric form: regular, table4, or quaternion (rot3 only).")
@click.option("--derivative", help="exact or substituted.")
@click.option("--output", default="all", show_default=True, help="Which routine: a quantity, a product, or all.")
@click.option("-o", "folder", type=click.Path(path_type=Path), help="Write the package of the chosen routine.")
@click.option("--worst", is_flag=True, help="Print the inputs of the worst pose instead, as hexadecimal numbers.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def budget(
    target: str, largest: float, bounds: str, folder: Path | None, worst: bool, as_json: bool, **options: Any
) -> None:
    """Find the cheapest routine of a joint, or of a scene FILE, with errors within a budget."""
    from codegen import output
    from codegen.report.budget_text import budget_lines
    from codegen.trade.budget import answered, check_error, document, worst_inputs

    request = _request((target,), bounds, options)
    check_error(largest, [request])
    if folder is not None:
        output.check_target(folder)
    with progress(1000, "judging") as advance:
        answer = answered(request, largest, advance)
    found = document(request, largest, answer)
    if folder is not None and answer.verdict != "IMPOSSIBLE":
        _write_package(folder, request, answer.chosen)
    if worst:
        click.echo(json.dumps({"inputs": worst_inputs(request, answer.chosen)}, indent=1))
    elif as_json:
        click.echo(json.dumps(found, indent=1))
    else:
        for line in budget_lines(found, _again(target, largest, bounds, options)):
            click.echo(line)
    if answer.verdict == "IMPOSSIBLE":
        raise click.exceptions.Exit(1)


def _write_package(folder: Path, request: Any, chosen: Any) -> None:
    """Write the routine that was chosen."""
    from codegen import output
    from codegen.errors import Mistake, SpecificationError
    from codegen.trade.chosen import chosen_files, chosen_real

    real = chosen_real(request, chosen)
    if real not in ("double", "float"):
        what = f"{chosen.routine} is in {real}, which is measured and not emitted"
        raise SpecificationError([Mistake("--max-error", what, "allow a larger error")])
    output.replace(folder, chosen_files(request, chosen))
    click.echo(f"{folder}: {chosen.routine}", err=True)


def _request(targets: tuple[str, ...], bounds: str, options: dict[str, Any]) -> Any:
    """A request for joints, or for the scene of a file."""
    from codegen.trade.domain_text import read_domain
    from codegen.trade.requests import AccuracyRequest

    if not any(Path(target).suffix in (".toml", ".urdf", ".xml") for target in targets):
        return AccuracyRequest(targets, domain=read_domain(bounds), **options)
    return _scene_request(targets, bounds, options)


def _scene_request(targets: tuple[str, ...], bounds: str, options: dict[str, Any]) -> Any:
    from codegen import scenes
    from codegen.errors import Mistake, SpecificationError
    from codegen.trade.domain_text import read_domain
    from codegen.trade.requests import SceneRequest
    from codegen.trade.scene_domain import scene_domain

    mistakes = [
        Mistake(f"--{name}", "is of joints; a scene has its rows and derivative in its file", "leave it out")
        for name in ("rows", "derivative")
        if options.get(name) is not None
    ]
    if len(targets) > 1:
        mistakes.append(Mistake(" ".join(targets), "are several, and a scene is measured alone", "give one file"))
    if mistakes:
        raise SpecificationError(mistakes)
    scene, _ = scenes.read(Path(targets[0]), None)
    kept = {name: value for name, value in options.items() if name not in ("rows", "derivative")}
    return SceneRequest(scene, domain=read_domain(bounds, scene_domain(scene)), **kept)


def _again(target: str, largest: float, bounds: str, options: dict[str, Any]) -> str:
    """The command that asked."""
    words = ["jointgen", "budget", target, "--max-error", f"{largest:g}"]
    words += ["--domain", bounds] if bounds else []
    for name, value in options.items():
        words += [f"--{name}", value] if value is not None and (name, value) != ("output", "all") else []
    return shlex.join(words)


@click.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
@click.option("-o", "folder", type=click.Path(path_type=Path), help="Write extremes.json and extremes.md.")
def extremes(as_json: bool, folder: Path | None) -> None:
    """Tables of digits at extremes: far away, after many turns, near singular poses, huge and tiny numbers, NaN."""
    from codegen import output
    from codegen.report.extreme_sheets import extreme_files, extreme_sheets
    from codegen.trade.extreme_table import as_data
    from codegen.trade.extremes import TABLES, extreme_tables

    if folder is not None:
        output.check_target(folder)
    with progress(len(TABLES), "measuring") as advance:
        result = as_data(extreme_tables(advance))
    if folder is not None:
        output.replace(folder, extreme_files(result))
        click.echo(f"{folder}: {len(result)} tables")
    elif as_json:
        click.echo(json.dumps(result, indent=1))
    else:
        from codegen.report import tables

        tables.show(extreme_sheets(result))


COMMANDS = (accuracy, budget, extremes)
