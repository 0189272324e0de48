"""``python -m benchmarks.peers``: generate, check, count and time the same routines with every peer.

See benchmarks/README.md for how to read what it prints.
"""

from __future__ import annotations

import os
import platform
import shutil
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import click

from benchmarks.peers import oracle, report, vm
from benchmarks.peers.candidates import (
    HERE,
    PEERS,
    Candidate,
    UnusablePeerError,
    floor_candidate,
    generated_package,
    our_candidate,
    peer_candidates,
    used_inputs,
    version,
)
from benchmarks.peers.compile import FLAGS, Setting, settings
from benchmarks.peers.constraint import JOINTS
from benchmarks.peers.harness import FOLDER
from benchmarks.peers.measure import Measured, measure
from benchmarks.peers.report import JointResult
from benchmarks.peers.work import Ours, read_package

Packages = dict[str, tuple[Ours, float | None]]
"""Label -> package of ours, seconds of its generation."""


def _names(known: Sequence[str]) -> Any:
    class Names(click.ParamType):  # type: ignore[type-arg]
        name = ",".join(known[:2]) + ",..."

        def convert(
            self, value: str | tuple[str, ...], param: click.Parameter | None, ctx: click.Context | None
        ) -> tuple[str, ...]:
            names = tuple(value.split(",")) if isinstance(value, str) else value
            for name in names:
                if name not in known:
                    self.fail(f'there is no "{name}"; known: {", ".join(known)}', param, ctx)
            return names

    return Names()


def _log(line: str) -> None:
    click.echo(line, err=True)


def _given_packages(folders: Sequence[Path]) -> Packages:
    """Packages named on the command line: the first is ours, the others carry the name of their folder."""
    packages: Packages = {}
    for k, folder in enumerate(folders):
        try:
            package = read_package(folder)
        except FileNotFoundError:
            raise click.UsageError(f"--ours {folder}: there is no manifest.json; name a package of jointgen") from None
        packages["ours" if k == 0 else f"ours {folder.name}"] = (package, None)
    return packages


def _candidates(joint: str, packages: Packages, peers: Sequence[str], skipped: dict[str, str]) -> list[Candidate]:
    first = next(iter(packages.values()))[0]
    work = first.work(joint)
    found = [our_candidate(package, joint, label, seconds) for label, (package, seconds) in packages.items()]
    for peer in peers:
        try:
            found += peer_candidates(peer, joint, first.folder, work)
        except UnusablePeerError as error:
            if peer not in skipped:
                _log(f"{peer} is left out: {error}")
            skipped[peer] = str(error)
    return [*found, floor_candidate(joint, work, used_inputs(joint, work))]


def _environment(chosen: Sequence[Setting], peers: Sequence[str], skipped: dict[str, str]) -> dict[str, str]:
    environment = {"processor": _processor(), "work": "phi, phi_q and (phi_q^T lambda)_q in one call"}
    for compiler in dict.fromkeys(setting.compiler for setting in chosen):
        done = subprocess.run([compiler, "--version"], capture_output=True, text=True, check=True)
        environment[compiler] = done.stdout.splitlines()[0]
    for peer in peers:
        environment[peer] = f"left out: {skipped[peer]}" if peer in skipped else version(peer)
    return environment


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    lines = information.read_text().splitlines() if information.exists() else []
    named = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    return named[0] if named else platform.machine()


def _result(
    joint: str,
    packages: Packages,
    candidates: Sequence[Candidate],
    chosen: Sequence[Setting],
    rounds: int,
    instructions: bool,
    virtual: bool,
) -> JointResult:
    ours = next(iter(packages.values()))[0]
    work, truth = ours.work(joint), oracle.truth(joint)
    measured = measure(work, truth, candidates, chosen, rounds, instructions, _log)
    _compare_counts(joint, packages, measured)
    functions = {label: package.casadi[joint] for label, (package, _) in packages.items() if joint in package.casadi}
    times = vm.virtual_times(work, truth, functions, max(1, rounds // 20)) if virtual else []
    return JointResult(joint, ours.operations(joint), measured, times)


def _compare_counts(joint: str, packages: Packages, measured: Sequence[Measured]) -> None:
    """Say where the object code of ours has other operations than its manifest tells."""
    for each in measured:
        if each.candidate.name in packages and each.operations:
            told, found = packages[each.candidate.name][0].operations(joint), each.operations["total"]
            if told != found:
                _log(f"{joint}: the manifest of {each.candidate.name} tells {told} operations, its object code {found}")


@click.command()
@click.option("--joints", type=_names(JOINTS), default=JOINTS, help="Joints, separated by commas.")
@click.option("--peers", type=_names(tuple(PEERS)), default=tuple(PEERS), help="Peers, separated by commas.")
@click.option(
    "--ours",
    "folders",
    type=click.Path(file_okay=False, path_type=Path),
    multiple=True,
    help="Time this package in place of a fresh one; given again, further packages beside it.",
)
@click.option("--flags", type=_names(tuple(FLAGS)), default=tuple(FLAGS), help="Sets of flags: O3-native, O2.")
@click.option("--rounds", type=click.IntRange(min=8), default=2000, help="Interleaved rounds of the timing.")
@click.option("--instructions/--no-instructions", default=True, help="Count instructions with valgrind.")
@click.option("--vm/--no-vm", "virtual", default=True, help="Time CasADi's virtual machine.")
@click.option("-o", "output", type=click.Path(file_okay=False, path_type=Path), help="Where results.md and .json go.")
def main(
    joints: tuple[str, ...],
    peers: tuple[str, ...],
    folders: tuple[Path, ...],
    flags: tuple[str, ...],
    rounds: int,
    instructions: bool,
    virtual: bool,
    output: Path | None,
) -> None:
    """Lay our routines beside those of other code generators.

    Prints the tables. A complete run (every joint and peer, none left out, a fresh package) writes them to
    benchmarks/peers too.
    """
    chosen = settings(flags)
    if not chosen:
        raise click.ClickException("there is no C compiler; install gcc")
    given = _given_packages(folders)
    skipped: dict[str, str] = {}
    results = []
    for joint in joints:
        packages = {label: pair for label, pair in given.items() if joint in pair[0].functions}
        if not folders:
            folder, seconds = generated_package(joint)
            packages = {"ours": (read_package(folder), seconds)}
        if not packages:
            _log(f"{joint}: no package given has its routine of phi, phi_q and phi_q_t_lambda_q; left out")
            continue
        candidates = _candidates(joint, packages, [peer for peer in peers if peer not in skipped], skipped)
        results.append(_result(joint, packages, candidates, chosen, rounds, instructions, virtual))
        _log(f"{joint} done")
    if not results:
        raise click.UsageError("nothing to measure; --outputs phi,phi_q,phi_q_t_lambda_q makes a package that fits")
    shutil.rmtree(FOLDER, ignore_errors=True)
    environment = _environment(chosen, peers, skipped)
    text = report.as_markdown(results, chosen, environment)
    click.echo(text)
    complete = (set(joints), set(peers), set(flags)) == (set(JOINTS), set(PEERS), set(FLAGS)) and not folders
    complete = complete and not skipped
    target = output or (HERE if complete else None)
    if target:
        os.makedirs(target, exist_ok=True)
        (target / "results.md").write_text(text)
        (target / "results.json").write_text(report.as_json(results, chosen, environment))


if __name__ == "__main__":
    main()
