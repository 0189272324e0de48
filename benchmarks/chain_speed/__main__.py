"""``python -m benchmarks.chain_speed``: measure the mechanisms of S2, write the results beside this file."""

from __future__ import annotations

import json
import tempfile
from dataclasses import asdict
from pathlib import Path

import click

from benchmarks.chain_speed import pinocchio
from benchmarks.chain_speed.driven import Driven, driven
from benchmarks.chain_speed.measure import FLAGS, HERE, Result, measured
from benchmarks.chain_speed.open_chains import CHAINS, STATES, Agreement, agreement
from benchmarks.chain_speed.step import Step, step
from codegen.chains.read import read
from codegen.measure.compile import compiler_version

EXAMPLES = Path(__file__).parents[2] / "examples" / "chains"
NAMES = ("quick_return", "spatial_slider_crank")


@click.command()
@click.option("-o", "target", type=click.Path(path_type=Path, file_okay=False), default=HERE, help="Where to.")
def main(target: Path) -> None:
    """Compare the generated routines of chains with a recursion that reads a table."""
    found, steps, driven_steps = [], {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for name in NAMES:
            chain, _ = read(EXAMPLES / f"{name}.toml")
            (Path(folder) / name).mkdir()
            found.append(measured(chain, Path(folder) / name))
            steps[name] = step(chain, Path(folder) / name)
            driven_steps[name] = driven(chain)
    agrees = agreement() if pinocchio.prefix() else None
    setting = f"{compiler_version()} {' '.join(FLAGS)}"
    numbers = {
        "setting": setting,
        "chains": list(map(asdict, found)),
        "steps": {name: asdict(one) for name, one in steps.items()},
        "driven": {name: asdict(one) for name, one in driven_steps.items()},
        "open_chains": asdict(agrees) if agrees else None,
    }
    (target / "results.json").write_text(json.dumps(numbers, indent=1) + "\n")
    parts = [markdown(found, setting), of_steps(steps), of_driven(driven_steps), of_open_chains(agrees)]
    (target / "results.md").write_text("".join(parts))
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


def of_steps(steps: dict[str, Step]) -> str:
    """The part of ``results.md`` on whole steps."""
    lines = [
        "",
        "## A whole step of inverse dynamics",
        "",
        "From q, qd and the independent accelerations to all accelerations, efforts and reactions, loops solved. Ours:",
        "the generated routine, then what the run time does with the rows that bind: LU (`dgetrf`) and the condition",
        "number where they are square, as here, else QR with pivoting (`dgeqp3`). Generic: the recursion, then the",
        "pseudo-inverse of all six rows of each cut by SVD (`dgesdd`), multiplied out as `numpy.linalg.pinv` does.",
        "Both are C (`step.c.j2`), both call the LAPACK that SciPy brings, on one thread, in turns. The ratio is the",
        "median of 301 rounds.",
        "",
        "| chain | ours, ns | generic, ns | ours / generic |",
        "|---|---|---|---|",
    ]
    lines += [f"| {name} | {one.routine:.0f} | {one.generic:.0f} | {one.ratio:.2f} |" for name, one in steps.items()]
    lines += [
        "",
        f"Efforts and reactions differ by {max(one.difference for one in steps.values()):.0e} of the largest.",
    ]
    return "\n".join(lines) + "\n"


def of_driven(found: dict[str, Driven]) -> str:
    """The part of ``results.md`` on steps that Python drives."""
    lines = [
        "",
        "Python drives the run time, and takes nearly all of its time: `codegen.chains.reduced` with the rank test and",
        "rates from the Jacobian, beside the same routines with `numpy.linalg.pinv` of all rows; fastest of 9 rounds.",
        "",
        "| chain | run time, us | pseudo-inverse, us | ratio |",
        "|---|---|---|---|",
    ]
    for name, one in found.items():
        ratio = one.run_time / one.pseudo_inverse
        lines.append(f"| {name} | {one.run_time:.0f} | {one.pseudo_inverse:.0f} | {ratio:.2f} |")
    return "\n".join(lines) + "\n"


def of_open_chains(agrees: Agreement | None) -> str:
    """The part of ``results.md`` on open chains beside Pinocchio; empty without it."""
    if agrees is None:
        return ""
    lines = [
        "",
        "## Open chains beside Pinocchio",
        "",
        f"{CHAINS} random trees of 3 to 10 revolute and prismatic joints, {STATES} states each: largest difference,",
        "relative to the largest value of the quantity in the state.",
        "",
        "| M | f_C - f_G | Jacobians of two end effectors |",
        "|---|---|---|",
        f"| {agrees.M:.0e} | {agrees.bias:.0e} | {agrees.D_E:.0e} |",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
