"""The JSON schema of platform files; ``codegen/spec/platform.schema.json`` holds it."""

from __future__ import annotations

from codegen.spec.platform_file.entries import KINDS_OF_TABLES
from codegen.spec.scene_file.schema import schema_text as text_of


def schema_text() -> str:
    """The schema as the text of its file."""
    return text_of(KINDS_OF_TABLES, "jointgen platform")
