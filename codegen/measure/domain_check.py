"""Whether inputs are in the domain that bounds hold over, as a program: the number of conditions that are broken.

Input: a program and the box of its inputs. Output: a program with the same arguments and the output ``outside`` [1]: 0
in the domain. A value that is no number is outside.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import sympy

from codegen.ir.lower.staged import Select, Stages
from codegen.ir.program import Program
from codegen.measure.bounds import Box
from codegen.mechanics.attitude import defects
from codegen.passes import simplify

OUTSIDE = "outside"

_Place = tuple[str, int]
"""An argument, and its first entry."""


@dataclass(frozen=True, slots=True)
class Conditions:
    """What is asked of inputs besides their intervals.

    Attributes:
        rotations: matrices, column-major, and their size.
        tolerance: of the norm that ``check_orthonormal`` gives.
        lengths: vectors [3], and what they may be long.
        apart: pairs of vectors, and how far they may be apart.
    """

    rotations: Sequence[tuple[_Place, int]] = ()
    tolerance: float = 0.0
    lengths: Sequence[tuple[_Place, float]] = ()
    apart: Sequence[tuple[_Place, _Place, float]] = ()


def domain_check(program: Program, box: Box, conditions: Conditions) -> Program:
    """Write the conditions on the arguments that a program takes.

    Args:
        program: its arguments are those of the check.
        box: intervals of its inputs.
        conditions: what else is asked; those on arguments that the program does not take are left out.
    """
    stages = Stages()
    given = {a.name: list(stages.argument(a.name, *a.shape).T) for a in program.used_arguments()}
    broken = [
        _beyond(sympy.Abs(entry - _exact((low + high) / 2)), (high - low) / 2)
        for name, entries in given.items()
        for entry, (low, high) in zip(entries, box.inputs[name], strict=True)
    ]
    for (name, first), size in conditions.rotations:
        if name in given:
            broken.append(_turned(stages, name, given[name], first, size, conditions.tolerance))
    for (name, first), length in conditions.lengths:
        if name in given:
            broken.append(_beyond(_square(given[name][first : first + 3]), length**2))
    for (name, first), (other, second), length in conditions.apart:
        if name in given and other in given:
            pairs = zip(given[name][first : first + 3], given[other][second : second + 3], strict=True)
            broken.append(_beyond(_square([a - b for a, b in pairs]), length**2))
    found = stages.stage("broken", sympy.Matrix(broken), "1 for a condition that is broken, 0 for one that holds")
    stages.output(OUTSIDE, sympy.Matrix([sum(found, sympy.S.Zero)]))
    return simplify(stages.program())


def _beyond(value: Any, limit: float) -> Any:
    """1 where a value is not below its limit."""
    return Select(value, _exact(limit), sympy.S.Zero, sympy.S.One)


def _turned(stages: Stages, name: str, entries: Sequence[Any], first: int, size: int, tolerance: float) -> Any:
    A = sympy.eye(3)
    A[:size, :size] = sympy.Matrix(size, size, entries[first : first + size * size]).T
    return _beyond(_square(defects(stages, A, f"_{name}_{first}")), tolerance**2)


def _square(entries: Sequence[Any]) -> Any:
    return sum((entry**2 for entry in entries), sympy.S.Zero)


def _exact(value: float) -> Any:
    exact = Fraction(value)
    return sympy.Rational(exact.numerator, exact.denominator)
