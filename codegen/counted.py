"""Operations of the derivatives of a variant, as the tables compare them.

Input: programs. Output: counts, with those of a step on prepared geometry.
"""

from __future__ import annotations

from collections.abc import Mapping

from codegen.ir.program import Program
from codegen.passes.split_geometry import split_geometry
from flopcount.count import count
from flopcount.models import Operations
from flopcount.paper import DERIVATIVES, Derivative

Counted = dict[Derivative, tuple[Operations, int]]
"""Operations of each derivative, and how many of them are left for a step when the geometry is prepared."""


def counted(programs: Mapping[str, Program]) -> Counted:
    """Count the derivatives among the programs of a variant, by output."""
    return {name: (Operations.of(programs[name]), operations_per_step(programs[name])) for name in DERIVATIVES}


def operations_per_step(program: Program) -> int:
    """Count the operations that prepared geometry leaves."""
    (step,) = split_geometry([program]).steps
    return count(step).total
