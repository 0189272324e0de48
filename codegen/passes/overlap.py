"""Order the instructions by latency: none waits for an operand as long as another need not wait.

Depth-first order keeps few values alive, but in it nearly every operation takes the result of the one before. A
processor looks ahead by some hundred instructions only, and then stands still. Here the instructions are issued one
after the other on a model of a processor, always the first in the given order whose operands have come: the order
stays as it is where nothing waits.
"""

from __future__ import annotations

from heapq import heappop, heappush

from codegen.ir.ops import LEAVES
from codegen.ir.program import Program
from codegen.passes.latency import LATENCY
from codegen.passes.rewrite import reorder


def overlap(program: Program, issued: int = 2) -> Program:
    """Give the program in an order in which operations overlap; unused instructions are dropped.

    Args:
        program: in an order that keeps few values alive (`codegen.passes.schedule`): its parts stay together.
        issued: operations that start in a cycle of the model; with more of them the order comes apart more.
    """
    uses, missing = dependencies(program)
    waiting = [(0, place) for place, count in enumerate(missing) if count == 0]
    ready: list[int] = []
    arrival = [0] * len(missing)
    order: list[int] = []
    slot = 0
    while waiting or ready:
        if not ready:
            slot = max(slot, waiting[0][0])
        while waiting and waiting[0][0] <= slot:
            heappush(ready, heappop(waiting)[1])
        place = heappop(ready)
        order.append(place)
        op = program.instructions[place].op
        for use in uses[place]:
            missing[use] -= 1
            arrival[use] = max(arrival[use], slot + issued * LATENCY.get(op, 0))
            if missing[use] == 0:
                heappush(waiting, (arrival[use], use))
        slot += op not in LEAVES
    return reorder(program, order)


def dependencies(program: Program) -> tuple[list[list[int]], list[int]]:
    """For each instruction those that take its value, and how many values it takes; -1 for what is not used."""
    uses: list[list[int]] = [[] for _ in program.instructions]
    missing = [-1] * len(uses)
    for place, is_live in enumerate(program.live()):
        if is_live:
            operands = set(program.instructions[place].operands)
            missing[place] = len(operands)
            for operand in operands:
                uses[operand].append(place)
    return uses, missing
