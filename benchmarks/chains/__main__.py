"""``python -m benchmarks.chains``: the figures of S2 and the page that shows them, into docs/."""

from __future__ import annotations

from pathlib import Path

import click

from benchmarks.chains import curves, pictures, report

FIGURES = {
    "slider_position": curves.position,
    "crank_speed": curves.speed,
    "slider_acceleration": curves.acceleration,
    "pictures": pictures.pictures,
    "driving_torque": curves.torque,
}


@click.command()
@click.option(
    "-o",
    "target",
    type=click.Path(path_type=Path, file_okay=False),
    default=Path(__file__).parents[2] / "docs",
    help="Where to.",
)
def main(target: Path) -> None:
    """Run the simulations of S2 and draw them."""
    folder = target / "chain_figures"
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in FIGURES.items():
        (folder / f"{name}.svg").write_text(draw())
        click.echo(f"{folder / name}.svg")
    (target / "chain_figures.md").write_text(report.markdown())


if __name__ == "__main__":
    main()
