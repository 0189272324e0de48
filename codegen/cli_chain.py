"""The commands of chains: their routines, their runs, and scenes as chains."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from codegen.errors import Mistake, SpecificationError
from codegen.progress import progress


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--kinematics", is_flag=True, help="Motion from that of the independent coordinates.")
@click.option("--inverse", is_flag=True, help="Besides, efforts and reactions.")
@click.option("--forward", is_flag=True, help="Motion under forces.")
@click.option("--tol", "tolerance", type=float, default=1e-8, show_default=True, help="Tolerance of the integrator.")
@click.option("--duration", type=float, default=1.0, show_default=True, help="Time to run, s.")
@click.option("--outputs", type=int, default=200, show_default=True, help="Output times after the start.")
@click.option("--animation", is_flag=True, help="Write animation.html, a page that plays the run.")
@click.option("--real", default="double", show_default=True, help="Number type of the routines: double or float.")
@click.option("-o", "--output", "target", type=click.Path(path_type=Path), required=True)
def chain(file: Path, real: str, animation: bool, target: Path, **options: Any) -> None:
    """Emit the routines of a kinematic chain, or run it: trajectory.csv, summary.json, plot.svg, animation.html."""
    modes = [mode for mode in ("kinematics", "inverse", "forward") if options.pop(mode)]
    if len(modes) > 1:
        raise SpecificationError([Mistake(f"--{modes[1]}", f"is given beside --{modes[0]}", "ask for one run")])
    if not modes:
        _generate_chain(file, real, target)
    else:
        _run_chain(file, target, animation, {"mode": modes[0], **options})


def generate_relative(file: Path, read: Any, real: str, target: Path, given: dict[str, bool]) -> None:
    """The routines of a scene, read from a file, by relative coordinates."""
    from codegen.chains.relative import relative

    mistakes = [
        Mistake(name, "is not there in relative coordinates", "leave it out") for name, on in given.items() if on
    ]
    if mistakes:
        raise SpecificationError(mistakes)
    with in_file(file):
        found = relative(read)
    for line in found.notes:
        click.echo(line, err=True)
    _write_chain(file, found.chain, real, target)


def _generate_chain(file: Path, real: str, target: Path) -> None:
    from codegen import output
    from codegen.chains.read import read

    output.check_target(target)
    described, _ = read(file)
    _write_chain(file, described, real, target)


def _write_chain(file: Path, described: Any, real: str, target: Path) -> None:
    """Generate; what is imported here takes seconds, and mistakes of a file have been told."""
    from codegen import output
    from codegen.chains.generate import generate_chain, steps
    from codegen.chains.stand import check_start
    from codegen.scenes.generate import check_options

    check_options(None, real)
    with in_file(file):
        check_start(described)
    with progress(steps(described), "generating") as advance:
        files = generate_chain(described, real, advance)
    output.replace(target, files)
    functions = len(json.loads(files[output.MANIFEST])["functions"])
    click.echo(f"{target}: {functions} functions in {len(files)} files")


def _run_chain(file: Path, target: Path, animation: bool, options: dict[str, Any]) -> None:
    from codegen import output
    from codegen.chains.read import read

    output.check_target(target)
    _run(file, *read(file), target, animation, options)


def _run(file: Path, read_chain: Any, tables: Any, target: Path, animation: bool, options: dict[str, Any]) -> None:
    """Run; what is imported here takes seconds, and mistakes of a file have been told."""
    from codegen import output
    from codegen.chains.simulate import Settings, check, simulated
    from codegen.measure.compile import compiler
    from codegen.report.chain_pictures import chain_pictures

    settings = Settings(**options)
    with in_file(file):
        check(read_chain, settings)
    compiler()
    with progress(settings.outputs, "running") as advance, in_file(file):
        result = simulated(read_chain, tables, settings, lambda t: advance(f"{t:.3g} s"))
    output.replace(target, {**result.files, **chain_pictures(result.mechanism, result.record, animation)})
    told(file, target, result)


def simulate_chain(file: Path, target: Path, animation: bool, copies: int | None, options: dict[str, Any]) -> None:
    """Forward dynamics of a chain; what only scenes have is refused."""
    given = {"--form": options.pop("form"), "--copies": copies, **_of_bodies(options)}
    mistakes = [Mistake(name, "is for scenes, and this is a chain", "leave it out") for name, on in given.items() if on]
    if mistakes:
        raise SpecificationError(mistakes)
    _run_chain(file, target, animation, {"mode": "forward", **options})


def _of_bodies(options: dict[str, Any]) -> dict[str, Any]:
    """Take out the options that only equations of bodies have, with what was given for them."""
    found = {f"--{name.replace('_', '-')}": options.pop(name) for name in ("derivative", "through_singular")}
    return {**found, "--index": options.pop("index") != 2}


def simulate_relative(file: Path, read: Any, target: Path, animation: bool, options: dict[str, Any]) -> None:
    """A scene, read from a file, by relative coordinates."""
    from codegen import output
    from codegen.chains.simulate import Settings
    from codegen.chains.simulate_scene import simulated_relative
    from codegen.measure.compile import compiler
    from codegen.report.run_pictures import run_pictures

    del options["form"]
    what = "is not there in relative coordinates"
    mistakes = [Mistake(name, what, "leave it out") for name, on in _of_bodies(options).items() if on]
    if mistakes:
        raise SpecificationError(mistakes)
    settings = Settings("forward", **options)
    compiler()
    with progress(settings.outputs, "simulating", "deriving and compiling") as advance, in_file(file):
        result = simulated_relative(read, settings, lambda t: advance(f"{t:.3g} s"))
    output.replace(target, {**result.files, **run_pictures(read, result.trajectory, animation)})
    told(file, target, result)


def read_told(file: Path, copies: int | None) -> Any:
    """Read a scene; tell what its file has that is not modelled."""
    from codegen import scenes

    read, left_out = scenes.read(file, copies)
    for line in left_out:
        click.echo(line, err=True)
    return read


@contextmanager
def in_file(file: Path) -> Iterator[None]:
    """Say of mistakes that show only when a mechanism is put together which file has them."""
    try:
        yield
    except SpecificationError as error:
        told_of = (
            mistake if mistake.place.startswith("--") else replace(mistake, place=f"{file}: {mistake.place}")
            for mistake in error.mistakes
        )
        raise SpecificationError(told_of) from error


def told(file: Path, target: Path, result: Any) -> None:
    """Tell a run; it fell short where it stopped before its end."""
    click.echo(f"{target}: {result.words}")
    for line in result.notes:
        click.echo(f"{file}: {line}", err=True)
    if result.failure:
        click.echo(f"{file}: {result.failure}", err=True)
        raise click.exceptions.Exit(1)
