"""Search long for the cheapest evaluation of every routine of the library, and put what is found on record.

Run by ``make search``; writes codegen/records.json. What is on record already competes, so that a run never makes a
routine dearer; records of graphs that exist no more are dropped.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import click
from rich.progress import Progress

import codegen
from codegen import build, models
from codegen.ir.lower.record import fingerprint, recorded, replayed
from codegen.ir.lower.search import Choice, Graph, searched
from codegen.mechanics.joints import JOINTS, PAIRS
from codegen.parallel import parallel
from codegen.spec.request import Options, Variant
from flopcount.count import count

FILE = Path(codegen.__file__).with_name("records.json")
DERIVATIVES = ("phi", "phi_q", "phi_q_t_lambda_q")
"""The routine that implicit integrators call, beside those of the library."""


@dataclass(frozen=True, slots=True)
class Job:
    """The routines of one variant.

    Attributes:
        variant: form and options.
        starts: how many starts each search has.
        routines: names of the routines; none means all of them.
    """

    variant: Variant
    starts: int
    routines: tuple[str, ...] = ()


def search(job: Job) -> tuple[dict[str, str], str]:
    """Search for every routine of a variant; gives the records and a line that says what was found."""
    symbolic = models.model(job.variant)
    records: dict[str, str] = {}
    words = []
    for name, quantities in _routines(job.variant):
        if job.routines and name not in job.routines:
            continue
        found: list[tuple[Graph, Sequence[int], list[Choice]]] = []

        def choose(
            graph: Graph, nodes: Sequence[int], found: list[tuple[Graph, Sequence[int], list[Choice]]] = found
        ) -> list[Choice]:
            choices = searched(graph, nodes, range(job.starts), best=4)
            before = models.records().get(fingerprint(graph, nodes))
            if before is not None:
                choices.append(replayed(graph, nodes, before))
            found.append((graph, nodes, choices))
            return choices

        programs = symbolic.programs(symbolic.outputs(quantities), None, choose)
        totals = [count(program).total for program in programs]
        best = totals.index(min(totals))
        words.append(f"{name} {totals[best]}")
        for graph, nodes, choices in found:
            choice = choices[min(best, len(choices) - 1)]
            records[fingerprint(graph, nodes)] = recorded(graph, nodes, choice)
    return records, f"{job.variant.file_stem}: {', '.join(words)}"


def _routines(variant: Variant) -> Iterator[tuple[str, Sequence[str]]]:
    yield from build.quantities_of(()).items()
    yield "derivatives", DERIVATIVES
    if variant.form == "parametric":
        yield "phi_q + second", DERIVATIVES[1:]


def _on_request() -> list[Variant]:
    """Variants outside the library: world variation and quaternion rows of the parametric form, and all pairs."""
    world = Options(tuple(JOINTS), "parametric", variation="world")
    free = tuple(name for name in PAIRS if name.endswith("rot3"))
    quaternion = Options(("ball", *free), "parametric", "quaternion")
    turned = Options(("ball", *free), "parametric", "quaternion", variation="world")
    pairs = Options(tuple(PAIRS), "parametric")
    return [variant for options in (world, quaternion, turned, pairs) for variant in build.variants(options)]


@click.command()
@click.option("--starts", default=12, show_default=True, help="Starts of each search.")
@click.option("--routines", default="", help="Comma-separated outputs, or derivatives; everything if left out.")
def main(starts: int, routines: str) -> None:
    """Search long, and write codegen/records.json; what a partial run leaves out stays on record."""
    names = tuple(name for name in routines.split(",") if name)
    screw = [Variant("screw", "conventional", None, "substituted", variation) for variation in ("body", "world")]
    jobs = [Job(variant, starts, names) for variant in (*build.variants(build.LIBRARY), *screw)]
    jobs += [Job(variant, max(starts // 8, 1), names) for variant in _on_request()]
    with Progress(transient=True) as progress:
        task = progress.add_task("search", total=len(jobs))
        results = parallel(search, jobs, lambda job: progress.advance(task))
    records = dict(models.records()) if names else {}
    records |= {key: record for found, _ in results for key, record in found.items()}
    FILE.write_text(json.dumps(dict(sorted(records.items())), indent=0) + "\n", encoding="utf-8")
    for _, line in results:
        click.echo(line)


if __name__ == "__main__":
    main()
