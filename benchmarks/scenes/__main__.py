"""``python -m benchmarks.scenes``: measure scenes of many slider-cranks, write the results beside this file."""

from __future__ import annotations

import tempfile
from pathlib import Path

import click

from benchmarks.scenes import report
from benchmarks.scenes.measure import HERE, measured
from benchmarks.scenes.sets import SHAPES, emitted, engine, sets

SETS = (1, 2, 3, 5, 10, 20, 100, 1000)


@click.command()
@click.option("--rounds", default=15, show_default=True, help="Interleaved rounds.")
@click.option("--sets", "numbers", multiple=True, type=int, help="Only so many; the other results stay.")
@click.option("--straight", "most", default=100, show_default=True, help="Most sets that are written out.")
@click.option("-o", "target", type=click.Path(path_type=Path, file_okay=False), default=HERE, help="Where to.")
def main(rounds: int, numbers: tuple[int, ...], most: int, target: Path) -> None:
    """Compare straight-line code, loops and the library's routines."""
    one = engine()
    emitted(sets(one, 2), "loops")  # so that what is searched once is not in the first time
    found = report.read(target) if numbers else []
    for number in numbers or SETS:
        click.echo(f"{number} sets", err=True)
        scene = sets(one, number)
        shapes = [emitted(scene, shape) for shape in SHAPES if shape == "loops" or number <= most]
        with tempfile.TemporaryDirectory() as name:
            new = measured(one, number, shapes, rounds, Path(name))
        found = sorted([*(old for old in found if old.sets != number), *new], key=lambda one: one.sets)
        target.mkdir(parents=True, exist_ok=True)
        report.write(target, found)
    click.echo(f"{target / 'results.md'}, results.json and results.svg")


if __name__ == "__main__":
    main()
