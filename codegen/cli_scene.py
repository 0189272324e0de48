"""The commands of scenes: the routines of a mechanism, and its runs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from codegen.cli_chain import generate_relative, in_file, read_told, simulate_chain, simulate_relative, told
from codegen.progress import progress


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--form", help="Of all joints that may have it: auto, conventional or parametric; or relative: as a chain."
)
@click.option("--copies", type=int, help="Repeat the mechanism so often, as copies in the file does.")
@click.option("--real", default="double", show_default=True, help="Number type: double or float.")
@click.option("--loops", default="auto", show_default=True, help="Equal parts run in loops: auto or never.")
@click.option("-o", "--output", "target", type=click.Path(path_type=Path), required=True)
@click.option("--measure", is_flag=True, help="Say in the README what each simplification saves on this machine.")
def scene(file: Path, form: str | None, copies: int | None, real: str, loops: str, target: Path, measure: bool) -> None:
    """Emit the routines of one mechanism: a scene file (TOML), a URDF or an MJCF."""
    from codegen import output
    from codegen.measure.compile import compiler
    from codegen.scenes.forms import is_relative
    from codegen.scenes.generate import check_options, generate_scene, steps

    check_options(form, real, loops)
    output.check_target(target)
    read = read_told(file, copies)
    with in_file(file):
        as_chain = is_relative(read, form)
    if as_chain:
        generate_relative(file, read, real, target, {"--loops": loops != "auto", "--measure": measure})
        return
    if measure:
        compiler()
    with progress(steps(read), "generating") as advance, in_file(file):
        files = generate_scene(read, form, real, advance, measure, loops)
    output.replace(target, files)
    functions = len(json.loads(files[output.MANIFEST])["functions"])
    click.echo(f"{target}: {functions} functions in {len(files)} files")


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--form", help="Of all joints that may have it: auto, conventional or parametric; or relative.")
@click.option("--derivative", help="Of parametric joints: exact or substituted; as the file says if left out.")
@click.option("--tol", "tolerance", type=float, default=1e-8, show_default=True, help="Tolerance of the error test.")
@click.option("--duration", type=float, default=1.0, show_default=True, help="Time to simulate, s.")
@click.option("--outputs", type=int, default=200, show_default=True, help="Output times after the start.")
@click.option("--index", type=int, default=2, show_default=True, help="2: stabilised index 2; 1: Baumgarte.")
@click.option("--copies", type=int, help="Repeat the mechanism so often, as copies in the file does.")
@click.option("--animation", is_flag=True, help="Write animation.html, a page that plays the run.")
@click.option("--through-singular", is_flag=True, help="Go on through singular configurations, on the smooth branch.")
@click.option("-o", "--output", "target", type=click.Path(path_type=Path), required=True)
def simulate(file: Path, copies: int | None, animation: bool, target: Path, **options: Any) -> None:
    """Integrate a mechanism, or a chain: trajectory.csv, summary.json, plot.svg and, if asked for, animation.html."""
    from codegen import output
    from codegen.chains.read import is_chain
    from codegen.report.run_pictures import run_pictures
    from codegen.scenes.forms import is_relative
    from codegen.scenes.run import Settings
    from codegen.scenes.simulate import check_settings, check_tools, simulated

    if is_chain(file):
        simulate_chain(file, target, animation, copies, options)
        return
    settings = Settings(**options)
    check_settings(settings)
    output.check_target(target)
    read = read_told(file, copies)
    with in_file(file):
        as_chain = is_relative(read, settings.form)
    if as_chain:
        simulate_relative(file, read, target, animation, options)
        return
    check_tools()
    with progress(settings.outputs, "simulating", "deriving and compiling") as advance, in_file(file):
        result = simulated(read, settings, lambda t: advance(f"{t:.3g} s"))
    output.replace(target, {**result.files, **run_pictures(read, result.trajectory, animation)})
    told(file, target, result)
