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


@click.command()
@click.argument("target")
@click.option("--max-error", "largest", type=float, required=True, help="Largest error over the scale of a block.")
@click.option("--domain", "bounds", default="", help='Bounds of the inputs, such as "r=1 s=0.2 angle=3.2".')
@click.option("--form", help="conventional or parametric; the cheaper one if left out.")
@click.option("--rows", help="Rows of the parametric form: regular, table4, or quaternion (rot3 only).")
@click.option("--derivative", help="exact or substituted.")
@click.option("--output", default="all", show_default=True, help="Which routine: a quantity, a product, or all.")
@click.option(
    "-o", "folder", type=click.Path(path_type=Path), help="Write the package of the chosen routine of a joint."
)
@click.option("--worst", is_flag=True, help="Print the inputs of the worst pose instead, as hexadecimal numbers.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def budget(
    target: str, largest: float, bounds: str, folder: Path | None, worst: bool, as_json: bool, **options: Any
) -> None:
    """Find the cheapest routine of a joint, or of each joint of a scene FILE, with errors within a budget."""
    from codegen.report.budget_text import budget_lines
    from codegen.trade.budget import answered, check_error, document, worst_inputs

    requests = _budget_requests(target, bounds, options)
    check_error(largest, requests)
    if folder is not None:
        _check_package(folder, target, requests)
    found = []
    for request in requests:
        with progress(1000, "judging") as advance:
            answer = answered(request, largest, advance)
        found.append(document(request, largest, answer))
        if folder is not None and answer.verdict != "IMPOSSIBLE":
            _write_package(folder, request, answer.chosen)
        if worst:
            click.echo(json.dumps({"inputs": worst_inputs(request, answer.chosen)}, indent=1))
        elif not as_json:
            for line in budget_lines(found[-1], _again(target, largest, bounds, options)):
                click.echo(line)
    if as_json:
        click.echo(json.dumps(found if len(found) > 1 else found[0], indent=1))
    if any(one["verdict"] == "IMPOSSIBLE" for one in found):
        raise click.exceptions.Exit(1)


def _check_package(folder: Path, target: str, requests: list[Any]) -> None:
    """Refuse what cannot be written, before any work is done."""
    from codegen import output
    from codegen.errors import Mistake, SpecificationError

    if Path(target).suffix:
        what = f"is for one joint, and {target} has {len(requests)} types"
        raise SpecificationError([Mistake("-o", what, "leave it out, or give a joint; jointgen scene emits a scene")])
    output.check_target(folder)


def _write_package(folder: Path, request: Any, chosen: Any) -> None:
    """Write the routine that was chosen."""
    from codegen import build, output
    from codegen.errors import Mistake, SpecificationError
    from codegen.trade.budget import package_options

    options = package_options(request, chosen)
    if options.real not in ("double", "float"):
        what = f"{chosen.routine} is in {options.real}, which is measured and not emitted"
        raise SpecificationError([Mistake("--max-error", what, "allow a larger error")])
    output.replace(folder, build.generate(options))
    click.echo(f"{folder}: {chosen.routine}", err=True)


def _budget_requests(target: str, bounds: str, options: dict[str, Any]) -> list[Any]:
    """A request for the joint, or one for each type of joint in a scene file."""
    from codegen.trade.accuracy import AccuracyRequest
    from codegen.trade.domain_text import read_domain

    if Path(target).suffix not in (".toml", ".urdf", ".xml"):
        return [AccuracyRequest((target,), domain=read_domain(bounds), **options)]
    from codegen import scenes
    from codegen.trade.scene_domain import scene_domain, scene_joints

    scene, _ = scenes.read(Path(target), None)
    domain = read_domain(bounds, scene_domain(scene))
    return [AccuracyRequest((joint,), domain=domain, **options) for joint in scene_joints(scene)]


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
