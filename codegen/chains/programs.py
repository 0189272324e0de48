"""The pipeline for chains: chain -> stages -> program, the cheapest that is found."""

from __future__ import annotations

from collections.abc import Sequence

from codegen.ir.program import Program
from codegen.mechanics.chain.model import chain_program
from codegen.passes import simplify
from codegen.spec.chain import Chain
from flopcount.count import count

FUSED = ("phi", "J", "gamma_R", "M", "f_C", "f_G")
"""What the equations of motion take at each step, evaluated at once as ``all``."""


def program(chain: Chain, names: Sequence[str]) -> Program:
    """Derive quantities of a chain and simplify them.

    Args:
        chain: the chain.
        names: of `codegen.spec.chain.CHAIN_QUANTITIES`.
    """
    ways = (True, False) if "M" in names and chain.cuts else (True,)
    programs = [simplify(chain_program(chain, names, progressive)) for progressive in ways]
    return min(programs, key=lambda found: count(found).total)


def routines(chain: Chain) -> dict[str, tuple[str, ...]]:
    """Say which quantities each routine of a chain evaluates; ``all`` comes last, if it has two quantities or more."""
    fused = tuple(name for name in FUSED if name in chain.wanted)
    return {name: (name,) for name in chain.wanted} | ({"all": fused} if len(fused) > 1 else {})
