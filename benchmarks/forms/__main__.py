"""``python -m benchmarks.forms``: results.md and results.json."""

from __future__ import annotations

import json
from pathlib import Path

import click

from benchmarks.batch.report import setting
from benchmarks.forms.measure import measured
from benchmarks.forms.report import markdown

SCENES = ("in_line_engine", "four_bar", "spatial_slider_crank")


@click.command()
@click.option("--rounds", default=3, show_default=True, help="Interleaved rounds of the runs.")
@click.option("--scene", "scenes", multiple=True, help="Only these examples; the other results stay.")
@click.option(
    "-o",
    "target",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path(__file__).parent,
    help="Where to.",
)
def main(rounds: int, scenes: tuple[str, ...], target: Path) -> None:
    """Measure scenes by conventional, parametric and relative coordinates."""
    results, machine = target / "results.json", setting()
    found = {one["scene"]: one for one in json.loads(results.read_text())["scenes"]} if results.exists() else {}
    for name in scenes or SCENES:
        click.echo(name, err=True)
        found[name] = measured(name, rounds)
    ordered = [found[name] for name in (*SCENES, *sorted(found.keys() - set(SCENES))) if name in found]
    document = {"setting": f"{machine['compiler']}, {machine['processor']}", "scenes": ordered}
    target.mkdir(parents=True, exist_ok=True)
    results.write_text(json.dumps(document, indent=1) + "\n")
    (target / "results.md").write_text(markdown(document))
    click.echo(f"{target / 'results.md'} and {results}")


if __name__ == "__main__":
    main()
