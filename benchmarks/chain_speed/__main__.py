"""``python -m benchmarks.chain_speed``: measure the mechanisms of S2, write the results beside this file."""

from __future__ import annotations

import json
import tempfile
from dataclasses import asdict
from pathlib import Path

import click

from benchmarks.chain_speed.measure import FLAGS, HERE, Result, measured
from codegen.chains.read import read
from codegen.measure.compile import compiler_version

EXAMPLES = Path(__file__).parents[2] / "examples" / "chains"
NAMES = ("quick_return", "spatial_slider_crank")


@click.command()
@click.option("-o", "target", type=click.Path(path_type=Path, file_okay=False), default=HERE, help="Where to.")
def main(target: Path) -> None:
    """Compare the generated routines of chains with a recursion that reads a table."""
    found = []
    for name in NAMES:
        chain, _ = read(EXAMPLES / f"{name}.toml")
        with tempfile.TemporaryDirectory() as folder:
            found.append(measured(chain, Path(folder)))
    setting = f"{compiler_version()} {' '.join(FLAGS)}"
    (target / "results.json").write_text(
        json.dumps({"setting": setting, "chains": list(map(asdict, found))}, indent=1) + "\n"
    )
    (target / "results.md").write_text(markdown(found, setting))
    click.echo(f"{target / 'results.md'}, results.json")


def markdown(found: list[Result], setting: str) -> str:
    """Write ``results.md``."""
    lines = [
        "# Chains: the generated routine beside a recursion that reads a table",
        "",
        "phi, J, gamma_R, M, f_C and f_G of one pose. The recursion (`table_driven.c`) is written for speed, as far as",
        "it may not know the chain: composite bodies, columns of the Jacobian for the cuts. Median of 301 interleaved",
        f"rounds, instructions by valgrind, {setting}.",
        "",
        "| chain | operations | instructions | recursion | fewer | ns | recursion | faster | largest difference |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for one in found:
        a, b = one.routine, one.recursion
        counted = f"{a.instructions} | {b.instructions} | {b.instructions / a.instructions:.1f}"
        timed = f"{a.nanoseconds:.0f} | {b.nanoseconds:.0f} | {b.nanoseconds / a.nanoseconds:.1f}"
        lines.append(f"| {one.chain} | {one.operations} | {counted} | {timed} | {one.difference:.0e} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
