"""A domain of poses as text: ``r=1 s=0.2 angle=3.14``; what is left out is as in the standard domain."""

from __future__ import annotations

import math
from dataclasses import fields, replace

from codegen.errors import Mistake, SpecificationError, nearest
from codegen.measure.pose_domain import PoseDomain

_OPTION = "--domain"


def read_domain(text: str, start: PoseDomain | None = None) -> PoseDomain:
    """Read a domain.

    Args:
        text: ``name=number`` with spaces or commas between; names are the fields of `PoseDomain`.
        start: where what is left out comes from; the standard domain if left out.

    Raises:
        SpecificationError: unknown names, no numbers; all mistakes at once.
    """
    names = [field.name for field in fields(PoseDomain)]
    values: dict[str, float] = {}
    mistakes = []
    for word in text.replace(",", " ").split():
        name, sign, number = word.partition("=")
        value = _number(number)
        if not sign or name not in names:
            mistakes.append(Mistake(_OPTION, f'there is no bound "{name}"', nearest(name, names)))
        elif value is None:
            mistakes.append(Mistake(_OPTION, f'"{word}" is no bound', f"give a number of 0 or more: {name}=1"))
        else:
            values[name] = value
    domain = replace(start or PoseDomain(), **values)
    if not mistakes and not domain.length > 0:
        mistakes.append(Mistake(_OPTION, "has no length: s and d are 0", "give s or d"))
    if mistakes:
        raise SpecificationError(mistakes)
    return domain


def _number(text: str) -> float | None:
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) and value >= 0 else None
