"""A table of a scene file as a dataclass whose fields declare its keys, and how it is read, key by key."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import Field, dataclass, field, fields
from typing import Any, TypeVar

from codegen.errors import Mistake
from codegen.spec.scene_file.text import nearest_known, quoted
from codegen.spec.scene_file.values import Kind, described


@dataclass(frozen=True, slots=True)
class Key:
    """A key of a table.

    Attributes:
        kind: of its value.
        about: meaning, with frame and unit.
        is_required: whether it must be there.
        default: as the schema tells it; None where there is none.
    """

    kind: Kind[Any]
    about: str
    is_required: bool
    default: object


@dataclass(frozen=True, slots=True)
class Entry:
    """A table of the file.

    Attributes:
        place: as mistakes name it.
        given: keys that stand in it and are known.
        wrong: keys of which a mistake has been reported, also those that are missing.
    """

    place: str
    given: frozenset[str]
    wrong: frozenset[str]


E = TypeVar("E", bound=Entry)


def key(kind: Kind[Any], about: str, default: object = None, *, is_required: bool = False) -> Any:
    """Declare a key: its kind, what it means, its default."""
    return field(default=default, metadata={"key": Key(kind, about, is_required, default)})


def keys_of(table: type[Entry]) -> dict[str, Key]:
    """The keys of a table by name, in the order in which they are documented."""
    all_fields: tuple[Field[Any], ...] = fields(table)
    return {item.name: item.metadata["key"] for item in all_fields if "key" in item.metadata}


def read_entry(table: type[E], value: object, place: str, mistakes: list[Mistake]) -> E | None:
    """Read a table; what is wrong in it is appended to the mistakes. None if it is no table."""
    if not isinstance(value, dict):
        mistakes.append(Mistake(place, f"is {described(value)}, not a table", "give a table of keys and values"))
        return None
    keys = keys_of(table)
    for name in value:
        if name not in keys:
            mistakes.append(Mistake(place, f"there is no key {quoted(name)}", nearest_known(name, keys)))
    found: dict[str, Any] = {}
    wrong: set[str] = set()
    for name, key in keys.items():
        before = len(mistakes)
        if name in value:
            read = key.kind.read(value[name], f"{place}: {name}", mistakes)
            found.update({name: read} if read is not None else {})
        elif key.is_required:
            mistakes.append(Mistake(f"{place}: {name}", "is missing", f"give {name}: {key.about}"))
        wrong.update({name} if len(mistakes) > before else {})
    return table(place, frozenset(name for name in value if name in keys), frozenset(wrong), **found)


def table_of(table: type[E]) -> Kind[E]:
    """A table inside a table."""
    return Kind(lambda value, place, mistakes: read_entry(table, value, place, mistakes), {"table": table})


def load(table: type[E]) -> Kind[E]:
    """A table inside a table that may be empty, for none."""
    kind = table_of(table)
    none: Kind[E] = Kind(lambda value, place, mistakes: None, {"type": "object", "maxProperties": 0})

    def read(value: object, place: str, mistakes: list[Mistake]) -> E | None:
        return (none if value == {} else kind).read(value, place, mistakes)

    return Kind(read, {"anyOf": [none.schema, kind.schema]})


def tables(table: type[E], least: int = 0) -> Kind[tuple[E, ...]]:
    """Tables under double brackets, each named in mistakes by its name, or by its number where it has none."""

    def read(value: object, place: str, mistakes: list[Mistake]) -> tuple[E, ...] | None:
        file, _, label = place.rpartition(": ")
        if not isinstance(value, list) or len(value) < least:
            what = f"is {described(value)}" if value else "is empty"
            mistakes.append(Mistake(place, what, f"write [[{label}]] above each {label}"))
            return None
        places = (f"{file}: {label} {_called(item, k)}" for k, item in enumerate(value, 1))
        entries = [read_entry(table, item, where, mistakes) for item, where in zip(value, places, strict=True)]
        return tuple(entry for entry in entries if entry is not None)

    return Kind(read, {"type": "array", "minItems": least, "items": {"table": table}})


def _called(table: object, number_: int) -> str:
    name = table.get("name") if isinstance(table, Mapping) else None
    return quoted(name) if isinstance(name, str) and name else str(number_)
