"""Springs between effectors, and soft stops of coordinates, of a chain file."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from codegen.errors import Mistake
from codegen.spec.chain_file.entries import ChainEntry, SpringEntry, StopEntry
from codegen.spec.chain_forces import Spring, Stop
from codegen.spec.scene_file.coordinates import limit_mistakes, make_limit
from codegen.spec.scene_file.text import nearest_known, quoted, shown


def spring_mistakes(entry: SpringEntry, chain: ChainEntry) -> Iterator[Mistake]:
    """Check one spring."""
    links = {effector.name: effector.link for effector in chain.effector if effector.name is not None}
    ends = entry.effectors or ()
    for name in ends:
        if name not in links:
            what = f"there is no effector {quoted(name)}"
            remedy = nearest_known(name, tuple(links)) if links else "write [[effector]] first"
            yield Mistake(f"{entry.place}: effectors", what, remedy)
    if len(ends) == 2 and all(name in links for name in ends) and links[ends[0]] == links[ends[1]]:
        what = f"both ends are on {quoted(links[ends[0]] or '')}"
        yield Mistake(f"{entry.place}: effectors", what, "name effectors on two links; one may be the base")
    for key in ("stiffness", "damping", "length"):
        if getattr(entry, key) < 0:
            yield Mistake(f"{entry.place}: {key}", f"is {shown(getattr(entry, key))}", "give 0 or more")


def stop_mistakes(entry: StopEntry, links: Sequence[str]) -> Iterator[Mistake]:
    """Check the stops of one coordinate."""
    if entry.joint is not None and entry.joint not in links:
        what = f"there is no link {quoted(entry.joint)}"
        yield Mistake(f"{entry.place}: joint", what, nearest_known(entry.joint, links))
    yield from limit_mistakes(entry)


def make_springs(entry: ChainEntry) -> tuple[Spring, ...]:
    """Make the springs of a file without mistakes."""
    return tuple(Spring(s.effectors or ("", ""), s.stiffness, s.damping, s.length) for s in entry.spring)


def make_stops(entry: ChainEntry) -> tuple[Stop, ...]:
    """Make the stops of a file without mistakes."""
    return tuple(Stop(stop.joint or "", make_limit(stop)) for stop in entry.stop)
