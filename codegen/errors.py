"""Errors: what a user did wrong (`SpecificationError`, `OutputError`) and what we did wrong (`InternalError`).

A user's mistake is a place, what is wrong there, and the remedy. All mistakes of one input are reported at once, one
line each, by the command line, which then leaves with exit code 2.
"""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake in the input.

    Attributes:
        place: where it stands, for example ``--rows`` or ``scene.toml: joint "pin": axis``.
        what: what is wrong there.
        remedy: what to do about it.
    """

    place: str
    what: str
    remedy: str

    def __str__(self) -> str:
        return one_line(f"{self.place}: {self.what}; {self.remedy}")


class JointgenError(Exception):
    """Base of all errors that carry mistakes of the user; never raised itself."""

    def __init__(self, mistakes: Iterable[Mistake]) -> None:
        self.mistakes = tuple(mistakes)
        super().__init__("\n".join(str(mistake) for mistake in self.mistakes))


class SpecificationError(JointgenError):
    """The request (options, a scene, a chain, a platform) cannot be met as it stands."""


class OutputError(JointgenError):
    """The results cannot be written where they were asked for."""


class InternalError(AssertionError):
    """A promise between two stages is broken: a defect of jointgen, not of its input."""


def one_line(text: str) -> str:
    """Write what would break a line, or does not print, as Python's escapes."""
    return "".join(sign if sign.isprintable() else sign.encode("unicode_escape").decode() for sign in text)


def nearest(name: str, known: Iterable[str]) -> str:
    """Phrase the remedy for an unknown name: the nearest known one, and the list of all."""
    names = list(known)
    close = difflib.get_close_matches(name, names, n=1, cutoff=0.5)
    guess = f'did you mean "{close[0]}"? ' if close else ""
    return f"{guess}known: {', '.join(names)}"
