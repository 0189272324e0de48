"""Frames hung on the links of a chain file: those of cuts and of end effectors."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from codegen.errors import Mistake
from codegen.spec.chain import BASE, Cut, Effector, Frame
from codegen.spec.chain_file.entries import CutEntry, EffectorEntry, FrameEntry
from codegen.spec.chain_file.links import make_row
from codegen.spec.scene_file.text import nearest_known, quoted


def frame_mistakes(entry: FrameEntry, links: Sequence[str]) -> Iterator[Mistake]:
    """Check that a frame stands on a link that there is."""
    if entry.link is not None and entry.link not in (BASE, *links):
        what = f"there is no link {quoted(entry.link)}"
        yield Mistake(f"{entry.place}: link", what, nearest_known(entry.link, [BASE, *links]))


def cut_mistakes(entry: CutEntry, links: Sequence[str]) -> Iterator[Mistake]:
    """Check one cut."""
    for frame in (entry.base, entry.far):
        if frame is not None:
            yield from frame_mistakes(frame, links)
    if entry.base is not None and entry.far is not None and entry.base.link == entry.far.link is not None:
        what = f"both frames stand on {quoted(entry.far.link or '')}"
        yield Mistake(entry.place, what, "put them on the two sides of the cut, which a loop of joints connects")


def make_cut(entry: CutEntry) -> Cut:
    """Make a cut of an entry without mistakes."""
    assert entry.base is not None
    assert entry.far is not None
    return Cut(entry.name or "", _frame(entry.base), _frame(entry.far))


def make_effector(entry: EffectorEntry) -> Effector:
    """Make an effector of an entry without mistakes."""
    return Effector(entry.name or "", _frame(entry), entry.force, entry.moment)


def _frame(entry: FrameEntry) -> Frame:
    return Frame(entry.link or "", make_row(entry))
