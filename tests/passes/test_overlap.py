"""In the order of latency chains that do not depend on each other take turns; a chain alone stays as it is."""

from __future__ import annotations

from codegen.ir.builder import Builder
from codegen.ir.ops import Op
from codegen.ir.program import Argument, Output, Program, Sparsity
from codegen.passes.overlap import overlap

_LENGTH = 8


def test_two_chains_take_turns() -> None:
    program = overlap(_chains(2))
    chain_of = [0, 1]
    for instruction in program.instructions[2:]:
        chain_of.append(chain_of[instruction.operands[0]])
    assert chain_of[2:] == [0, 1] * _LENGTH


def test_a_chain_alone_keeps_its_order() -> None:
    assert overlap(_chains(1)) == _chains(1)


def _chains(count: int) -> Program:
    """Roots of roots, one chain after the other."""
    builder = Builder()
    places = [builder.input("x", k) for k in range(count)]
    ends = []
    for place in places:
        for _ in range(_LENGTH):
            place = builder.emit(Op.SQRT, place)
        ends.append(place)
    full = Sparsity.of_entries(count, 1, [(k, 0) for k in range(count)])
    return builder.freeze((Argument("x", (count, 1)),), (Output("y", full, tuple(ends)),))
