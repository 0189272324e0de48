"""What a user wrote, as a message may repeat it: on one line, without control characters, not too long."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from codegen.errors import nearest

_LONGEST = 60
_LONGEST_WORDS = 200
_NAMES = 12
_COMPARED = 500


def escaped(text: str, longest: int = _LONGEST) -> str:
    """Text with control characters, line ends and other signs that do not print escaped, cut to a length."""
    cut = text if len(text) <= longest else text[:longest] + "…"
    return "".join(sign if sign.isprintable() else _escape(sign) for sign in cut)


def quoted(text: str) -> str:
    """Text between double quotes, escaped and cut."""
    return '"' + escaped(text.replace("\\", "\\\\").replace('"', '\\"')) + '"'


def words(text: str) -> str:
    """A message of a library, escaped and cut."""
    return escaped(text, _LONGEST_WORDS)


def shown(value: Fraction) -> str:
    """A number as a message tells it: six digits."""
    return f"{float(value):.6g}"


def shown_vector(vector: Iterable[Fraction]) -> str:
    """A vector as a remedy offers it: all digits that a double holds."""
    return "[" + ", ".join(repr(float(value)) for value in vector) + "]"


def nearest_known(name: str, known: Iterable[str]) -> str:
    """Phrase the remedy for an unknown name, as `codegen.errors.nearest`; long lists are cut."""
    names = list(known)
    if len(names) <= _NAMES:
        return nearest(escaped(name), map(escaped, names))
    guess, _, _ = nearest(escaped(name), map(escaped, names[:_COMPARED])).rpartition("known: ")
    return f"{guess}known: {', '.join(map(escaped, names[:_NAMES]))} and {len(names) - _NAMES} more"


def _escape(sign: str) -> str:
    code = ord(sign)
    named = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}
    return named.get(sign) or (
        f"\\x{code:02x}" if code < 0x100 else f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"
    )
