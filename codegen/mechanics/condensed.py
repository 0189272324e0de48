"""Joint coordinates that constants tie to the rest: where the columns of ``phi_q`` by some alpha are constant.

With ``P`` [k, k] the part of these columns in as many rows, constant too, the rates of these alpha follow from the
velocities of the bodies by ``phi_q v = 0`` in these rows, the multipliers of these rows from what acts on the
coordinates, ``P^T lambda = force - ...``, and the corrections of these rows likewise. An integrator need not have them.
With the exact derivative ``P`` is that constant where the joints are closed, and depends on the pose elsewhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from codegen.ir.lower import Block
from codegen.mechanics import frames
from codegen.mechanics.derivation import is_matrix
from codegen.mechanics.frames import C_i
from codegen.mechanics.placed import Placed, rational

_FIRST = 12
"""Column of the first coordinate between bodies i and j."""


@dataclass(frozen=True, slots=True)
class Condensed:
    """Coordinates whose rates, and rows whose multipliers and corrections, follow from the rest.

    Attributes:
        coordinates: numbers among those of all joints, ascending.
        rows: as many, numbers among the rows that the system has.
        inverse: nonzeros of ``P^-1``: place in ``coordinates``, place in ``rows``, value.
        is_constant: whether ``P`` is constant; with the exact derivative it is so where the joints are closed, and
            depends on the pose elsewhere.
    """

    coordinates: tuple[int, ...] = ()
    rows: tuple[int, ...] = ()
    inverse: tuple[tuple[int, int, Fraction], ...] = ()
    is_constant: bool = True


def condensed(placed: Sequence[Placed], blocks: Mapping[int, Sequence[Block]], rows: Sequence[int]) -> Condensed:
    """Find the coordinates that constants tie to the rest.

    Args:
        placed: the joints.
        blocks: number of a joint -> its ``phi_q`` between bodies i and j.
        rows: that the system has, among those of all joints.
    """
    number = {row: k for k, row in enumerate(rows)}
    coordinates: list[int] = []
    chosen: list[int] = []
    inverse: list[tuple[int, int, Fraction]] = []
    for joint in placed:
        first_row, first_alpha, start = joint.ends.first_row, joint.ends.first_alpha, len(coordinates)
        columns = dict(_columns(joint, blocks[joint.ends.number], number))
        pivots = _pivots(columns)
        coordinates += [first_alpha + k for k in pivots]
        chosen += [number[first_row + row] for row in pivots.values()]
        P = [[columns[k].get(row, Fraction(0)) for k in pivots] for row in pivots.values()]
        inverse += [(start + a, start + b, value) for a, b, value in _inverse(P)]
    return Condensed(tuple(coordinates), tuple(chosen), tuple(inverse))


def _columns(
    joint: Placed, blocks: Sequence[Block], number: Mapping[int, int]
) -> Iterator[tuple[int, dict[int, Fraction]]]:
    """The coordinates of a joint whose columns are constant, with the entries in the rows that are there."""
    axes = sympy.ImmutableDenseMatrix([[rational(x) for x in row] for row in joint.markers[0].axes])
    known = {C_i: axes, frames.pitch: rational(joint.joint.pitch)}
    for k in range(joint.form.coordinates):
        entries = [_constants(b.expression.xreplace(known)) for b in blocks if b.column == _FIRST + k]
        rows = [b.row for b in blocks if b.column == _FIRST + k]
        if None not in entries:
            column = {
                row + i: value
                for row, values in zip(rows, entries, strict=True)
                for i, value in enumerate(values or ())
            }
            yield k, {row: value for row, value in column.items() if value and joint.ends.first_row + row in number}


def _constants(expression: Any) -> list[Fraction] | None:
    """The entries of a column, None where one is no rational number."""
    found = list(expression.doit()) if is_matrix(expression) else [expression]
    return [Fraction(int(x.p), int(x.q)) for x in found] if all(x.is_Rational for x in found) else None


def _pivots(columns: Mapping[int, Mapping[int, Fraction]]) -> dict[int, int]:
    """Coordinate -> row, by elimination with the largest entry of what is left of a column."""
    found: dict[int, int] = {}
    left = {k: dict(column) for k, column in columns.items()}
    for k, column in left.items():
        if not any(column.values()):
            continue
        pivot = max(column, key=lambda row: abs(column[row]))
        found[k] = pivot
        for other, entries in left.items():
            factor = entries.get(pivot, Fraction(0)) / column[pivot]
            if other not in found and factor:
                for row, value in column.items():
                    entries[row] = entries.get(row, Fraction(0)) - factor * value
    return found


def _inverse(P: list[list[Fraction]]) -> Iterator[tuple[int, int, Fraction]]:
    """Nonzeros of an inverse."""
    if P:
        found = sympy.Matrix([[rational(x) for x in row] for row in P]).inv()
        for a in range(len(P)):
            for b in range(len(P)):
                if found[a, b]:
                    yield a, b, Fraction(int(found[a, b].p), int(found[a, b].q))
