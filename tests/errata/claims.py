"""A claim about an equation, that it is misprinted here or right as printed, and how far off it is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from tests.reference.scalars import Array

from .situations import Situation, on_manifold

Values = Callable[[Situation], Array]

VISIBLE = 1e-2  # a misprint is off by more
EXACT = 1e-10  # what is right is off by less: rounding, and the error of the differences


@dataclass(frozen=True, eq=False)
class Misprint:
    """A misprinted part of an equation: its entries, the truth, both forms, and the situations that show it."""

    equation: str
    part: str
    where: Any
    truth: Values
    printed: Values
    corrected: Values
    situations: Callable[[], tuple[Situation, ...]] = on_manifold


@dataclass(frozen=True, eq=False)
class Sound:
    """An equation that is right as printed."""

    equation: str
    statement: str
    truth: Values
    printed: Values
    situations: Callable[[], tuple[Situation, ...]] = on_manifold


def error_as_printed(misprint: Misprint) -> float:
    """Largest deviation of the misprinted entries from the truth."""
    return max(_largest(_off(misprint, misprint.printed, s)[misprint.where]) for s in misprint.situations())


def error_corrected(misprint: Misprint) -> float:
    """Largest deviation of the whole corrected equation from the truth."""
    return max(_largest(_off(misprint, misprint.corrected, s)) for s in misprint.situations())


def error_elsewhere(misprints: tuple[Misprint, ...]) -> float:
    """Largest deviation of one equation as printed, its listed misprints left out."""
    worst = 0.0
    for s in misprints[0].situations():
        off = _off(misprints[0], misprints[0].printed, s)
        for misprint in misprints:
            off[misprint.where] = 0
        worst = max(worst, _largest(off))
    return worst


def size(misprint: Misprint) -> float:
    """Largest true entry where the misprint is, to compare its error with."""
    return max(_largest(_true(misprint.truth, s)[misprint.where]) for s in misprint.situations())


def error(claim: Sound) -> float:
    """Largest deviation of an equation that is right as printed."""
    return max(_largest(_off(claim, claim.printed, s)) for s in claim.situations())


def _off(claim: Misprint | Sound, form: Values, s: Situation) -> Array:
    values, true = form(s), _true(claim.truth, s)
    assert values.shape == true.shape, claim.equation
    return np.asarray(values - true)


@cache
def _true(truth: Values, s: Situation) -> Array:
    return truth(s)


def _largest(values: Array) -> float:
    return float(np.max(np.abs(values)))
