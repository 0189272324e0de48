"""`Counts`: how many operations of each kind.

The definition of a count: every addition, subtraction, multiplication, division, square root, sine-cosine pair,
single sine or cosine, arc tangent, and choice by a comparison is one operation. A fused multiply-add is one
multiplication and one addition, two operations in the paper's sense, so that contracting a program leaves its total as
it is; it is listed apart, and `Counts.roundings` takes it once. A change of sign and an absolute value are free and
listed; loads, stores and constants are free.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields

_RARE = ("select", "abs")
"""Kinds that the routines of joints have none of."""


@dataclass(frozen=True, slots=True)
class Counts:
    """Operations by kind.

    Attributes:
        add: additions and subtractions.
        mul: multiplications.
        div: divisions.
        fma: fused multiply-adds, two operations each.
        sqrt: square roots.
        sincos: pairs of sine and cosine of one angle.
        sin: single sines.
        cos: single cosines.
        atan2: arc tangents.
        neg: changes of sign; free.
        select: one of two values by a comparison of two others.
        abs: absolute values; free.
    """

    add: int = 0
    mul: int = 0
    div: int = 0
    fma: int = 0
    sqrt: int = 0
    sincos: int = 0
    sin: int = 0
    cos: int = 0
    atan2: int = 0
    neg: int = 0
    select: int = 0
    abs: int = 0

    @property
    def total(self) -> int:
        """All operations; changes of sign are not counted."""
        return self.arithmetic + self.sqrt + self.sincos + self.sin + self.cos + self.atan2 + self.select

    @property
    def arithmetic(self) -> int:
        """Additions, subtractions, multiplications and divisions, fused or not: what the paper counts."""
        return self.add + self.mul + self.div + 2 * self.fma

    @property
    def roundings(self) -> int:
        """Number of rounded results: a fused multiply-add rounds once, a choice not at all."""
        return self.total - self.fma - self.select

    def __add__(self, other: Counts) -> Counts:
        return Counts(*(getattr(self, kind.name) + getattr(other, kind.name) for kind in fields(self)))

    def times(self, number: int) -> Counts:
        """The same operations so many times."""
        return Counts(*(getattr(self, kind.name) * number for kind in fields(self)))

    def as_dict(self) -> dict[str, int]:
        """Kind -> number, with the total; choices and absolute values only where there are any."""
        kinds = {kind.name: getattr(self, kind.name) for kind in fields(self)}
        return {kind: n for kind, n in kinds.items() if n or kind not in _RARE} | {"total": self.total}

    @staticmethod
    def of(kinds: Mapping[str, int]) -> Counts:
        """Build from a mapping of kinds; a ``total`` in it is left out."""
        return Counts(**{kind: number for kind, number in kinds.items() if kind != "total"})

    def __str__(self) -> str:
        parts = [f"{getattr(self, kind.name)} {kind.name}" for kind in fields(self) if getattr(self, kind.name)]
        return f"{self.total} ({', '.join(parts)})" if parts else "0"
