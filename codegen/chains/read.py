"""Read a chain file, and the tables that it names."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from pathlib import Path

from codegen.errors import Mistake, SpecificationError
from codegen.scenes.read import text_of
from codegen.spec.chain import Chain
from codegen.spec.chain_file import read_chain
from codegen.spec.chain_motions import Table


def read(file: Path) -> tuple[Chain, Mapping[str, str]]:
    """Read a chain.

    Args:
        file: its path.

    Returns:
        The chain, and the text of the tables by the names that it has for them.

    Raises:
        SpecificationError: a file cannot be read, or holds mistakes; all of them at once.
    """
    chain = read_chain(text_of(file), str(file))
    tables: dict[str, str] = {}
    mistakes: list[Mistake] = []
    for independent in (*chain.independents, *chain.base_independents):
        if isinstance(independent.motion, Table):
            path = file.parent / independent.motion.file
            try:
                tables[independent.motion.file] = text_of(path)
            except SpecificationError as error:
                mistakes += error.mistakes
    if mistakes:
        raise SpecificationError(mistakes)
    return chain, tables


def is_chain(file: Path) -> bool:
    """Whether a file is a chain file and no scene file: it has links; false where it cannot be read."""
    if file.suffix.lower() != ".toml":
        return False
    try:
        return "link" in tomllib.loads(text_of(file))
    except (SpecificationError, ValueError, RecursionError):
        return False
