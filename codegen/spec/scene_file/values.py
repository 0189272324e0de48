"""Kinds of values in a scene file: how each is read, and its JSON schema.

A kind turns what the TOML parser gives into exact numbers, text and tuples of them. What cannot be read is reported and
comes out as None, so that everything else in the file is still looked at.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation
from fractions import Fraction
from typing import Generic, TypeVar

from codegen.errors import Mistake
from codegen.spec.scene import Matrix, Quaternion, Vector
from codegen.spec.scene_file.text import nearest_known, quoted

T = TypeVar("T")

_LEAST, _GREATEST = Decimal("1e-30"), Decimal("1e30")
"""Sizes within which numbers are taken, besides 0."""

_DIGITS = 100
"""Signs that a number may have."""


@dataclass(frozen=True, slots=True)
class Kind(Generic[T]):
    """A kind of value.

    Attributes:
        read: takes a parsed value, its place, and the list to which mistakes are appended; None for what is wrong.
        schema: JSON schema of the value.
    """

    read: Callable[[object, str, list[Mistake]], T | None]
    schema: Mapping[str, object]


@dataclass(frozen=True, slots=True)
class Unusable:
    """A decimal number that is not finite, too large, too small or too long."""

    text: str


def exact(text: str) -> Fraction | Unusable:
    """Turn the text of a TOML float into the number that it says, without rounding."""
    try:
        decimal = Decimal(text) if len(text) <= _DIGITS else None
    except InvalidOperation:
        decimal = None
    if decimal is None or not decimal.is_finite():
        return Unusable(text)
    if decimal.is_zero():
        return Fraction(0)
    return Fraction(decimal) if _LEAST <= decimal.copy_abs() <= _GREATEST else Unusable(text)


def described(value: object) -> str:
    """Say what a parsed value is."""
    match value:
        case str():
            return f"the text {quoted(value)}"
        case bool():
            return str(value).lower()
        case Unusable():
            return f"the number {quoted(value.text)}"
        case int() | Fraction():
            return "a number"
        case list():
            return "a list"
        case dict():
            return "a table"
        case _:
            return "a date or time"


def number(unit: str = "") -> Kind[Fraction]:
    """A number, exact."""
    meant = f"a number in {unit}" if unit else "a number"

    def read(value: object, place: str, mistakes: list[Mistake]) -> Fraction | None:
        if isinstance(value, Fraction):
            return value
        if isinstance(value, int) and not isinstance(value, bool):
            if abs(value) <= _GREATEST:
                return Fraction(value)
            value = Unusable("an integer beyond 1e30")
        if isinstance(value, Unusable):
            remedy = f"give 0 or {meant} of a size from 1e-30 to 1e30, in at most {_DIGITS} signs"
            mistakes.append(Mistake(place, f"{quoted(value.text)} is out of range", remedy))
        else:
            mistakes.append(Mistake(place, f"is {described(value)}, not a number", f"give {meant}"))
        return None

    return Kind(read, {"type": "number"})


def or_zero(kind: Kind[T]) -> Kind[T]:
    """The same, of a value in which a size below 1e-30 is 0: rounding of a program that wrote the file."""
    return Kind(lambda value, place, mistakes: kind.read(_with_zeros(value), place, mistakes), kind.schema)


def _with_zeros(value: object) -> object:
    if isinstance(value, list):
        return [_with_zeros(entry) for entry in value]
    return Fraction(0) if isinstance(value, Unusable) and _is_tiny(value.text) else value


def _is_tiny(text: str) -> bool:
    try:
        return len(text) <= _DIGITS and Decimal(text).copy_abs() < _LEAST
    except InvalidOperation:
        return False


def count(greatest: int) -> Kind[int]:
    """A whole number from 1 on."""

    def read(value: object, place: str, mistakes: list[Mistake]) -> int | None:
        if isinstance(value, int) and not isinstance(value, bool) and 1 <= value <= greatest:
            return value
        what = "is out of range" if isinstance(value, int) else f"is {described(value)}, not a whole number"
        mistakes.append(Mistake(place, what, f"give a whole number from 1 to {greatest}"))
        return None

    return Kind(read, {"type": "integer", "minimum": 1, "maximum": greatest})


def _read_text(value: object, place: str, mistakes: list[Mistake]) -> str | None:
    if isinstance(value, str):
        return value
    mistakes.append(Mistake(place, f"is {described(value)}, not text", "give a text in quotes"))
    return None


def _read_flag(value: object, place: str, mistakes: list[Mistake]) -> bool | None:
    if isinstance(value, bool):
        return value
    mistakes.append(Mistake(place, f"is {described(value)}", "give true or false, without quotes"))
    return None


TEXT: Kind[str] = Kind(_read_text, {"type": "string"})
FLAG: Kind[bool] = Kind(_read_flag, {"type": "boolean"})


def choice(known: Sequence[str]) -> Kind[str]:
    """One of some words."""

    def read(value: object, place: str, mistakes: list[Mistake]) -> str | None:
        text = TEXT.read(value, place, mistakes)
        if text is None or text in known:
            return text
        mistakes.append(Mistake(place, f"there is no {quoted(text)}", nearest_known(text, known)))
        return None

    return Kind(read, {"enum": list(known)})


def several(kind: Kind[T], length: int | None, entry: str = "entry") -> Kind[tuple[T | None, ...]]:
    """A list of values of one kind; what is wrong in it is None."""

    def read(value: object, place: str, mistakes: list[Mistake]) -> tuple[T | None, ...] | None:
        if not isinstance(value, list):
            size = f" of {length}" if length else ""
            mistakes.append(Mistake(place, f"is {described(value)}, not a list", f"give a list{size}"))
            return None
        if length is not None and len(value) != length:
            mistakes.append(Mistake(place, f"has {len(value)} entries", f"give a list of {length}"))
            return None
        return tuple(kind.read(item, f"{place}: {entry} {k}", mistakes) for k, item in enumerate(value, 1))

    size = {"minItems": length, "maxItems": length} if length else {}
    return Kind(read, {"type": "array", "items": kind.schema, **size})


def whole(kind: Kind[tuple[T | None, ...]]) -> Kind[tuple[T, ...]]:
    """A list that counts only if all its entries can be read."""

    def read(value: object, place: str, mistakes: list[Mistake]) -> tuple[T, ...] | None:
        items = kind.read(value, place, mistakes)
        found = tuple(item for item in items or () if item is not None)
        return found if items is not None and len(found) == len(items) else None

    return Kind(read, kind.schema)


def vector(unit: str = "") -> Kind[Vector]:
    """Three numbers."""
    return whole(several(number(unit), 3, "component"))  # type: ignore[return-value]


def pair(kind: Kind[T]) -> Kind[tuple[T, T]]:
    """Two values of one kind."""
    return whole(several(kind, 2))  # type: ignore[return-value]


QUATERNION: Kind[Quaternion] = whole(several(number(), 4, "component"))  # type: ignore[assignment]


def inertia() -> Kind[Matrix]:
    """Three principal values, or three rows of three numbers."""
    principal, rows = vector("kg m^2"), whole(several(vector("kg m^2"), 3, "row"))

    def read(value: object, place: str, mistakes: list[Mistake]) -> Matrix | None:
        if isinstance(value, list) and any(isinstance(item, list) for item in value):
            return rows.read(value, place, mistakes)  # type: ignore[return-value]
        values = principal.read(value, place, mistakes)
        if values is None:
            return None
        a, b, c = values
        none = Fraction(0)
        return (a, none, none), (none, b, none), (none, none, c)

    return Kind(read, {"anyOf": [principal.schema, rows.schema]})


def each(kind: Kind[T]) -> Kind[tuple[T | None, ...]]:
    """One value, or a list of them: one for each degree of freedom of a joint."""
    many = several(kind, None)

    def read(value: object, place: str, mistakes: list[Mistake]) -> tuple[T | None, ...] | None:
        if isinstance(value, list):
            return many.read(value, place, mistakes)
        one = kind.read(value, place, mistakes)
        return None if one is None else (one,)

    return Kind(read, {"anyOf": [kind.schema, many.schema]})
