"""Names in a scene file: the scene's is a C identifier, those of bodies and joints are any text that prints."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from typing import Protocol

from codegen.errors import Mistake
from codegen.spec.scene import GROUND
from codegen.spec.scene_file.entries import BodyEntry
from codegen.spec.scene_file.text import nearest_known, quoted

LONGEST_IDENTIFIER = 40
LONGEST_NAME = 60

IDENTIFIER = f"[A-Za-z_][A-Za-z0-9_]{{0,{LONGEST_IDENTIFIER - 1}}}"
"""Pattern of a scene's name."""

_KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register
restrict return short signed sizeof static struct switch typedef union unsigned void volatile while _Bool _Complex
_Imaginary alignas alignof and and_eq asm bitand bitor bool catch char16_t char32_t class compl const_cast constexpr
decltype delete dynamic_cast explicit export false friend mutable namespace new noexcept not not_eq nullptr operator or
or_eq private protected public reinterpret_cast static_assert static_cast template this thread_local throw true try
typeid typename using virtual wchar_t xor xor_eq
"""

_SHARED = "jg_real"
"""Name of a header that every package has."""

C_KEYWORDS = frozenset(_KEYWORDS.split())
"""Keywords of C99 and of C++17, whose compilers read the headers too."""


class Named(Protocol):
    """An entry with a name."""

    @property
    def name(self) -> str | None:
        """As it stands in the file."""

    @property
    def place(self) -> str:
        """As mistakes name it."""


def routine_name_mistakes(name: str, place: str, kind: str = "scene") -> Iterator[Mistake]:
    """Check that the name of a scene or chain can start C symbols."""
    remedy = f"use letters, digits and underscores, at most {LONGEST_IDENTIFIER}, no digit first"
    if not re.fullmatch(IDENTIFIER, name):
        yield Mistake(place, f"{quoted(name)} is no C identifier", remedy)
    elif name in C_KEYWORDS:
        yield Mistake(place, f"{quoted(name)} is a keyword of C or C++", f'use another name, such as "{name}_{kind}"')
    elif name.lower() == _SHARED:
        what = f"{_SHARED}.h is a file that every package has"
        yield Mistake(place, what, f'use another name, such as "{name}_{kind}"')


def name_mistakes(entries: Sequence[Named]) -> Iterator[Mistake]:
    """Check the names of all bodies, or of all joints: they are different, and each can be printed."""
    times = Counter(entry.name for entry in entries)
    for name in times:
        if name is not None and times[name] > 1:
            place = next(entry.place for entry in entries if entry.name == name)
            yield Mistake(place, f"the name stands {times[name]} times", "give each a name of its own")
    for entry in entries:
        if entry.name is not None:
            yield from _text_mistakes(entry.name, f"{entry.place}: name")
        if entry.name == GROUND and isinstance(entry, BodyEntry):
            what = f'"{GROUND}" is the body that does not move'
            yield Mistake(f"{entry.place}: name", what, "use another name; the ground needs no entry")


def _text_mistakes(name: str, place: str) -> Iterator[Mistake]:
    if not 1 <= len(name) <= LONGEST_NAME:
        yield Mistake(place, f"has {len(name)} signs", f"use 1 to {LONGEST_NAME} signs")
    elif not name.isprintable():
        yield Mistake(place, f"{quoted(name)} holds signs that do not print", "leave them out")
    elif not name.strip():
        yield Mistake(place, "is blank", "use a name with letters or digits")


def unknown_body_mistakes(name: str, place: str, known: Iterable[str]) -> Iterator[Mistake]:
    """Check that there is a body of a name; the ground is one."""
    names = [GROUND, *known]
    if name not in names:
        yield Mistake(place, f"there is no body {quoted(name)}", nearest_known(name, names))


def pair_mistakes(bodies: tuple[str, str], place: str, known: Iterable[str]) -> Iterator[Mistake]:
    """Check the two bodies of a joint or spring."""
    known = list(known)
    for name in dict.fromkeys(bodies):
        yield from unknown_body_mistakes(name, place, known)
    if bodies[0] == bodies[1]:
        what = "both are the ground" if bodies[0] == GROUND else f"both are {quoted(bodies[0])}"
        yield Mistake(place, what, "name two different bodies")
