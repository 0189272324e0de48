"""``python -m benchmarks.platforms``: time the candidates in one run, write the results beside this file.

The figure of docs/platform.md, the loss of digits, is drawn too.
"""

from __future__ import annotations

import json
import tempfile
import time
from pathlib import Path

import click
import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.platforms.candidates import HERE, Array, Evaluate, candidates
from benchmarks.platforms.loss import loss_figure
from codegen.measure.compile import compiler_version
from codegen.spec.platform_file import read_platform

FIGURE = HERE.parent.parent / "docs" / "figures" / "platform_loss.svg"
FILE = HERE.parent.parent / "examples" / "platforms" / "octahedral.toml"
REFERENCE = "numpy, batch QR and SVD"
SLOW = "numpy, pose by pose"


@click.command()
@click.option("--poses", default=20_000, show_default=True, help="Poses of one evaluation.")
@click.option("--rounds", default=7, show_default=True, help="Interleaved rounds; the fastest counts.")
@click.option("-o", "target", type=click.Path(path_type=Path, file_okay=False), default=HERE, help="Where to.")
def main(poses: int, rounds: int, target: Path) -> None:
    """Time D and C of all four blocks for random poses around home."""
    platform = read_platform(FILE.read_text(), FILE.name)
    where = random_poses(poses)
    with tempfile.TemporaryDirectory() as folder:
        found = candidates(platform, Path(folder))
        check(found, where)
        times = {name: float("inf") for name in found}
        for _ in range(rounds):
            for name, evaluate in found.items():
                times[name] = min(times[name], timed(evaluate, where, 20 if name == SLOW else 1))
    target.mkdir(parents=True, exist_ok=True)
    (target / "results.json").write_text(json.dumps(times, indent=1) + "\n")
    (target / "results.md").write_text(report(times))
    FIGURE.write_text(loss_figure())
    click.echo(report(times))


def random_poses(count: int) -> tuple[Array, Array]:
    """Origins and rotations around home."""
    generator = np.random.default_rng(0)
    o = np.array([0, 0, 1.0]) + generator.uniform(-0.2, 0.2, (count, 3))
    return o, Rotation.from_rotvec(generator.uniform(-0.4, 0.4, (count, 3))).as_matrix()


def check(found: dict[str, Evaluate], where: tuple[Array, Array]) -> None:
    """All candidates give the same indices.

    Raises:
        AssertionError: one does not.
    """
    o, R = (array[:500] for array in where)
    expected = found[REFERENCE](o, R)
    for name, evaluate in found.items():
        for one, other in zip(evaluate(o, R), expected, strict=True):
            np.testing.assert_allclose(one, other, rtol=1e-7, err_msg=name)


def timed(evaluate: Evaluate, where: tuple[Array, Array], share: int) -> float:
    """Nanoseconds a pose; ``share``: only one in so many poses."""
    o, R = (np.ascontiguousarray(array[::share]) for array in where)
    start = time.perf_counter()
    evaluate(o, R)
    return (time.perf_counter() - start) / len(o) * 1e9


def report(times: dict[str, float]) -> str:
    """The results as Markdown."""
    lines = [
        "# Velocity indices: time a pose",
        "",
        f"D and C of all four blocks of the octahedral example on one core, {compiler_version()}, "
        "`-O3 -march=native -ffp-contract=off -fno-math-errno`; the fastest of interleaved rounds. Bringing the poses "
        "into the layout of a candidate counts.",
        "",
        "| candidate | ns a pose | of numpy's batch |",
        "|---|---|---|",
    ]
    lines += [
        f"| {name} | {t:.0f} | 1/{times[REFERENCE] / t:.1f} |" for name, t in sorted(times.items(), key=lambda x: x[1])
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
