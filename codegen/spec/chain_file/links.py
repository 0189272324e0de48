"""Links of a chain file: the tree and mass properties are checked, then a `Link` is made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from codegen.errors import Mistake
from codegen.spec.chain import BASE, Link, Row
from codegen.spec.chain_file.entries import ChainEntry, LinkEntry, RowEntry
from codegen.spec.scene import ZERO_VECTOR, Matrix
from codegen.spec.scene_file.bodies import TOLERANCE, definite_mistakes, symmetric, triangle_mistakes
from codegen.spec.scene_file.text import nearest_known, quoted, shown

_NO_INERTIA: Matrix = (ZERO_VECTOR, ZERO_VECTOR, ZERO_VECTOR)


def tree_mistakes(links: Sequence[LinkEntry]) -> Iterator[Mistake]:
    """Check that each link hangs on one before it."""
    names = [link.name for link in links]
    before: list[str] = [BASE]
    for link in links:
        place = f"{link.place}: parent"
        if link.name == BASE:
            what = f'"{BASE}" is link 0, on which the others hang'
            yield Mistake(f"{link.place}: name", what, "use another name; it needs no entry")
        if link.parent is not None and link.parent not in before:
            if link.parent == link.name:
                yield Mistake(place, "a link cannot hang on itself", "name a link above it")
            elif link.parent in names:
                yield Mistake(place, f"{quoted(link.parent)} stands below", "write parents before children")
            else:
                yield Mistake(place, f"there is no link {quoted(link.parent)}", nearest_known(link.parent, before))
        if link.name is not None:
            before.append(link.name)


def pitch_mistakes(link: LinkEntry) -> Iterator[Mistake]:
    """Check the pitch of one link."""
    place = f"{link.place}: pitch"
    if link.type == "screw" and "pitch" not in link.given:
        yield Mistake(place, "is missing", "give the advance in m/rad")
    elif link.type == "screw" and link.pitch == 0 and "pitch" not in link.wrong:
        yield Mistake(place, "is 0 m/rad", "give the advance in m/rad, or make it revolute")
    elif link.type in ("revolute", "prismatic") and "pitch" in link.given:
        yield Mistake(place, f"a {link.type} joint has no pitch", "leave pitch out, or make it a screw")


def mass_mistakes(link: LinkEntry) -> Iterator[Mistake]:
    """Check the mass properties of one link."""
    if link.mass < 0:
        yield Mistake(f"{link.place}: mass", f"is {shown(link.mass)} kg", "give a mass of 0 kg or more")
    if link.rotor < 0:
        unit = "kg" if link.type == "prismatic" else "kg m^2"
        yield Mistake(f"{link.place}: rotor", f"is {shown(link.rotor)} {unit}", f"give 0 {unit} or more")
    if link.mass == 0 and "mass" not in link.wrong and any(link.centre):
        what = "a massless link has no centre of mass"
        yield Mistake(f"{link.place}: centre", what, "leave centre out, or give a mass")
    if link.inertia is not None and any(map(any, link.inertia)):
        yield from _inertia_mistakes(link, link.inertia)


def _inertia_mistakes(link: LinkEntry, inertia: Matrix) -> Iterator[Mistake]:
    """Check an inertia: a thin rod has none about its axis, and what is identified is that of no single body."""
    place = f"{link.place}: inertia"
    mistakes = definite_mistakes(inertia, place, TOLERANCE)
    if mistakes or link.effective:
        yield from mistakes
        return
    for mistake in triangle_mistakes(inertia, place):
        remedy = "correct it, or say effective = true: moments of motion in a plane, identified ones, or with a drive's"
        yield Mistake(mistake.place, mistake.what, remedy)


def massless_mistakes(entry: ChainEntry) -> Iterator[Mistake]:
    """Find coordinates that move no mass and that no cut holds: their accelerations would be undetermined.

    Where a cut names a link that is not there, that is the mistake.
    """
    names = {BASE, *(link.name for link in entry.link)}
    if any(frame.link not in names for cut in entry.cut for frame in (cut.base, cut.far) if frame is not None):
        return
    children = {link.name: [other.name for other in entry.link if other.parent == link.name] for link in entry.link}
    held = {frame.link for cut in entry.cut for frame in (cut.base, cut.far) if frame is not None}
    heavy = {link.name for link in entry.link if _is_heavy(link)}
    weighty: set[str | None] = set()
    for link in reversed(entry.link):
        if link.name in held | heavy or weighty.intersection(children[link.name]):
            weighty.add(link.name)
    for link in entry.link:
        if link.name not in weighty and not {"name", "mass", "inertia"} & link.wrong:
            what = "neither it nor what hangs on it has mass, and no cut holds it"
            yield Mistake(link.place, what, "give a mass or an inertia, or leave it out")


def _is_heavy(link: LinkEntry) -> bool:
    return bool(link.mass or link.rotor or (link.inertia and any(map(any, link.inertia))))


def make_row(entry: RowEntry) -> Row:
    """Make a row of the table."""
    return Row(entry.psi, entry.c, entry.alpha, entry.a, entry.theta, entry.d)


def make_link(entry: LinkEntry) -> Link:
    """Make a link of an entry without mistakes."""
    return Link(
        entry.name or "",
        entry.parent or "",
        entry.type or "",
        make_row(entry),
        entry.mass,
        entry.centre,
        symmetric(entry.inertia or _NO_INERTIA),
        entry.prefer,
        entry.pitch,
        entry.rotor,
    )
