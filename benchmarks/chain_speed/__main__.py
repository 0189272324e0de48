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
    with tempfile.TemporaryDirectory() as folder:
        for name in NAMES:
            chain, _ = read(EXAMPLES / f"{name}.toml")
            (Path(folder) / name).mkdir()
            found.append(measured(chain, Path(folder) / name))
    setting = f"{compiler_version()} {' '.join(FLAGS)}"
    (target / "results.json").write_text(
        json.dumps({"setting": setting, "chains": list(map(asdict, found))}, indent=1) + "\n"
    )
    (target / "results.md").write_text(markdown(found, setting))
    click.echo(f"{target / 'results.md'}, results.json")


def markdown(found: list[Result], setting: str) -> str:
    """Write ``results.md``."""
    lines = [
        "# Chains: the generated routine beside routines for any chain",
        "",
        "phi, J, gamma_R, M, f_C and f_G of one pose. The recursion (`table_driven.c`) is written for speed, as far as",
        "it may not know the chain: composite bodies, columns of the Jacobian for the cuts. Pinocchio is called for",
        "the same quantities (`pinocchio.cpp`, -O2, the library as its package ships it). Median of 301 rounds,",
        f"instructions of one call by valgrind, {setting}.",
        "",
        "| chain | operations | by | instructions | times ours | ns | times ours |",
        "|---|---|---|---|---|---|---|",
    ]
    for one in found:
        sides = {"generated": one.routine, "recursion": one.recursion, "Pinocchio": one.pinocchio}
        for name, side in sides.items():
            if side is not None:
                more = side.instructions / one.routine.instructions, side.nanoseconds / one.routine.nanoseconds
                head = f"| {one.chain} | {one.operations}" if side is one.routine else "| | "
                lines.append(
                    f"{head} | {name} | {side.instructions} | {more[0]:.1f} | {side.nanoseconds:.0f} | {more[1]:.1f} |"
                )
    lines += ["", f"Largest difference of any two values, relative: {max(one.difference for one in found):.0e}."]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
