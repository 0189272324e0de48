"""Angles in a chain file: a number in rad, or a text that says a multiple of pi or degrees, exactly."""

from __future__ import annotations

import re
from fractions import Fraction

from codegen.errors import Mistake
from codegen.spec.angles import PI
from codegen.spec.scene_file.text import quoted
from codegen.spec.scene_file.values import Kind, Unusable, exact, number

_NUMBER = r"\d+(?:\.\d+)?"
_MULTIPLE = re.compile(rf"([+-]?)\s*(?:({_NUMBER})\s*\*?\s*)?pi(?:\s*/\s*({_NUMBER}))?")
_DEGREES = re.compile(rf"([+-]?\s*{_NUMBER})\s*deg")
_MEANT = 'a number in rad, or a text such as "pi/2", "-2*pi/3" or "30 deg"'


def _read(value: object, place: str, mistakes: list[Mistake]) -> Fraction | None:
    if not isinstance(value, str):
        return number("rad").read(value, place, mistakes)
    found = parsed(value)
    if found is None:
        mistakes.append(Mistake(place, f"{quoted(value)} is no angle", f"give {_MEANT}"))
    return found


def parsed(text: str) -> Fraction | None:
    """The angle in rad that a text says; None if it says none."""
    text = text.strip()
    if match := _DEGREES.fullmatch(text):
        degrees = exact(match[1].replace(" ", ""))
        return None if isinstance(degrees, Unusable) else degrees * PI / 180
    match = _MULTIPLE.fullmatch(text)
    if match is None:
        return None
    factor, divisor = exact(match[2] or "1"), exact(match[3] or "1")
    if isinstance(factor, Unusable) or isinstance(divisor, Unusable) or divisor == 0:
        return None
    return (-1 if match[1] == "-" else 1) * factor * PI / divisor


ANGLE: Kind[Fraction] = Kind(_read, {"anyOf": [{"type": "number"}, {"type": "string", "pattern": "(pi|deg)"}]})
