"""``python -m benchmarks.forms``: results.md and results.json."""

from __future__ import annotations

import json
from pathlib import Path

import click

from benchmarks.batch.report import setting
from benchmarks.forms.measure import measured
from benchmarks.forms.report import markdown

SCENES = ("in_line_engine", "four_bar", "spatial_slider_crank", "bricard")


@click.command()
@click.option("--rounds", default=3, show_default=True, help="Interleaved rounds of the runs.")
@click.option("--scene", "scenes", multiple=True, default=SCENES, show_default=True, help="Examples.")
@click.option(
    "-o",
    "target",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path(__file__).parent,
    help="Where to.",
)
def main(rounds: int, scenes: tuple[str, ...], target: Path) -> None:
    """Measure scenes by conventional, parametric and relative coordinates."""
    machine = setting()
    found = []
    for name in scenes:
        click.echo(name, err=True)
        found.append(measured(name, rounds))
    document = {"setting": f"{machine['compiler']}, {machine['processor']}", "scenes": found}
    target.mkdir(parents=True, exist_ok=True)
    (target / "results.json").write_text(json.dumps(document, indent=1) + "\n")
    (target / "results.md").write_text(markdown(document))
    click.echo(f"{target / 'results.md'} and {target / 'results.json'}")


if __name__ == "__main__":
    main()
