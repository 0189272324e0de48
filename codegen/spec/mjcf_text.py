"""What is looked at in the text of a MuJoCo model before MuJoCo reads it: that it opens no other file, and ends."""

from __future__ import annotations

import posixpath
from collections.abc import Iterator, Mapping
from xml.etree.ElementTree import Element

from codegen.errors import Mistake, SpecificationError
from codegen.spec.imported import quoted
from codegen.spec.xml_text import GREATEST, number, read_xml

MOST_COPIES = 10_000
"""Copies that ``replicate`` may make of an element."""

_REFUSED = {
    "composite": "write its bodies out, or take it out: what bends is not modelled",
    "flexcomp": "take it out: what bends is not modelled",
    "flex": "take it out: what bends is not modelled",
    "attach": "save the model as one file first (mj_saveLastXML)",
    "plugin": "take it out: what it does is not modelled",
}
"""Elements that make a part of the mechanism out of other files, in bulk or by programs."""


def parts_of(text: str | bytes, place: str, files: Mapping[str, bytes]) -> dict[str, Element]:
    """The elements of a model and of the files that it includes, by the names of the files.

    Raises:
        SpecificationError: files that are missing or outside the folder, parts that are not read, no numbers.
    """
    root = read_xml(text, place)
    if root.tag != "mujoco":
        what = f"is no model of MuJoCo: its first element is {quoted(root.tag)}"
        raise SpecificationError([Mistake(place, what, "give a file that begins with <mujoco>")])
    parts = {place: root}
    mistakes = list(_unreadable(root, place, files, parts))
    if mistakes:
        raise SpecificationError(mistakes)
    return parts


def _unreadable(root: Element, place: str, files: Mapping[str, bytes], parts: dict[str, Element]) -> Iterator[Mistake]:
    yield from _copies(root, place)
    names = {element.get(key) for element in root.iter() for key in ("name", "class")}
    for element in root.iter():
        if element.tag in _REFUSED or (element.tag == "model" and element.get("file")):
            yield Mistake(f"{place}: {element.tag}", "is not read", _REFUSED.get(element.tag, _REFUSED["attach"]))
        for key, value in element.items():
            if value not in names and not all(map(_is_usable, value.split())):
                what = f"{quoted(value)} is no number, or beyond {GREATEST:g}"
                yield Mistake(f"{place}: {element.tag}: {key}", what, "write numbers")
        if element.tag == "include":
            yield from _included(element.get("file", ""), place, files, parts)


def _is_usable(word: str) -> bool:
    """Whether a word is no number, or one that a scene may have."""
    try:
        return abs(float(word)) <= GREATEST
    except ValueError:
        return True


def _included(name: str, place: str, files: Mapping[str, bytes], parts: dict[str, Element]) -> Iterator[Mistake]:
    where = f"{place}: include {quoted(name)}"
    if name in parts:
        yield Mistake(where, "is included before", "include it once")
    elif posixpath.isabs(name) or ".." in name.replace("\\", "/").split("/"):
        yield Mistake(where, "is outside the folder of the model", "put it beside the model")
    elif name not in files:
        yield Mistake(where, "is missing", "put it beside the model")
    else:
        parts[name] = read_xml(files[name], name)
        yield from _unreadable(parts[name], name, files, parts)


def _copies(root: Element, place: str) -> Iterator[Mistake]:
    level = [(root, 1)]
    while level:
        below = []
        for element, copies in level:
            count = number(element.get("count", "1")) if element.tag == "replicate" else 1
            all_copies = copies * max(1, int(count or 1))
            if all_copies > MOST_COPIES:
                yield Mistake(f"{place}: replicate", f"makes more than {MOST_COPIES} copies", "make fewer")
                return
            below += [(child, all_copies) for child in element]
        level = below
