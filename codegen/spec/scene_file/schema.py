"""The JSON schemas of scene and chain files, made from the keys that the readers know.

``codegen/spec/scene.schema.json`` and ``chain.schema.json`` hold them for editors and other programs; ``make schema``
writes them anew.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from fractions import Fraction
from typing import Any

from codegen.spec.scene_file.entries import kinds_of_tables
from codegen.spec.scene_file.entry import Entry, Key, keys_of
from codegen.spec.scene_file.names import IDENTIFIER, LONGEST_NAME

_DIALECT = "https://json-schema.org/draft/2020-12/schema"


def schema(kinds: Iterable[type[Entry]] | None = None, title: str = "jointgen scene") -> dict[str, Any]:
    """The schema as JSON values: one definition for each table, named after it.

    Args:
        kinds: all tables, the file itself first; those of a scene file if left out.
        title: of the schema.
    """
    whole, *tables = kinds or kinds_of_tables()
    definitions = {_name(table): _table(table) for table in tables}
    return {"$schema": _DIALECT, "title": title, **_table(whole, is_file=True), "$defs": definitions}


def schema_text(kinds: Iterable[type[Entry]] | None = None, title: str = "jointgen scene") -> str:
    """The schema as the text of its file."""
    return json.dumps(schema(kinds, title), indent=1) + "\n"


def _name(table: type[Entry]) -> str:
    return table.__name__.removesuffix("Entry").lower()


def _table(table: type[Entry], is_file: bool = False) -> dict[str, Any]:
    keys = keys_of(table)
    required = [name for name, key in keys.items() if key.is_required]
    return {
        "description": (table.__doc__ or "").splitlines()[0],
        "type": "object",
        "properties": {name: _key(name, key, is_file) for name, key in keys.items()},
        "additionalProperties": False,
        **({"required": required} if required else {}),
    }


def _key(name: str, key: Key, is_file: bool) -> dict[str, Any]:
    names = {"pattern": f"^{IDENTIFIER}$"} if is_file else {"minLength": 1, "maxLength": LONGEST_NAME}
    default = key.default if key.default not in (None, ()) else None
    return {
        "description": key.about,
        **_resolved(key.kind.schema),
        **(names if name == "name" else {}),
        **({"default": _plain(default)} if default is not None else {}),
    }


def _resolved(fragment: Mapping[str, object]) -> dict[str, Any]:
    """A fragment of the schema with references to definitions in place of tables."""
    if "table" in fragment:
        table: Any = fragment["table"]
        return {"$ref": f"#/$defs/{_name(table)}"}
    return {key: _resolved_value(value) for key, value in fragment.items()}


def _resolved_value(value: object) -> Any:
    if isinstance(value, Mapping):
        return _resolved(value)
    return [_resolved_value(item) for item in value] if isinstance(value, list) else value


def _plain(default: object) -> Any:
    """A default as JSON; a tuple of one number is the number itself."""
    if isinstance(default, tuple):
        return _plain(default[0]) if len(default) == 1 else [_plain(value) for value in default]
    return float(default) if isinstance(default, Fraction) else default
