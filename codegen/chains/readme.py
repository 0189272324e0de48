"""The README of a chain: what it is made of and what its routines cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from codegen.emit.chain_subject import ChainSubject
from codegen.emit.environment import render
from codegen.emit.package import banner
from codegen.emit.routine import Routine
from codegen.mechanics.chain.model import ROW_NAMES
from codegen.scenes.markdown import Code, table


def readme(subject: ChainSubject, routines: Sequence[Routine], version: str, specification: str) -> str:
    """Write the README.

    Args:
        subject: the chain.
        routines: everything that is emitted.
        version: of jointgen.
        specification: hash of the chain and of what was asked for.
    """
    chain = subject.chain
    return render(
        "chain/README.md.j2",
        name=chain.name,
        banner=banner(version),
        specification=specification,
        summary=_summary(subject),
        links=table(("link", "in C", "hung on", "joint", "at the start", "mass, kg"), _links(subject)),
        cuts=table(("cut", "between", "rows"), _cuts(subject)) if chain.cuts else "",
        effectors=table(("effector", "on"), ((e.name, e.frame.link) for e in chain.effectors))
        if chain.effectors
        else "",
        functions=table(("function", "operations"), [(Code(r.symbol), str(r.counts)) for r in routines]),
    )


def _summary(subject: ChainSubject) -> str:
    chain = subject.chain
    left_out = 6 * len(chain.cuts) - len(subject.rows)
    words = (
        f"{_many(len(chain.links), 'link')}, {_many(len(chain.cuts), 'cut')}: {_many(len(subject.rows), 'row')} over "
    )
    words += f"{_many(len(chain.links), 'coordinate')}."
    if left_out:
        words += f" {left_out} rows of the cuts are constant, they are not in the routines."
    return words + (
        " The base moves: its pose, velocity and acceleration are arguments." if chain.base == "moving" else ""
    )


def _many(number: int, thing: str) -> str:
    return f"{number} {thing}{'' if number == 1 else 's'}"


def _links(subject: ChainSubject) -> Iterator[tuple[str, ...]]:
    for link, name in zip(subject.chain.links, subject.links, strict=True):
        at = f"{float(link.coordinate):.6g} {link.unit}"
        yield link.name, Code(name), link.parent, link.type, at, f"{float(link.mass):g}" if link.mass else ""


def _cuts(subject: ChainSubject) -> Iterator[tuple[str, ...]]:
    for number, cut in enumerate(subject.chain.cuts):
        rows = [ROW_NAMES[row % 6] for row in subject.rows if row // 6 == number]
        yield cut.name, f"{cut.base.link} - {cut.far.link}", ", ".join(rows) or "none"
