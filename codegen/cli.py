"""The ``jointgen`` command.

Exit codes: 0 done; 1 the thing asked for fell short; 2 bad input, one line a mistake on stderr; never a traceback.
"""

from __future__ import annotations

import gc
import json
import sys
from pathlib import Path
from typing import Any

import click

import codegen
from codegen import cli_trade
from codegen.cli_chain import chain
from codegen.cli_flops import flops
from codegen.cli_platform import platform
from codegen.cli_scene import scene, simulate
from codegen.errors import JointgenError, Mistake, OutputError, SpecificationError
from codegen.progress import progress as _progress

_LIBRARY = Path("generated")


@click.group(context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(codegen.__version__, prog_name="jointgen")
def jointgen() -> None:
    """Generate specialised constraint routines for multibody mechanisms."""


@jointgen.command()
@click.option("--json", "as_json", is_flag=True, help="Print JSON.")
def joints(as_json: bool) -> None:
    """List the catalogue: joint, forms, degrees of freedom, rows, coordinates, operations of all quantities at once."""
    from codegen import comparison

    with _progress(comparison.catalogue_size(), "counting") as advance:
        rows = comparison.catalogue(advance)
    if as_json:
        click.echo(json.dumps(rows, indent=1))
        return
    from codegen.report import tables

    tables.show([tables.catalogue(rows)])


@jointgen.command()
@click.argument("joint", nargs=-1)
@click.option("--form", help="conventional or parametric; both if left out.")
@click.option("--rows", help="Rows of the parametric form: regular, table4, or quaternion (rot3 only).")
@click.option("--derivative", help="exact or substituted.")
@click.option("--variation", help="Axes of the virtual rotations: body or world.")
@click.option("--real", default="double", show_default=True, help="Number type: double or float.")
@click.option(
    "--outputs",
    help="Comma-separated: phi, phi_q, phi_q_t_lambda_q, gamma, phi_q_v, phi_q_t_lambda, all; "
    "also branch, orthonormalise, check_orthonormal.",
)
@click.option("--batch", help="Besides, routines for groups of so many joints: 2, 4, 8 or 16.")
@click.option("--geometry", default="runtime", show_default=True, help="runtime, or prepared once for all steps.")
@click.option("--matrices", default="orthonormal", show_default=True, help="orthonormal, or raw: phi from A as it is.")
@click.option("--fma", is_flag=True, help="Fused multiply-adds, written out as fma(); see the README for flags.")
@click.option("-o", "--output", "target", type=click.Path(path_type=Path), default=_LIBRARY, show_default=True)
@click.option(
    "--check",
    is_flag=True,
    help="Write nothing; exit 1 if the output directory is not what would be written.",
)
@click.option("--dump", help="Print a stage of every routine instead of writing: model or program.")
def generate(joint: tuple[str, ...], target: Path, check: bool, dump: str | None, **options: Any) -> None:
    """Emit routines for JOINT... (names of the catalogue, or trnK_rotN); without arguments the whole library."""
    from codegen import build, output

    request = _request(joint, options)
    if dump is not None:
        _dump(request, dump)
        return
    if not check:
        output.check_target(target)
    with _progress(len(build.variants(request)), "generating") as advance:
        if request == build.LIBRARY:
            files, counted = build.generate_library(advance)
        else:
            files = build.generate(request, advance)
    if request == build.LIBRARY:
        files |= _flop_files(counted)
    if check:
        _report_differences(target, output.differences(target, files))
        return
    lost = output.functions_lost(target, files)
    if lost and request != build.LIBRARY:
        what = f"holds {lost} other functions, which this request would remove"
        raise OutputError([Mistake(str(target), what, "name another directory with -o, or generate the whole library")])
    output.replace(target, files)
    functions = len(json.loads(files[output.MANIFEST])["functions"])
    click.echo(f"{target}: {functions} functions in {len(files)} files")


def _flop_files(counted: Any) -> dict[str, bytes]:
    from codegen import comparison
    from codegen.emit.package import banner
    from codegen.report.flop_files import flop_files

    with _progress(len(comparison.counted_variants()) - len(counted), "counting") as advance:
        return flop_files(comparison.tables(advance, known=counted), banner(codegen.__version__))


def _request(joint: tuple[str, ...], options: dict[str, Any]) -> Any:
    from codegen.spec.request import Options

    chosen = {name: value for name, value in options.items() if value is not None}
    outputs = tuple(name.strip() for name in chosen.pop("outputs", "").split(",") if name.strip())
    return Options(joint, outputs=outputs, batch=_batch(chosen.pop("batch", None)), **chosen)


def _batch(text: str | None) -> int | None:
    from codegen.spec.request import BATCHES

    try:
        return None if text is None else int(text)
    except ValueError:
        remedy = f"give one of {', '.join(map(str, BATCHES))}"
        raise SpecificationError([Mistake("--batch", f'"{text}" is not a whole number', remedy)]) from None


def _dump(request: Any, stage: str) -> None:
    from codegen import build

    for text in build.dump(request, stage):
        click.echo(text)


def _report_differences(target: Path, differences: list[str]) -> None:
    for difference in differences:
        click.echo(f"{target}/{difference}", err=True)
    if differences:
        click.echo(f"{target} is not current: run jointgen generate", err=True)
        raise click.exceptions.Exit(1)
    click.echo(f"{target} is current")


@jointgen.command()
@click.argument("folder", nargs=-1, type=click.Path(path_type=Path))
@click.option("-o", "--output", "target", type=click.Path(path_type=Path, dir_okay=False), required=True)
def report(folder: tuple[Path, ...], target: Path) -> None:
    """Put results on one page that needs no other file: those in FOLDER..., or in generated/ and benchmarks/."""
    from codegen import output
    from codegen.report.findings import findings
    from codegen.report.page import page

    found = findings(folder or [place for place in (_LIBRARY, Path("benchmarks")) if place.is_dir()])
    output.replace_file(target, page(found, codegen.__version__).encode())
    click.echo(f"{target}: {len(found)} folders of results")


for _command in (flops, scene, simulate, chain, platform, *cli_trade.COMMANDS):
    jointgen.add_command(_command)


def main() -> None:
    """Run the command line and leave with its exit code."""
    gc.set_threshold(100_000, 50, 100)  # symbolic work makes many objects and few cycles: a tenth of its time
    sys.exit(_run(sys.argv[1:]))


def _run(arguments: list[str]) -> int:
    try:
        return int(jointgen.main(arguments, prog_name="jointgen", standalone_mode=False) or 0)
    except JointgenError as error:
        for mistake in error.mistakes:
            click.echo(str(mistake), err=True)
        return 2
    except click.exceptions.NoArgsIsHelpError as error:
        error.show()
        return 2
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "jointgen"
        message = error.format_message().rstrip(".").replace("\n", " ")
        click.echo(f"{command}: {message}; see {command} --help", err=True)
        return 2
    except (click.Abort, KeyboardInterrupt):
        click.echo("jointgen: interrupted; nothing was written", err=True)
        return 1
