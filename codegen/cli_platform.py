"""The command of platforms: their routines, and the indices at many poses."""

from __future__ import annotations

import json
from pathlib import Path

import click

from codegen.progress import progress


@click.command()
@click.argument("file", type=click.Path(path_type=Path))
@click.option("--variant", help="robust, balanced, fast, values, smooth or literal; as the file says if left out.")
@click.option("--real", default="double", show_default=True, help="Number type: double or float.")
@click.option("--fma", is_flag=True, help="Fused multiply-adds, written out as fma(): compile with -mfma.")
@click.option("--poses", type=click.Path(path_type=Path), help="Evaluate at the poses of a CSV or npy file.")
@click.option("--grid", help="Evaluate on a grid: x=-0.3:0.3:61,yaw=-20deg:20deg:41 (x y z in m, roll pitch yaw).")
@click.option("--format", "kind", default="csv", show_default=True, help="Of the results: csv or npz.")
@click.option("--dask", "cluster", help="Address of a Dask scheduler that evaluates the poses (extra dask).")
@click.option("-o", "--output", "target", type=click.Path(path_type=Path), required=True)
def platform(
    file: Path,
    variant: str | None,
    real: str,
    fma: bool,
    poses: Path | None,
    grid: str | None,
    kind: str,
    cluster: str | None,
    target: Path,
) -> None:
    """Emit velocity indices of a six-legged platform (a TOML file); evaluate them at many poses."""
    from codegen import output
    from codegen.platforms.generate import generate_platform, steps, with_options
    from codegen.platforms.run import chosen_poses, evaluated
    from codegen.report.platform_report import platform_report
    from codegen.scenes.read import text_of
    from codegen.spec.platform_file import read_platform

    output.check_target(target)
    read = with_options(read_platform(text_of(file), str(file)), variant, real, fma)
    where = chosen_poses(read, poses, grid, kind)
    with progress(steps(read), "generating") as advance:
        package = generate_platform(read, real, advance)
    files: dict[str, output.Content] = {**package}
    if where is not None:
        with progress(where.pieces, "evaluating") as advance:
            table = evaluated(where, advance, cluster, output.room(target))
        files |= {**table.files, **platform_report(read, table)}
    output.replace(target, files)
    functions = len(json.loads(package[output.MANIFEST])["functions"])
    click.echo(f"{target}: {functions} functions in {len(files)} files")
    if where is not None:
        click.echo(table.words)
