"""The JSON schema of chain files: ``codegen/spec/chain.schema.json``, made by ``make schema``."""

from __future__ import annotations

from codegen.spec.chain_file.entries import kinds_of_tables
from codegen.spec.scene_file import schema


def schema_text() -> str:
    """The schema as the text of its file."""
    return schema.schema_text(kinds_of_tables(), "jointgen chain")
