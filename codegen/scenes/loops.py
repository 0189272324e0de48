"""Straight-line code or loops: which of them a routine is emitted as."""

from __future__ import annotations

from codegen.ir.looped import Looped
from codegen.ir.program import Program
from codegen.passes import simplify
from codegen.passes.unroll import unroll, unroll_short

LOOPS = ("auto", "never")
"""Values of the option."""

LEAST = 2
"""Instances from which on they are run in a loop, see docs/decisions.md."""


def decided(looped: Looped, loops: str) -> Program | Looped:
    """Write loops out where there are few instances.

    Args:
        looped: a routine.
        loops: one of `LOOPS`.
    """
    if len(looped.loops) == 1 and looped.is_straight:
        return looped.loops[0].program
    if loops == "never" or max(loop.count for loop in looped.loops) < LEAST:
        return simplify(unroll(looped))
    return unroll_short(looped, LEAST)
