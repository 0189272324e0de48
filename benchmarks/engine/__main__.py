"""``python -m benchmarks.engine``: results.md, results.json and two charts."""

from __future__ import annotations

import json
from pathlib import Path

import click

from benchmarks.batch.report import setting
from benchmarks.engine import charts, compare, measure, report


@click.command()
@click.option("--rounds", default=5, show_default=True, help="Interleaved rounds of each timing.")
@click.option("--sets", "sizes", multiple=True, type=int, default=(1, 5, 20, 100), show_default=True, help="Engines.")
@click.option(
    "-o",
    "target",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path(__file__).parent,
    help="Where to.",
)
def main(rounds: int, sizes: tuple[int, ...], target: Path) -> None:
    """Measure the in-line engine in both formulations."""
    target.mkdir(parents=True, exist_ok=True)
    machine = setting()
    curves = measure.piston()
    precise = measure.work_precision(rounds)
    document = {
        "setting": f"{machine['compiler']}, {machine['processor']}",
        "piston": measure.differences(curves),
        "work_precision": precise,
        "without_terms": measure.without_terms(rounds),
        "by_size": measure.by_size(sizes, rounds),
        "others": compare.compared(sizes, rounds),
    }
    (target / "piston.svg").write_text(charts.piston_chart(curves))
    (target / "work_precision.svg").write_text(charts.work_precision_chart(precise))
    (target / "results.json").write_text(json.dumps(document, indent=1) + "\n")
    (target / "results.md").write_text(report.markdown(document))
    click.echo(f"{target / 'results.md'} and {target / 'results.json'}")


if __name__ == "__main__":
    main()
