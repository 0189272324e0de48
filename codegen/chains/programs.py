"""The pipeline for chains: chain -> stages -> programs, the cheapest that are found."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from codegen.ir.program import Program
from codegen.mechanics.chain.model import chain_program
from codegen.passes import simplify
from codegen.passes.drop_unused import drop_unused
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
    ((_, found),) = programs(chain, {"": tuple(names)})
    return found


def programs(chain: Chain, routines: Mapping[str, Sequence[str]]) -> Iterator[tuple[str, Program]]:
    """Derive quantities of a chain once, then give the program of each routine.

    Args:
        chain: the chain.
        routines: name -> quantities.
    """
    names = list(dict.fromkeys(name for asked in routines.values() for name in asked))
    whole = [chain_program(chain, names, progressive) for progressive in (True, False)[: 2 if chain.cuts else 1]]
    for routine, asked in routines.items():
        ways = whole if "M" in asked else whole[:1]
        yield routine, min((part(way, asked) for way in ways), key=lambda found: count(found).total)


def part(program: Program, names: Sequence[str]) -> Program:
    """Give the program of some of the quantities of a program."""
    outputs = tuple(program.output(name) for name in names)
    return simplify(drop_unused(replace(program, outputs=outputs)))


def routines(chain: Chain) -> dict[str, tuple[str, ...]]:
    """Say which quantities each routine of a chain evaluates; ``all`` comes last, if it has two quantities or more."""
    fused = tuple(name for name in FUSED if name in chain.wanted)
    return {name: (name,) for name in chain.wanted} | ({"all": fused} if len(fused) > 1 else {})
