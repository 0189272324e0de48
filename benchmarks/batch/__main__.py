"""``python -m benchmarks.batch``: time the batch routines, write results.md and results.json beside this file."""

from __future__ import annotations

from pathlib import Path

import click

from benchmarks.batch import report
from benchmarks.batch.timing import COUNTS, HERE, JOINTS, LANES, timings


@click.command()
@click.option("--rounds", default=31, show_default=True, help="Interleaved rounds; fewer for very many joints.")
@click.option("--joint", multiple=True, type=click.Choice(JOINTS), help="Only this one; may be repeated.")
@click.option("--count", multiple=True, type=int, help="Joints in a call; may be repeated.")
@click.option("-o", "target", type=click.Path(path_type=Path, file_okay=False), default=HERE, help="Where to.")
def main(rounds: int, joint: tuple[str, ...], count: tuple[int, ...], target: Path) -> None:
    """Time batch routines against the scalar loop and against the memory."""
    found = [
        timing
        for real in LANES
        for timing in timings(real, rounds, joint or JOINTS, count or COUNTS, lambda name: click.echo(name, err=True))
    ]
    target.mkdir(parents=True, exist_ok=True)
    report.write(target, found)
    click.echo(f"{target / 'results.md'} and {target / 'results.json'}: {len(found)} timings")


if __name__ == "__main__":
    main()
