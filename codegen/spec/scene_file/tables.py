"""TOML text to tables of values, with exact numbers; what would take a parser too long or too deep is refused."""

from __future__ import annotations

import tomllib

from codegen.errors import Mistake, SpecificationError
from codegen.spec.scene_file.text import words
from codegen.spec.scene_file.values import exact

_LONGEST = 2_000_000
"""Characters that a file may have."""

_POINTS = 200
"""Points that a line may have: the parser needs quadratic time for a key of many parts."""


def read_tables(text: str, file: str) -> dict[str, object]:
    """Parse TOML.

    Raises:
        SpecificationError: the text is no TOML, or too large.
    """
    if len(text) > _LONGEST:
        what = f"has {len(text)} characters"
        raise SpecificationError(
            [Mistake(file, what, f"use at most {_LONGEST}; copies = {{ count = … }} repeats a mechanism")]
        )
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > _POINTS:
            what = f"has more than {_POINTS} points in one line"
            raise SpecificationError([Mistake(f"{file}: line {number}", what, "spread it over several lines")])
    try:
        return tomllib.loads(text, parse_float=exact)
    except RecursionError:
        raise SpecificationError(
            [Mistake(file, "is nested too deeply", "no key needs more than three levels")]
        ) from None
    except ValueError as error:
        what = f"is no TOML: {words(str(error))}"
        raise SpecificationError([Mistake(file, what, "correct the syntax (https://toml.io)")]) from None
