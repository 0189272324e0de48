"""The stages of reading a chain file, in order."""

from __future__ import annotations

from collections.abc import Iterator

from codegen.errors import Mistake, SpecificationError
from codegen.spec.chain import (
    BASE_COORDINATES,
    CHAIN_QUANTITIES,
    CLOSURE_QUANTITIES,
    EFFECTOR_FORCE_QUANTITIES,
    EFFECTOR_QUANTITIES,
    JOINT_FORCE_QUANTITIES,
    MASS_QUANTITIES,
    Chain,
)
from codegen.spec.chain_file.entries import ChainEntry
from codegen.spec.chain_file.hung import cut_mistakes, frame_mistakes, make_cut, make_effector
from codegen.spec.chain_file.links import make_link, mass_mistakes, massless_mistakes, pitch_mistakes, tree_mistakes
from codegen.spec.chain_file.loads import (
    acts_at_effectors,
    acts_on_joints,
    force_mistakes,
    independent_mistakes,
    make_base_independents,
    make_forces,
    make_independents,
    make_world_forces,
)
from codegen.spec.chain_file.springs import make_springs, make_stops, spring_mistakes, stop_mistakes
from codegen.spec.scene_file.entry import read_entry
from codegen.spec.scene_file.names import name_mistakes, routine_name_mistakes
from codegen.spec.scene_file.reading import bounded
from codegen.spec.scene_file.tables import read_tables
from codegen.spec.scene_file.text import escaped


def read_chain(text: str, place: str) -> Chain:
    """Read a chain file.

    Args:
        text: TOML, see ``docs/chain.md``.
        place: name of the file in messages.

    Raises:
        SpecificationError: all mistakes of the file; only those of its syntax where it is no TOML. Whether the cuts
            close at t = 0 is not looked at here.
    """
    file = escaped(place, 200)
    mistakes: list[Mistake] = []
    entry = read_entry(ChainEntry, read_tables(text, file), file, mistakes)
    assert entry is not None
    mistakes += _tree_mistakes(entry)
    mistakes += _load_mistakes(entry)
    if mistakes:
        raise SpecificationError(bounded(mistakes, file))
    return _chain(entry)


def _tree_mistakes(entry: ChainEntry) -> Iterator[Mistake]:
    """Check links, cuts and effectors."""
    if entry.name is not None:
        yield from routine_name_mistakes(entry.name, f"{entry.place}: name", "chain")
    for parts in (entry.link, entry.cut, entry.effector):
        yield from name_mistakes(parts)
    yield from tree_mistakes(entry.link)
    for link in entry.link:
        yield from mass_mistakes(link)
        yield from pitch_mistakes(link)
    asked = entry.output.quantities if entry.output is not None else ()
    if not asked or set(asked) & set(MASS_QUANTITIES):
        yield from massless_mistakes(entry)
    links = _links(entry)
    for link in entry.link:
        if entry.base == "moving" and link.name in BASE_COORDINATES:
            yield Mistake(link.place, "has the name of a coordinate of the base", "give it another name")
    for cut in entry.cut:
        yield from cut_mistakes(cut, links)
    for effector in entry.effector:
        yield from frame_mistakes(effector, links)


def _load_mistakes(entry: ChainEntry) -> Iterator[Mistake]:
    """Check what moves the chain, and what is asked of it."""
    links = _links(entry)
    effectors = [part.name for part in entry.effector if part.name is not None]
    yield from independent_mistakes(entry, links)
    for force in entry.force:
        yield from force_mistakes(force, links, effectors)
    for spring in entry.spring:
        yield from spring_mistakes(spring, entry)
    for stop in entry.stop:
        yield from stop_mistakes(stop, links)
    asked = entry.output.quantities if entry.output is not None else ()
    missing = {name: "cut" for name in CLOSURE_QUANTITIES if not entry.cut}
    missing |= {name: "effector" for name in EFFECTOR_QUANTITIES if not entry.effector}
    missing |= dict.fromkeys(() if acts_on_joints(entry) else JOINT_FORCE_QUANTITIES, "force")
    missing |= dict.fromkeys(() if acts_at_effectors(entry) else EFFECTOR_FORCE_QUANTITIES, "force")
    for name in asked:
        if name in missing:
            place = f"{entry.place}: output: quantities"
            yield Mistake(place, f"{name} needs [[{missing[name]}]], and there is none", "leave it out")


def _links(entry: ChainEntry) -> list[str]:
    return [link.name for link in entry.link if link.name is not None]


def _chain(entry: ChainEntry) -> Chain:
    joint_forces, effector_forces = make_forces(entry)
    asked = entry.output.quantities if entry.output is not None else ()
    return Chain(
        entry.name or "",
        entry.gravity,
        tuple(make_link(link) for link in entry.link),
        tuple(make_cut(cut) for cut in entry.cut),
        tuple(make_effector(effector) for effector in entry.effector),
        make_independents(entry),
        joint_forces,
        effector_forces,
        entry.base,
        entry.assemble,
        tuple(name for name in CHAIN_QUANTITIES if name in asked),
        make_base_independents(entry),
        make_world_forces(entry),
        make_springs(entry),
        make_stops(entry),
    )
