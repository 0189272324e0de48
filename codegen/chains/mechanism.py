"""A chain ready to be run: its equations, how its coordinates are parted, when forces switch."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from codegen.chains.conditions import Conditions
from codegen.chains.equations import Equations
from codegen.chains.partition import Partition, partition
from codegen.spec.chain import Chain, Row

Array = NDArray[np.float64]

AXES = ("fx", "fy", "fz", "mx", "my", "mz")
"""Components of a wrench."""

ROWS = ("x", "y", "z", "turn about x", "turn about y", "turn about z")
"""Rows of a cut, axes of its frames."""

_ROUNDING = 1e-9
"""A length below this part of the largest is what rounding left in place of a zero."""


@dataclass(frozen=True, slots=True, eq=False)
class Mechanism:
    """A chain ready to be run.

    Attributes:
        chain: as its file has it.
        equations: of the chain.
        part: its coordinates and rows.
        conditions: of its forces that switch.
        length: characteristic, m.
    """

    chain: Chain
    equations: Equations
    part: Partition
    conditions: Conditions
    length: float

    def row_name(self, row: int) -> str:
        """Cut and row by their names."""
        return f'cut "{self.chain.cuts[row // 6].name}", {ROWS[row % 6]}'

    def units(self) -> tuple[str, ...]:
        """Unit of each coordinate."""
        return tuple(link.unit for link in self.chain.links)

    def pose(self, q: Array) -> str:
        """The coordinates in words."""
        named = zip(self.chain.links, q, self.units(), strict=True)
        return ", ".join(f"{link.name} {value:.9g} {unit}" for link, value, unit in named)


def mechanism(chain: Chain, equations: Equations) -> Mechanism:
    """Make a chain ready.

    Args:
        chain: as its file has it.
        equations: of the chain.
    """
    return parted(chain, equations, [chain.index(one.joint) for one in chain.independents])


def parted(chain: Chain, equations: Equations, independent: list[int]) -> Mechanism:
    """Make a chain ready by independent coordinates of one's own.

    Args:
        chain: as its file has it.
        equations: of the chain.
        independent: their numbers, in the places of those that the file names.
    """
    length = characteristic_length(chain)
    reach = max(lengths(chain), default=0.0) / length
    is_prismatic = [link.unit == "m" for link in chain.links]
    part = partition(is_prismatic, independent, list(equations.binding), length, reach)
    return Mechanism(chain, equations, part, Conditions(chain), length)


def characteristic_length(chain: Chain) -> float:
    """The median of the lengths that the rows of a chain hold, m; 1 where they hold none."""
    found = lengths(chain)
    return float(np.median(found)) if found else 1.0


def lengths(chain: Chain) -> list[float]:
    """The lengths that the rows of a chain hold, m, without signs, zeros and what rounding left in place of zeros."""
    found = [abs(float(value)) for row in _rows(chain) for value in (row.c, row.a, row.d)]
    least = _ROUNDING * max(found, default=0.0)
    return [value for value in found if value > least]


def _rows(chain: Chain) -> Iterator[Row]:
    yield from (link.row for link in chain.links)
    for cut in chain.cuts:
        yield from (cut.base.row, cut.far.row)
    yield from (effector.frame.row for effector in chain.effectors)
