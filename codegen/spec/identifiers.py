"""Names out of files as identifiers: letters, digits and underscores, different for different names."""

from __future__ import annotations

import re
from collections.abc import Iterable


def identifiers(names: Iterable[str], reserved: Iterable[str] = ()) -> dict[str, str]:
    """Give each name an identifier of its own: what is no letter or digit becomes ``_``, a number tells equals apart.

    Args:
        names: any text, in order; a name that comes twice counts once.
        reserved: identifiers that none of them may have.

    Returns:
        Name -> identifier of ASCII letters, digits and single underscores that starts with a letter.
    """
    found: dict[str, str] = {}
    taken = set(reserved)
    for name in dict.fromkeys(names):
        plain = re.sub(r"[^A-Za-z0-9]+", "_", name).strip("_")
        plain = plain if plain[:1].isalpha() else f"n{plain}"
        identifier, number = plain, 1
        while identifier in taken:
            number += 1
            identifier = f"{plain}_{number}"
        taken.add(identifier)
        found[name] = identifier
    return found
